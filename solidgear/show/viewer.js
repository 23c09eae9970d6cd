// The viewer of mode shapes: unpacks what viewer.py packed, draws it with WebGL 2, and turns it.
(() => {
const PERIOD = 2.4; // s of one swing
const FILLS = 0.9; // share of a pane that the shape fills
const STEP = 5; // degrees, of keys and of the slider of the section

// ---- unpacking
async function numbers(text) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const b = new Uint8Array(await new Response(plain).arrayBuffer()), n = b.length / 4;
  const out = new Int32Array(n);
  for (let i = 0, sum = 0; i < n; i++) {
    const code = b[i] | b[n + i] << 8 | b[2 * n + i] << 16 | b[3 * n + i] << 24;
    out[i] = sum += code & 1 ? -(code >>> 1) - 1 : code >>> 1;
  }
  return out;
}

async function vectors(text, step) { // packed column by column
  const columns = await numbers(text), n = columns.length / 3;
  return Float32Array.from(columns, (_, i) => step * columns[i % 3 * n + (i - i % 3) / 3]);
}

function normals(p, triangles) { // at points, weighted by areas
  const out = new Float32Array(p.length);
  for (let i = 0; i < triangles.length; i += 3) {
    const a = 3 * triangles[i], b = 3 * triangles[i + 1], c = 3 * triangles[i + 2];
    const u = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
    const v = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
    for (let k = 0; k < 3; k++) {
      const l = (k + 1) % 3, m = (k + 2) % 3, area = u[l] * v[m] - u[m] * v[l];
      out[a + k] += area;
      out[b + k] += area;
      out[c + k] += area;
    }
  }
  return out;
}

async function opened(body) { // once
  if (body.rest) return;
  const [rest, triangles, edges] = await Promise.all([
    vectors(body.points, body.step), numbers(body.triangles), numbers(body.edges),
  ]);
  Object.assign(body, { triangles, edges, normal: normals(rest, triangles), rest });
}

// ---- drawing
const VERTEX = `#version 300 es
uniform mat4 uBody, uTurn; // to the axes of the picture, and to those of the screen
uniform vec3 uScale, uShift;
uniform float uSwing;
uniform bool uTwists;
layout(location = 0) in vec3 aRest;
layout(location = 1) in vec3 aMoved;
layout(location = 2) in vec3 aNormal;
out vec3 vRest, vPlace, vNormal, vSite;
out float vSize;
void main() {
  vec3 place = aRest + uSwing * aMoved;
  if (uTwists) { // enlarged along the tangent a section would swell: it is turned
    float r = max(length(aRest.xz), 1e-9);
    vec2 outwards = aRest.xz / r;
    float angle = uSwing * dot(aMoved.xz, vec2(outwards.y, -outwards.x)) / r;
    place.xz = mat2(cos(angle), -sin(angle), sin(angle), cos(angle))
      * (aRest.xz + uSwing * dot(aMoved.xz, outwards) * outwards);
  }
  vRest = aRest;
  vPlace = place;
  vNormal = normalize(aNormal);
  vSize = length(aMoved);
  vSite = (uBody * vec4(aRest, 1.0)).xyz;
  gl_Position = vec4(uScale * (uTurn * uBody * vec4(place, 1.0)).xyz + uShift, 1.0);
}`;
const FRAGMENT = `#version 300 es
precision highp float;
uniform mat4 uBody, uTurn;
uniform vec3 uRamp[17], uPaper, uInk;
uniform vec4 uCut, uLine; // w: whether there is one
uniform float uPixel;
uniform vec2 uSlices; // start and distance
in vec3 vRest, vPlace, vNormal, vSite;
in float vSize;
out vec4 colour;
float line(float at, float width) { // where a number is whole, fading where lines would touch
  float away = abs(fract(at - 0.5) - 0.5) / max(width * uPixel, 1e-9);
  return (1.0 - smoothstep(0.4, 1.2, away)) * (1.0 - smoothstep(0.1, 0.3, width));
}
vec3 across(vec3 p) { return normalize(cross(dFdx(p), dFdy(p))); }
void main() {
  vec3 still = across(vRest), moved = across(vPlace);
  // Meridians and circles painted on the shape at rest: without them torsion could not be seen.
  float turn = 24.0 / 6.2831853, slice = (vRest.y - uSlices.x) / uSlices.y - 0.5;
  vec2 r = vRest.zx, dx = dFdx(r), dy = dFdy(r);
  // The angle's own derivative jumps where it starts again.
  float change = abs(r.x * dx.y - r.y * dx.x) + abs(r.x * dy.y - r.y * dy.x);
  float meridian = line(turn * atan(r.y, r.x), turn * change / max(dot(r, r), 1e-12));
  float circle = line(slice, fwidth(slice)) * float(abs(still.y) < 0.98);

  if (uCut.w > 0.5 && dot(vSite, uCut.xyz) > 0.0) discard;
  if (uLine.w > 0.5) {
    colour = vec4(uLine.rgb, 1.0);
    return;
  }
  // Behind a cut closed surface the first thing seen from inside is where the section is.
  if (uCut.w > 0.5 && !gl_FrontFacing) {
    float stripe = abs(mod(gl_FragCoord.x + gl_FragCoord.y, 11.0 * uPixel) - 5.5 * uPixel);
    float gap = smoothstep(0.4 * uPixel, 1.4 * uPixel, stripe);
    colour = vec4(mix(uPaper, uInk, mix(0.5, 0.12, gap)), 1.0);
    return;
  }
  float s = clamp(vSize, 0.0, 1.0) * 16.0;
  int i = int(min(s, 15.0));
  vec3 base = mix(uRamp[i], uRamp[i + 1], s - float(i));
  // A normal tilts as the triangle does.
  vec3 n = normalize(mat3(uTurn) * mat3(uBody) * (normalize(vNormal) + moved - still));
  vec3 key = normalize(vec3(-0.45, 0.65, 0.75)), fill = normalize(vec3(0.7, -0.35, 0.6));
  float lit = 0.5 + 0.52 * max(dot(n, key), 0.0) + 0.2 * max(dot(n, fill), 0.0);
  float shine = 0.1 * pow(max(reflect(-key, n).z, 0.0), 24.0);
  colour = vec4(min(base * lit + shine, 1.0) * (1.0 - 0.28 * max(meridian, circle)), 1.0);
}`;

function program(gl) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  gl.useProgram(made);
  const at = {};
  for (let i = 0; i < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); i++) {
    const { name } = gl.getActiveUniform(made, i);
    at[name.replace("[0]", "")] = gl.getUniformLocation(made, name);
  }
  return at;
}

const rgb = text => text.match(/[\d.]+/g).slice(0, 3).map(v => v / 255);

class Pane {
  constructor(viewer, element) {
    Object.assign(this, { viewer, element, canvas: element.querySelector("canvas"), buffers: [] });
    this.gl = this.canvas.getContext("webgl2", { antialias: true, stencil: true });
    if (!this.gl) throw new Error("this browser shows no WebGL 2");
    this.at = program(this.gl);
    const model = element.querySelector(".model");
    this.chosen = () => model ? +model.value : 0;
  }
  buffer(target, array) {
    const { gl } = this, made = gl.createBuffer();
    this.buffers.push(made);
    gl.bindBuffer(target, made);
    gl.bufferData(target, array, gl.STATIC_DRAW);
    return made;
  }
  show(model, shape, moved) {
    const { gl } = this;
    this.buffers.splice(0).forEach(b => gl.deleteBuffer(b));
    Object.assign(this, { model, shape });
    this.parts = model.bodies.map((body, i) => {
      const arrays = gl.createVertexArray();
      gl.bindVertexArray(arrays);
      const fields = [body.rest, moved[i] || new Float32Array(body.rest.length), body.normal];
      fields.forEach((array, place) => {
        this.buffer(gl.ARRAY_BUFFER, array);
        gl.enableVertexAttribArray(place);
        gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 0, 0);
      });
      const faces = this.buffer(gl.ELEMENT_ARRAY_BUFFER, body.triangles);
      const edges = this.buffer(gl.ELEMENT_ARRAY_BUFFER, body.edges);
      return { body, arrays, faces, edges, twists: shape ? shape.twists[i] : false };
    });
    const words = shape
      ? `${shape.name}, ${shape.hz.toFixed(1)} Hz${shape.pair ? " (pair)" : ""}`
      : "none of this name among its modes";
    this.element.querySelector(".hz").textContent = words;
    this.canvas.ariaLabel = `${model.title}: ${words}; deformed shape, can be turned`;
  }
  fits() { // pixels a metre at which the box around shape and motion, as turned, fills the pane
    const { turn: t, scale } = this.viewer, { half, swing } = this.model;
    const most = this.shape ? this.shape.most : [0, 0, 0];
    const side = c => half[c] + swing * scale * most[c];
    const reach = row => row.reduce((sum, v, c) => sum + Math.abs(v) * side(c), 0);
    const wide = this.canvas.clientWidth / reach([t.m11, t.m21, t.m31]);
    return FILLS / 2 * Math.min(wide, this.canvas.clientHeight / reach([t.m12, t.m22, t.m32]));
  }
  draw() {
    if (!this.parts) return;
    const { gl, at, canvas, viewer, model } = this, pixel = Math.min(devicePixelRatio, 2);
    const pixels = v => Math.max(1, Math.round(v * pixel));
    const width = pixels(canvas.clientWidth), height = pixels(canvas.clientHeight);
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    const swing = this.shape ? model.swing * viewer.scale * Math.sin(viewer.phase) : 0;
    const fit = 2 * pixel * viewer.fit();
    const turn = viewer.turn.translate(...model.middle.map(v => -v));
    const style = getComputedStyle(this.element), paper = rgb(style.backgroundColor);
    const ink = rgb(style.color), grey = paper.map((v, c) => v + 0.55 * (ink[c] - v));
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.STENCIL_TEST);
    gl.uniformMatrix4fv(at.uTurn, false, turn.toFloat32Array());
    gl.uniform3f(at.uScale, fit / width, fit / height, -0.25 / model.length);
    const angle = viewer.angle * Math.PI / 180;
    gl.uniform4f(at.uCut, Math.sin(angle), 0, Math.cos(angle), viewer.cut);
    gl.uniform3fv(at.uRamp, viewer.data.ramp);
    gl.uniform3fv(at.uPaper, paper);
    gl.uniform3fv(at.uInk, ink);
    gl.uniform1f(at.uPixel, pixel);
    const pass = (elements, kind, swinging, colour, shift = [0, 0, 0]) => {
      gl.uniform1f(at.uSwing, swinging);
      gl.uniform3fv(at.uShift, shift);
      gl.uniform4fv(at.uLine, colour);
      for (const part of this.parts) {
        const { body } = part, count = elements === "faces" ? body.triangles : body.edges;
        gl.uniformMatrix4fv(at.uBody, false, body.place);
        gl.uniform2f(at.uSlices, body.start, model.length / 16);
        gl.uniform1i(at.uTwists, part.twists);
        gl.bindVertexArray(part.arrays);
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, part[elements]);
        gl.drawElements(kind, count.length, gl.UNSIGNED_INT, 0);
      }
    };
    // The section hides what lies behind it: its pixels are marked, and no edge is drawn there.
    gl.stencilFunc(gl.ALWAYS, 1, 1);
    gl.stencilOpSeparate(gl.FRONT, gl.KEEP, gl.KEEP, gl.ZERO);
    gl.stencilOpSeparate(gl.BACK, gl.KEEP, gl.KEEP, viewer.cut ? gl.REPLACE : gl.ZERO);
    pass("faces", gl.TRIANGLES, swing, [0, 0, 0, 0]);
    gl.stencilFunc(gl.EQUAL, 0, 1);
    gl.stencilOp(gl.KEEP, gl.KEEP, gl.KEEP);
    // A line has the width of one pixel: drawn four times, it has more, of any driver.
    const lines = (swinging, colour, nearer, wide) => {
      for (const [x, y] of [[-wide, -wide], [wide, -wide], [-wide, wide], [wide, wide]]) {
        const shift = [x * pixel / width, y * pixel / height, -nearer];
        pass("edges", gl.LINES, swinging, [...colour, 1], shift);
      }
    };
    lines(swing, [0.08, 0.09, 0.11], 0.002, 0.7);
    if (viewer.rest) lines(0, grey, 0.001, 0.5);
    this.axes(viewer.turn);
  }
  axes(t) {
    const ends = { x: [t.m11, t.m12], y: [t.m21, t.m22], z: [t.m31, t.m32] };
    this.element.querySelector("svg").innerHTML = Object.entries(ends).map(([name, end]) => {
      const [x, y] = [24 * end[0], -24 * end[1]];
      return `<line x2="${x}" y2="${y}"/><text x="${1.35 * x}" y="${1.35 * y}">${name}</text>`;
    }).join("");
  }
}

// ---- the viewer: panes that turn together
const turned = (turn, x, y) => // by degrees to the right and down
  new DOMMatrix().rotateAxisAngle(1, 0, 0, y).rotateAxisAngle(0, 1, 0, x).multiply(turn);
// y to the right, z up, a little from above and from the end, as in the pictures
const FRONT = new DOMMatrix([0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1]);
const HOME = turned(turned(FRONT, 0, 19.3), 20.9, 0);

class Viewer {
  constructor(root) {
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    Object.assign(this, { root, turn: HOME, zoom: 1, scale: 1, phase: Math.PI / 2 });
    Object.assign(this, { cut: false, angle: 0, rest: true, playing: !still, seen: true });
    this.$ = name => root.querySelector("." + name);
    this.data = JSON.parse(this.$("data").textContent);
    this.panes = [...root.querySelectorAll(".pane")].map(e => new Pane(this, e));
    this.listen();
    const first = this.data.modes.findIndex(mode => mode.at[0] === this.data.first);
    this.ready = this.pick(Math.max(first, 0)).then(() => {
      root.classList.add("on");
      this.play(this.playing);
      this.draw();
    });
  }
  async pick(mode) {
    this.mode = mode;
    this.$("mode").value = mode;
    for (const pane of this.panes) {
      const k = pane.chosen(), model = this.data.models[k];
      const shape = model.shapes[this.data.modes[mode].at[k]];
      await Promise.all(model.bodies.map(opened));
      const moved = await Promise.all((shape?.moved || []).map(text => vectors(text, shape.step)));
      if (this.mode !== mode || pane.chosen() !== k) return; // something else was picked meanwhile
      pane.show(model, shape, moved);
    }
    this.draw();
  }
  draw() { this.panes.forEach(pane => pane.draw()); }
  fit() { return this.zoom * Math.min(...this.panes.filter(p => p.parts).map(p => p.fits())); }
  set(what) { Object.assign(this, what); this.draw(); }
  rotate(x, y) { this.set({ turn: turned(this.turn, x, y) }); }
  zoomed(factor) { this.set({ zoom: Math.min(Math.max(this.zoom * factor, 0.3), 12) }); }
  reset() { this.set({ turn: HOME, zoom: 1 }); }
  section(cut, angle = this.angle) {
    this.$("cut").checked = cut;
    this.$("angle").disabled = !cut;
    this.$("angle").value = angle;
    this.set({ cut, angle });
  }
  cutting(on) { // away goes the half towards the viewer, by whole steps of the slider
    const { m13, m33 } = this.turn, angle = Math.atan2(m13, m33) * 180 / Math.PI;
    this.section(on, on ? (Math.round(angle / STEP) * STEP + 360) % 360 : this.angle);
  }
  play(playing) {
    this.playing = playing;
    this.$("play").textContent = playing ? "Pause" : "Play";
    this.$("play").ariaPressed = playing;
    cancelAnimationFrame(this.waiting);
    const tick = (now, before) => {
      this.waiting = requestAnimationFrame(later => tick(later, now));
      const passed = Math.min((now - before) / 1000, 0.1);
      this.set({ phase: (this.phase + 2 * Math.PI * passed / PERIOD) % (2 * Math.PI) });
    };
    if (playing && this.seen) this.waiting = requestAnimationFrame(now => tick(now, now));
  }
  listen() {
    const on = (name, event, action) => this.$(name).addEventListener(event, e => action(e.target));
    on("mode", "change", e => this.pick(+e.value));
    on("play", "click", () => this.play(!this.playing));
    on("scale", "input", e => this.set({ scale: +e.value }));
    on("cut", "change", e => this.cutting(e.checked));
    on("angle", "input", e => this.section(true, +e.value));
    on("rest", "change", e => this.set({ rest: e.checked }));
    on("home", "click", () => this.reset());
    on("panes", "change", () => this.pick(this.mode));
    this.panes.forEach(pane => this.handle(pane));
    new ResizeObserver(() => this.draw()).observe(this.root);
    new IntersectionObserver(rows => {
      this.seen = rows.some(row => row.isIntersecting);
      this.play(this.playing);
    }).observe(this.root);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }
  handle(pane) {
    const { canvas } = pane, down = new Map();
    const on = (name, action) => canvas.addEventListener(name, action);
    const spread = ([a, b]) => Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY) || 1;
    on("pointerdown", e => {
      down.set(e.pointerId, e);
      canvas.setPointerCapture(e.pointerId);
    });
    on("pointermove", e => {
      const was = down.get(e.pointerId), before = down.size === 2 && spread([...down.values()]);
      if (!was) return;
      down.set(e.pointerId, e);
      if (before) this.zoomed(spread([...down.values()]) / before);
      const k = 0.5 / down.size;
      this.rotate(k * (e.clientX - was.clientX), k * (e.clientY - was.clientY));
    });
    on("lostpointercapture", e => down.delete(e.pointerId));
    // A page that scrolls must not stop at a picture: the wheel zooms one that was clicked.
    canvas.addEventListener("wheel", e => {
      if (document.activeElement !== canvas) return;
      e.preventDefault();
      this.zoomed(Math.exp(-0.0015 * e.deltaY));
    }, { passive: false });
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const keys = {
      "+": () => this.zoomed(1.15),
      "-": () => this.zoomed(1 / 1.15),
      " ": () => this.play(!this.playing),
      c: () => this.cutting(!this.cut),
      0: () => this.reset(),
    };
    Object.assign(keys, { "=": keys["+"], Home: keys[0] });
    for (const name in arrows) {
      keys[name] = () => this.rotate(...arrows[name].map(v => v * STEP));
    }
    on("keydown", e => {
      if (!keys[e.key] || e.ctrlKey || e.metaKey || e.altKey) return;
      e.preventDefault();
      keys[e.key]();
    });
    on("webglcontextlost", e => e.preventDefault());
    on("webglcontextrestored", () => {
      pane.at = program(pane.gl);
      this.pick(this.mode);
    });
  }
}

function begin(root) {
  const failed = error => {
    root.classList.remove("on");
    root.querySelector(".why").textContent = `The model cannot be turned here: ${error.message}.`;
  };
  try {
    if (!window.DecompressionStream) throw new Error("this browser is too old to unpack it");
    root.viewer = new Viewer(root);
    root.viewer.ready.catch(failed);
  } catch (error) { failed(error); }
}
begin(document.currentScript.previousElementSibling);
})();

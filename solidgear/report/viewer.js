// The viewer: draws mode shapes in 3D with WebGL 2, after viewer_mesh.js.
const PERIOD = 2.4; // s of one swing
const SIZE = 0.9; // share of a pane that the shape fills

// ---- drawing
const MOVE = `#version 300 es
precision highp float;
uniform mat3 uTurn; uniform vec3 uMiddle; uniform vec3 uScale; uniform float uSwing; uniform bool uTwists;
uniform mat3 uAxes; uniform vec3 uOrigin; // of a body
out vec3 vRest; out vec3 vSite;
// Torsion enlarged turns sections; along the tangent it would swell them.
mat2 twist(vec3 rest, vec3 moved) {
  float a = uTwists ? uSwing * dot(moved.xz, vec2(rest.z, -rest.x)) / max(dot(rest, rest) - rest.y * rest.y, 1e-12) : 0.0;
  return mat2(cos(a), -sin(a), sin(a), cos(a));
}
vec4 place(vec3 rest, vec3 moved) {
  vec3 p = rest + uSwing * moved;
  if (uTwists) {
    vec2 out_ = normalize(rest.xz + 1e-12);
    p.xz = twist(rest, moved) * (rest.xz + uSwing * dot(moved.xz, out_) * out_);
  }
  return vec4((uTurn * (uAxes * p + uOrigin - uMiddle)) * uScale * vec3(1.0, 1.0, -1.0), 1.0);
}
vec3 site(vec3 rest) { return uAxes * rest + uOrigin; }`;
const FACES = [MOVE + `
uniform float uTilt;
layout(location = 0) in vec3 aRest; layout(location = 1) in vec3 aMoved; layout(location = 2) in vec3 aNormal; layout(location = 3) in vec3 aTilt;
out vec3 vNormal; out float vSize;
void main() {
  vRest = aRest; vSite = site(aRest); gl_Position = place(aRest, aMoved);
  vec3 n = aNormal + (uTwists ? 0.0 : uTilt) * aTilt;
  n.xz = twist(aRest, aMoved) * n.xz;
  vNormal = uTurn * (uAxes * n);
  vSize = length(aMoved);
}`, `#version 300 es
precision highp float;
uniform vec3 uColours[17]; uniform vec4 uCut; uniform vec3 uHatch[2]; uniform float uPixel; uniform vec2 uGrid;
in vec3 vRest; in vec3 vSite; in vec3 vNormal; in float vSize;
out vec4 colour;
float line(float at, float width) { // where a number is whole, fading where lines would touch
  return (1.0 - smoothstep(0.4, 1.2, abs(fract(at - 0.5) - 0.5) / max(width * uPixel, 1e-9))) * (1.0 - smoothstep(0.1, 0.3, width));
}
void main() {
  // Meridians and circles painted on the shape at rest: without them torsion could not be seen.
  float around = atan(vRest.x, vRest.z) * 3.8197186, along = (vRest.y - uGrid.x) / uGrid.y - 0.5;
  // The angle's own derivative jumps where it starts again.
  vec2 r = vRest.zx, dx = dFdx(r), dy = dFdy(r);
  float step_ = 3.8197186 * (abs(r.x * dx.y - r.y * dx.x) + abs(r.x * dy.y - r.y * dy.x)) / max(dot(r, r), 1e-12);
  vec3 flatly = normalize(cross(dFdx(vRest), dFdy(vRest)));
  float grid = max(line(around, step_), abs(flatly.y) > 0.98 ? 0.0 : line(along, fwidth(along)));
  if (uCut.w > 0.5 && dot(vSite, uCut.xyz) > 0.0) discard;
  // Behind a cut closed surface the first thing seen from inside is where the section is.
  if (uCut.w > 0.5 && !gl_FrontFacing) {
    float stripe = abs(mod(gl_FragCoord.x + gl_FragCoord.y, 11.0 * uPixel) - 5.5 * uPixel);
    colour = vec4(mix(uHatch[1], uHatch[0], smoothstep(0.4 * uPixel, 1.4 * uPixel, stripe)), 1.0);
    return;
  }
  float s = clamp(vSize, 0.0, 1.0) * 16.0; int i = int(min(s, 15.0));
  vec3 base = mix(uColours[i], uColours[i + 1], s - float(i)), n = normalize(vNormal);
  float lit = 0.5 + 0.52 * max(dot(n, normalize(vec3(-0.45, 0.65, 0.75))), 0.0) + 0.2 * max(dot(n, normalize(vec3(0.7, -0.35, 0.6))), 0.0);
  float shine = 0.10 * pow(max(dot(reflect(normalize(vec3(0.45, -0.65, -0.75)), n), vec3(0.0, 0.0, 1.0)), 0.0), 24.0);
  colour = vec4(mix(min(base * lit + shine, 1.0), vec3(0.0), 0.28 * grid), 1.0);
}`];
// Edges are strips some pixels wide: what a browser draws as lines depends on the driver.
const LINES = [MOVE + `
uniform vec2 uPane; uniform float uWidth; uniform float uNearer;
layout(location = 0) in vec3 aRest; layout(location = 1) in vec3 aMoved; layout(location = 2) in vec3 aEnd; layout(location = 3) in vec3 aEndMoved;
void main() {
  bool end = gl_VertexID > 1;
  vec4 a = place(aRest, aMoved), b = place(aEnd, aEndMoved);
  vec2 along = (b.xy - a.xy) * uPane; along = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x) * ((gl_VertexID & 1) == 0 ? 1.0 : -1.0);
  vRest = end ? aEnd : aRest; vSite = site(vRest); gl_Position = end ? b : a;
  gl_Position.xy += (across + (end ? 0.5 : -0.5) * along) * uWidth / uPane;
  gl_Position.z -= uNearer;
}`, `#version 300 es
precision highp float;
uniform vec4 uCut; uniform vec3 uColour;
in vec3 vSite;
out vec4 colour;
void main() {
  if (uCut.w > 0.5 && dot(vSite, uCut.xyz) > 0.0) discard;
  colour = vec4(uColour, 1.0);
}`];

function program(gl, sources) {
  const p = gl.createProgram();
  sources.forEach((text, i) => {
    const s = gl.createShader(i ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
    gl.shaderSource(s, text); gl.compileShader(s);
    if (!gl.getShaderParameter(s, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(s));
    gl.attachShader(p, s);
  });
  gl.linkProgram(p);
  if (!gl.getProgramParameter(p, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(p));
  const at = {};
  for (let i = 0; i < gl.getProgramParameter(p, gl.ACTIVE_UNIFORMS); i++) {
    const name = gl.getActiveUniform(p, i).name.replace("[0]", "");
    at[name] = gl.getUniformLocation(p, name);
  }
  return { p, at };
}

function rgb(text) { // #rgb, #rrggbb or rgb(...)
  const hex = text.trim().match(/^#(\w\w?)(\w\w?)(\w\w?)$/);
  return (hex ? hex.slice(1).map(v => parseInt(v.padEnd(2, v), 16)) : (text.match(/[\d.]+/g) || [0, 0, 0]).slice(0, 3).map(Number)).map(v => v / 255);
}
const mixed = (a, b, s) => a.map((v, i) => v + s * (b[i] - v));

class Pane {
  constructor(viewer, element) {
    this.viewer = viewer; this.element = element; this.canvas = element.querySelector("canvas");
    this.gl = this.canvas.getContext("webgl2", { antialias: true, alpha: true, stencil: true });
    if (!this.gl) throw new Error("this browser shows no WebGL 2");
    this.start();
  }
  start() {
    this.faces = program(this.gl, FACES); this.lines = program(this.gl, LINES);
    this.buffers = []; this.drawn = null;
  }
  async show(model, number) {
    await unpack(model);
    const shape = model.shapes[number], swing = this.viewer.data.swing * model.box.length, most = [0, 0, 0];
    const moved = await Promise.all(bodies(model).map(body => shape && values(body.shapes[number].moved, body, body.shapes[number].step)));
    this.buffers.forEach(b => this.gl.deleteBuffer(b)); this.buffers = [];
    const parts = bodies(model).map((body, i) => this.part(body, moved[i], swing));
    bodies(model).forEach((body, i) => {
      const { rotation } = placing(body), own = [0, 0, 0];
      if (moved[i]) moved[i].forEach((v, j) => { own[j % 3] = Math.max(own[j % 3], Math.abs(v)); });
      most.forEach((v, c) => { most[c] = Math.max(v, own.reduce((sum, u, k) => sum + Math.abs(rotation[3 * c + k]) * u, 0)); });
      parts[i].twists = shape && body.shapes[number].twists;
    });
    this.drawn = { model, shape, swing, most, parts };
    const words = shape ? `${shape.name}, ${shape.hz.toFixed(1)} Hz${shape.pair ? " (pair)" : ""}` : "none of this name among its modes";
    this.element.querySelector(".hz").textContent = words;
    this.canvas.setAttribute("aria-label", `${model.title}: ${words}; deformed shape, can be turned`);
  }
  part(model, moved, swing) { // what is drawn of one body
    // Deformed to both sides: between them normals are taken to change evenly.
    const [up, down] = moved ? [1, -1].map(s => normals(model.rest.map((v, i) => v + s * swing * moved[i]), model)) : [];
    const gl = this.gl, still = normals(model.rest, model), none = new Float32Array(model.source.length * 3);
    const vao = (arrays, elements) => { // edges, which have no elements, take both ends from one array
      const v = gl.createVertexArray(); gl.bindVertexArray(v);
      const field = (i, stride, start) => {
        gl.enableVertexAttribArray(i); gl.vertexAttribPointer(i, 3, gl.FLOAT, false, stride, start);
        if (stride) gl.vertexAttribDivisor(i, 1);
      };
      arrays.forEach((array, i) => {
        this.put(gl.ARRAY_BUFFER, array);
        if (elements) field(i, 0, 0); else { field(i, 24, 0); field(i + 2, 24, 12); }
      });
      if (elements) this.put(gl.ELEMENT_ARRAY_BUFFER, elements);
      gl.bindVertexArray(null);
      return v;
    };
    const at = model.source, ends = model.sharp;
    return {
      body: model,
      faces: vao([picked(model.rest, at), moved ? picked(moved, at) : none, still, moved ? up.map((v, i) => (v - down[i]) / 2) : none], model.index),
      edges: vao([picked(model.rest, ends), moved ? picked(moved, ends) : new Float32Array(3 * ends.length)]),
    };
  }
  put(target, array) {
    const b = this.gl.createBuffer(); this.buffers.push(b);
    this.gl.bindBuffer(target, b); this.gl.bufferData(target, array, this.gl.STATIC_DRAW);
  }
  fits() { // pixels a metre at which the box around shape and motion fills the pane, as it is turned
    const { model, most, swing } = this.drawn, { turn, scale } = this.viewer;
    const half = model.box.low.map((v, c) => (model.box.high[c] - v) / 2 + swing * scale * most[c]);
    const reach = turn.map(row => row.reduce((sum, v, c) => sum + Math.abs(v) * half[c], 0));
    return SIZE / 2 * Math.min(this.canvas.clientWidth / reach[0], this.canvas.clientHeight / reach[1]);
  }
  draw() {
    if (!this.drawn) return;
    const { gl, canvas, viewer, drawn } = this, { model } = drawn, pixel = Math.min(window.devicePixelRatio || 1, 2);
    const w = Math.max(1, Math.round(canvas.clientWidth * pixel)), h = Math.max(1, Math.round(canvas.clientHeight * pixel));
    if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
    gl.viewport(0, 0, w, h);
    gl.clearColor(0, 0, 0, 0); gl.clearStencil(0); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST); gl.enable(gl.POLYGON_OFFSET_FILL); gl.polygonOffset(1, 1);
    const R = viewer.turn, fit = viewer.fit() * pixel, scale = [2 * fit / w, 2 * fit / h, 0.25 / model.box.length];
    const swing = drawn.shape ? drawn.swing * viewer.scale * Math.sin(viewer.phase) : 0;
    const middle = model.box.low.map((v, c) => (v + model.box.high[c]) / 2), cut = [Math.sin(viewer.angle), 0, Math.cos(viewer.angle), viewer.cut ? 1 : 0];
    const colour = getComputedStyle(viewer.root), ink = rgb(colour.color), paper = rgb(colour.getPropertyValue("--bg"));
    const use = ({ p, at }, s) => {
      gl.useProgram(p);
      gl.uniformMatrix3fv(at.uTurn, true, R.flat()); gl.uniform3fv(at.uMiddle, middle); gl.uniform3fv(at.uScale, scale);
      gl.uniform1f(at.uSwing, s); gl.uniform4fv(at.uCut, cut);
      return at;
    };
    const each = (at, draw) => drawn.parts.forEach(part => { // every body in its place
      const { rotation, origin } = placing(part.body);
      gl.uniformMatrix3fv(at.uAxes, true, rotation); gl.uniform3fv(at.uOrigin, origin); gl.uniform1i(at.uTwists, part.twists ? 1 : 0);
      draw(part);
    });
    const at = use(this.faces, swing);
    gl.uniform1f(at.uTilt, drawn.shape ? swing / drawn.swing : 0); gl.uniform1f(at.uPixel, pixel);
    gl.uniform3fv(at.uColours, viewer.colours); gl.uniform3fv(at.uHatch, [...mixed(paper, ink, 0.12), ...mixed(paper, ink, 0.5)]);
    // The section hides what lies behind it: its pixels are marked, and no edge is drawn there.
    gl.enable(gl.STENCIL_TEST); gl.stencilFunc(gl.ALWAYS, 1, 1);
    gl.stencilOpSeparate(gl.FRONT, gl.KEEP, gl.KEEP, gl.ZERO); gl.stencilOpSeparate(gl.BACK, gl.KEEP, gl.KEEP, viewer.cut ? gl.REPLACE : gl.ZERO);
    each(at, ({ body, faces }) => {
      gl.uniform2fv(at.uGrid, [body.start, model.box.length / 16]);
      gl.bindVertexArray(faces); gl.drawElements(gl.TRIANGLES, body.index.length, gl.UNSIGNED_INT, 0);
    });
    gl.stencilFunc(gl.EQUAL, 0, 1); gl.stencilOp(gl.KEEP, gl.KEEP, gl.KEEP);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    const edges = (s, colour, nearer, width) => {
      const to = use(this.lines, s);
      gl.uniform2fv(to.uPane, [w, h]); gl.uniform1f(to.uWidth, width * pixel); gl.uniform1f(to.uNearer, nearer); gl.uniform3fv(to.uColour, colour);
      each(to, part => { gl.bindVertexArray(part.edges); gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, part.body.sharp.length / 2); });
    };
    edges(swing, [0.08, 0.09, 0.11], 0.0015, 1.5);
    if (viewer.rest) edges(0, mixed(paper, ink, 0.55), 0, 1.2);
    gl.bindVertexArray(null);
    this.axes(R);
  }
  axes(R) {
    this.element.querySelector("svg").innerHTML = ["x", "y", "z"].map((name, c) => {
      const x = (24 * R[0][c]).toFixed(1), y = (-24 * R[1][c]).toFixed(1);
      return `<line x2="${x}" y2="${y}"/><text x="${(1.35 * x).toFixed(1)}" y="${(1.35 * y).toFixed(1)}">${name}</text>`;
    }).join("");
  }
}

// ---- the viewer: panes that turn together
const by = (axis, angle) => { // turn about an axis of the screen
  const c = Math.cos(angle), s = Math.sin(angle);
  return axis ? [[c, 0, s], [0, 1, 0], [-s, 0, c]] : [[1, 0, 0], [0, c, -s], [0, s, c]];
};
const times = (a, b) => a.map(row => [0, 1, 2].map(c => row.reduce((sum, v, k) => sum + v * b[k][c], 0)));
function upright(R) { // rounding must not shear what is turned for long
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2], unit = a => a.map(v => v / Math.hypot(...a));
  const x = unit(R[0]), y = unit(R[1].map((v, c) => v - dot(R[1], x) * x[c]));
  return [x, y, [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]];
}
function home() { // y to the right, z up, a little from above and from the end, as in the pictures
  const h = 18 * Math.PI / 180, t = -22 * Math.PI / 180;
  const back = [Math.cos(h) * Math.cos(t), Math.cos(h) * Math.sin(t), Math.sin(h)];
  const right = [0, 1, 0].map((v, c) => v - back[1] * back[c]), size = Math.hypot(...right), x = right.map(v => v / size);
  return [x, [back[1] * x[2] - back[2] * x[1], back[2] * x[0] - back[0] * x[2], back[0] * x[1] - back[1] * x[0]], back];
}

class Viewer {
  constructor(root) {
    this.root = root; this.data = JSON.parse(root.querySelector(".data").textContent);
    this.colours = this.data.colours.flatMap(rgb);
    this.turn = home(); this.zoom = 1; this.scale = 1; this.phase = Math.PI / 2; this.cut = false; this.angle = 0; this.rest = true;
    this.playing = !matchMedia("(prefers-reduced-motion: reduce)").matches; this.seen = true;
    this.panes = [...root.querySelectorAll(".pane")].map(e => new Pane(this, e));
    this.$ = name => root.querySelector("." + name);
    this.mode = Math.max(this.data.modes.findIndex(m => m.at[0] === this.data.first), 0);
    this.listen();
    this.ready = this.pick(this.mode).then(() => { root.classList.add("on"); this.play(this.playing); this.draw(); });
  }
  async pick(mode) { // by number or by name
    const number = typeof mode === "number" ? mode : this.data.modes.findIndex(m => m.name === mode);
    if (!this.data.modes[number]) throw new Error(`there is no mode ${mode}`);
    this.mode = number;
    this.$("mode").value = this.mode;
    const at = this.data.modes[this.mode].at, turn = this.picking = {};
    for (let i = 0; i < this.panes.length; i++) {
      const pane = this.panes[i], choice = pane.element.querySelector(".model"), k = choice ? +choice.value : 0, model = this.data.models[k];
      await pane.show(model, at[k]);
      if (this.picking !== turn) return; // something else was picked meanwhile
    }
    this.draw();
  }
  draw() { this.panes.forEach(p => p.draw()); }
  fit() { return this.zoom * Math.min(...this.panes.filter(p => p.drawn).map(p => p.fits())); }
  frame(t) { this.play(false); this.phase = 2 * Math.PI * t / PERIOD; this.draw(); }
  rotate(dx, dy) { this.turn = upright(times(by(1, dx), times(by(0, dy), this.turn))); this.draw(); }
  zoomed(factor) { this.zoom = Math.min(Math.max(this.zoom * factor, 0.3), 12); this.draw(); }
  section(on, angle = this.angle) {
    this.cut = on; this.angle = angle; this.$("cut").checked = on; this.$("angle").disabled = !on;
    this.$("angle").value = Math.round(angle * 36 / Math.PI) * 5; this.draw();
  }
  facing() { // the half towards the viewer, by whole steps of the slider
    const back = this.turn[2], step = Math.PI / 36, a = Math.round(Math.atan2(back[0], back[2]) / step) * step;
    return a < 0 ? a + 2 * Math.PI : a;
  }
  reset() { this.turn = home(); this.zoom = 1; this.draw(); }
  play(on) {
    this.playing = on; this.$("play").textContent = on ? "Pause" : "Play"; this.$("play").setAttribute("aria-pressed", on);
    if (on && this.seen && !this.waiting) { this.before = undefined; this.waiting = requestAnimationFrame(now => this.tick(now)); }
  }
  tick(now) {
    this.waiting = 0;
    if (!this.playing || !this.seen) return;
    this.phase = (this.phase + 2 * Math.PI * Math.min((now - (this.before ?? now)) / 1000, 0.1) / PERIOD) % (2 * Math.PI);
    this.before = now; this.draw();
    this.waiting = requestAnimationFrame(later => this.tick(later));
  }
  listen() {
    const on = (name, event, action) => this.$(name).addEventListener(event, e => action(e.target));
    on("mode", "change", e => this.pick(+e.value)); on("play", "click", () => this.play(!this.playing));
    on("scale", "input", e => { this.scale = +e.value; this.draw(); });
    on("cut", "change", e => this.section(e.checked, e.checked ? this.facing() : this.angle));
    on("angle", "input", e => this.section(this.cut, e.value * Math.PI / 180));
    on("rest", "change", e => { this.rest = e.checked; this.draw(); }); on("home", "click", () => this.reset());
    this.root.querySelectorAll(".model").forEach(e => e.addEventListener("change", () => this.pick(this.mode)));
    this.panes.forEach(pane => this.handle(pane));
    new ResizeObserver(() => this.draw()).observe(this.root);
    new IntersectionObserver(rows => { this.seen = rows.some(r => r.isIntersecting); this.play(this.playing); }).observe(this.root);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }
  handle(pane) {
    const c = pane.canvas, down = new Map();
    c.addEventListener("pointerdown", e => { down.set(e.pointerId, [e.clientX, e.clientY]); try { c.setPointerCapture(e.pointerId); } catch { /* a pointer that is gone */ } });
    c.addEventListener("pointermove", e => {
      const was = down.get(e.pointerId);
      if (!was) return;
      const spread = () => { const [a, b] = [...down.values()]; return Math.hypot(a[0] - b[0], a[1] - b[1]) || 1; };
      const before = down.size === 2 ? spread() : 0;
      down.set(e.pointerId, [e.clientX, e.clientY]);
      if (before) this.zoomed(spread() / before);
      const k = 0.009 / down.size;
      this.rotate(k * (e.clientX - was[0]), k * (e.clientY - was[1]));
    });
    ["pointerup", "pointercancel", "lostpointercapture"].forEach(name => c.addEventListener(name, e => down.delete(e.pointerId)));
    // A page that scrolls must not stop at a picture: the wheel zooms one that was clicked.
    c.addEventListener("wheel", e => { if (document.activeElement === c) { e.preventDefault(); this.zoomed(Math.exp(-0.0015 * e.deltaY)); } }, { passive: false });
    c.addEventListener("keydown", e => {
      const step = Math.PI / 36;
      const action = {
        ArrowLeft: () => this.rotate(-step, 0), ArrowRight: () => this.rotate(step, 0), ArrowUp: () => this.rotate(0, -step), ArrowDown: () => this.rotate(0, step),
        "+": () => this.zoomed(1.15), "=": () => this.zoomed(1.15), "-": () => this.zoomed(1 / 1.15), " ": () => this.play(!this.playing),
        c: () => this.section(!this.cut, this.cut ? this.angle : this.facing()), 0: () => this.reset(), Home: () => this.reset(),
      }[e.key];
      if (!action || e.ctrlKey || e.metaKey || e.altKey) return;
      e.preventDefault(); action();
    });
    c.addEventListener("webglcontextlost", e => { e.preventDefault(); pane.drawn = null; });
    c.addEventListener("webglcontextrestored", () => { pane.start(); this.pick(this.mode); });
  }
}

function begin() {
  const api = window.solidgearViewer = window.solidgearViewer || { all: [] };
  for (const root of document.querySelectorAll(".sg-turn:not([data-begun])")) {
    root.dataset.begun = "yes";
    const failed = error => { root.classList.remove("on"); root.querySelector(".why").textContent = `The model cannot be turned here: ${error.message}.`; };
    try {
      if (!window.DecompressionStream) throw new Error("this browser is too old to unpack it");
      const viewer = new Viewer(root);
      viewer.ready.catch(failed); api.all.push(viewer);
    } catch (error) { failed(error); }
  }
  const first = api.all[0];
  if (first) Object.assign(api, { ready: first.ready, frame: t => first.frame(t), rotate: (x, y) => first.rotate(x, y), pick: m => first.pick(m), section: (on, a) => first.section(on, a) });
}
if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", begin); else begin();

// Surfaces of the viewer: unpacks what packing.py packed, and shades it.
const CREASE = Math.cos(32 * Math.PI / 180); // edges sharper than this stay sharp, and are drawn

// ---- unpacking
async function counts(text) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const b = new Uint8Array(await new Response(plain).arrayBuffer()), n = b.length / 4;
  const out = new Uint32Array(n);
  for (let i = 0; i < n; i++) out[i] = b[i] | b[n + i] << 8 | b[2 * n + i] << 16 | b[3 * n + i] << 24;
  return out;
}

function corners(code) { // counts back from the next new point
  const t = new Uint32Array(code.length);
  for (let i = 0, next = 0; i < t.length; i++) { t[i] = next - code[i]; if (!code[i]) next++; }
  return t;
}

function foretelling(t, n) { // the points a, b, c of which a + b - c foretells each
  const out = new Int32Array(3 * n), seen = new Map();
  let next = 0;
  for (let k = 0; k < t.length; k += 3) {
    for (let j = 0; j < 3; j++) {
      if (t[k + j] !== next) continue;
      const a = t[k + (j + 1) % 3], b = t[k + (j + 2) % 3];
      const c = a < n && b < n ? seen.get(Math.min(a, b) * n + Math.max(a, b)) : undefined;
      out.set(c === undefined ? [next - 1, 0, 0] : [a, b, c], 3 * next++);
    }
    for (let j = 0; j < 3; j++) {
      const a = t[k + (j + 1) % 3], b = t[k + (j + 2) % 3], key = Math.min(a, b) * n + Math.max(a, b);
      if (!seen.has(key)) seen.set(key, t[k + j]);
    }
  }
  return out;
}

async function values(text, model, step) {
  const code = await counts(text), n = model.count, f = model.foretold, whole = new Int32Array(n), out = new Float64Array(3 * n);
  for (let c = 0; c < 3; c++) for (let i = 0; i < n; i++) {
    const v = code[c * n + i], rest = v & 1 ? -((v + 1) / 2) : v / 2;
    whole[i] = rest + (i ? whole[f[3 * i]] + whole[f[3 * i + 1]] - whole[f[3 * i + 2]] : 0);
    out[3 * i + c] = whole[i] * step;
  }
  return out;
}

// ---- shading: corners of triangles share a normal across edges that are not sharp
function areas(p, t) {
  const out = new Float64Array(t.length);
  for (let k = 0; k < t.length; k += 3) {
    const a = 3 * t[k], b = 3 * t[k + 1], c = 3 * t[k + 2];
    const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
    const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
    out[k] = uy * vz - uz * vy; out[k + 1] = uz * vx - ux * vz; out[k + 2] = ux * vy - uy * vx;
  }
  return out;
}

function shared(model) {
  const t = model.t, n = model.count, area = areas(model.rest, t), root = Uint32Array.from(t.keys());
  const find = i => { while (root[i] !== i) i = root[i] = root[root[i]]; return i; };
  const sharp = [], seen = new Map();
  const cosine = (k, l) => {
    const dot = area[k] * area[l] + area[k + 1] * area[l + 1] + area[k + 2] * area[l + 2];
    return dot / (Math.hypot(area[k], area[k + 1], area[k + 2]) * Math.hypot(area[l], area[l + 1], area[l + 2]) || 1);
  };
  for (let i = 0; i < t.length; i++) {
    const k = i - i % 3, j = k + (i + 1) % 3, a = t[i], b = t[j], key = Math.min(a, b) * n + Math.max(a, b);
    const other = seen.get(key);
    if (other === undefined) { seen.set(key, i); continue; }
    const l = other - other % 3, end = l + (other + 1) % 3;
    if (cosine(k, l) < CREASE) { sharp.push(a, b); continue; }
    const [mine, next] = t[other] === a ? [other, end] : [end, other];
    root[find(i)] = find(mine); root[find(j)] = find(next);
  }
  const number = new Int32Array(t.length).fill(-1), index = new Uint32Array(t.length), source = [];
  for (let i = 0; i < t.length; i++) {
    const r = find(i);
    if (number[r] < 0) { number[r] = source.length; source.push(t[i]); }
    index[i] = number[r];
  }
  return { index, source: Uint32Array.from(source), sharp: Uint32Array.from(sharp) };
}

function normals(p, model) {
  const area = areas(p, model.t), out = new Float32Array(3 * model.source.length);
  for (let i = 0; i < model.index.length; i++) {
    const k = i - i % 3, v = 3 * model.index[i];
    out[v] += area[k]; out[v + 1] += area[k + 1]; out[v + 2] += area[k + 2];
  }
  for (let v = 0; v < out.length; v += 3) {
    const size = Math.hypot(out[v], out[v + 1], out[v + 2]) || 1;
    out[v] /= size; out[v + 1] /= size; out[v + 2] /= size;
  }
  return out;
}

const picked = (p, at) => {
  const out = new Float32Array(3 * at.length);
  for (let i = 0; i < at.length; i++) for (let c = 0; c < 3; c++) out[3 * i + c] = p[3 * at[i] + c];
  return out;
};

// A model is a body, or several that move in the same modes: the first, and those along with it, each in axes of its own.
const bodies = model => [model, ...(model.along || [])];
const REST = { rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1], origin: [0, 0, 0] };
const placing = body => body.rotation ? body : REST;
const placed = (body, p) => { const { rotation: r, origin } = placing(body); return origin.map((v, c) => v + r[3 * c] * p[0] + r[3 * c + 1] * p[1] + r[3 * c + 2] * p[2]); };

async function unpack(model) { // once per model
  if (model.box) return model;
  const low = [Infinity, Infinity, Infinity], high = low.map(v => -v);
  for (const body of bodies(model)) {
    await opened(body);
    for (let i = 0; i < body.rest.length; i += 3) placed(body, body.rest.subarray(i, i + 3)).forEach((v, c) => {
      low[c] = Math.min(low[c], v); high[c] = Math.max(high[c], v);
    });
  }
  model.box = { low, high, length: Math.max(...low.map((v, c) => high[c] - v)) };
  return model;
}

async function opened(model) {
  model.t = corners(await counts(model.triangles));
  model.foretold = foretelling(model.t, model.count);
  const rest = await values(model.points, model, model.step);
  model.start = Infinity; // of its axis
  for (let i = 1; i < rest.length; i += 3) model.start = Math.min(model.start, rest[i]);
  model.rest = rest;
  return Object.assign(model, shared(model));
}

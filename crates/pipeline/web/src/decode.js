// Numbers out of text: what the program wrote as base64 of little-endian whole numbers and floats (docs/formats.md, "The report").

/** The bytes of some base64. */
export function bytes(text) {
  const raw = atob(text);
  const out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
  return out;
}

const OFFSET_PX = 1024;
const PARTS = 8;
const px = (whole) => whole / PARTS - OFFSET_PX;

/** An outline: a sample stands for a short stretch `x, y` (recorded px) with its outward unit normal and length, and its residual (px, NaN for none). */
export function outlineOf({ place, inset_px: inset, samples, residuals }) {
  const s = new Uint16Array(bytes(samples).buffer);
  const r = new Int16Array(bytes(residuals).buffer);
  const points = Array.from(r, (residual, i) => {
    const turn = s[4 * i + 2] / 65536 * 2 * Math.PI;
    return { x: px(s[4 * i]), y: px(s[4 * i + 1]), nx: Math.cos(turn), ny: Math.sin(turn), length: s[4 * i + 3] / PARTS, residual: residual === -32768 ? NaN : residual / 100 };
  });
  return { place, inset, points };
}

/** Edge curves: flat arrays of recorded px, and for which bodies each is (none: for all). */
export function edgesOf({ counts, points, bodies }) {
  const p = new Uint16Array(bytes(points).buffer);
  let at = 0;
  return counts.map((count, k) => {
    const n = Math.abs(count);
    const xy = new Float32Array(2 * n);
    for (let i = 0; i < 2 * n; i++) xy[i] = px(p[at + i]);
    at += 2 * n;
    return { xy, closed: count < 0, bodies: bodies[k] ?? null };
  });
}

/** A mesh about its body's centroid, with the two faces of each edge. */
export function meshOf({ vertices, triangles, middle }, centroid) {
  const v = new Float32Array(bytes(vertices).buffer);
  const t = new Uint32Array(bytes(triangles).buffer);
  const about = centroid ?? middle;
  const xyz = new Float64Array(v.length);
  let radius = 0;
  for (let i = 0; i < v.length; i++) xyz[i] = v[i] + middle[i % 3] - about[i % 3];
  for (let i = 0; i < v.length; i += 3) radius += Math.hypot(xyz[i], xyz[i + 1], xyz[i + 2]) * 3 / v.length;
  const sides = new Map();
  const edges = [];
  for (let face = 0; face < t.length / 3; face++) {
    for (let k = 0; k < 3; k++) {
      const [a, b] = [t[3 * face + k], t[3 * face + (k + 1) % 3]];
      const key = Math.min(a, b) * (v.length / 3) + Math.max(a, b);
      const known = sides.get(key);
      if (known) known.faces.push(face);
      else { const edge = { a, b, faces: [face] }; sides.set(key, edge); edges.push(edge); }
    }
  }
  return { xyz, triangles: t, edges, centroid: about, radius };
}

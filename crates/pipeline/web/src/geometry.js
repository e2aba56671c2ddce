// Poses, projection and the outline of a mesh. Frames and signs are those of docs/conventions.md: `x_world = R x_model + t`, quaternions with
// their scalar first, `w (x, y, 1) = M (X - source)`.

export const add = (a, b) => a.map((v, i) => v + b[i]);
export const sub = (a, b) => a.map((v, i) => v - b[i]);
export const scale = (a, s) => a.map((v) => v * s);
export const dot = (a, b) => a.reduce((sum, v, i) => sum + v * b[i], 0);
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const norm = (a) => Math.hypot(...a);
export const unit = (a) => scale(a, 1 / (norm(a) || 1));
export const times = (m, v) => m.map((row) => dot(row, v));

/** Product of two quaternions. */
export function product([a, b, c, d], [e, f, g, h]) {
  return [a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g, a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e];
}

/** The quaternion of a rotation vector, rad. */
export function turn(v) {
  const angle = norm(v);
  const s = angle > 1e-12 ? Math.sin(angle / 2) / angle : 0.5;
  return [Math.cos(angle / 2), ...scale(v, s)];
}

/** The rotation vector of a quaternion, rad, the shorter way. */
export function vectorOf(q) {
  const [w, ...v] = q[0] < 0 ? scale(q, -1) : q;
  const s = norm(v);
  return s < 1e-12 ? scale(v, 2) : scale(v, 2 * Math.atan2(s, w) / s);
}

export const conjugate = ([w, x, y, z]) => [w, -x, -y, -z];

/** Rows of the rotation of a quaternion. */
export function matrixOf([w, x, y, z]) {
  return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]];
}

/** A pose as seven numbers: translation (mm), quaternion. It is held by where the centroid is, because one turns about that. */
export function placed(pose, centroid) {
  const q = pose.slice(3);
  return { q, at: add(pose.slice(0, 3), times(matrixOf(q), centroid)) };
}

/** The seven numbers of a placed body. */
export function poseOf({ q, at }, centroid) {
  const n = norm(q) * (q[0] < 0 ? -1 : 1);
  const unitq = scale(q, 1 / n);
  return [...sub(at, times(matrixOf(unitq), centroid)), ...unitq];
}

/** Turns by a rotation vector about the centroid, along laboratory axes, and moves, mm. */
export function moved({ q, at }, move, rotation) {
  if (!norm(rotation)) return { q, at: add(at, move) };
  const next = product(turn(rotation), q);
  return { q: scale(next, 1 / norm(next)), at: add(at, move) };
}

/** Ideal pixel and depth of a laboratory point. */
export function project(view, x) {
  const h = times(view.matrix, sub(x, view.source));
  return [h[0] / h[2], h[1] / h[2], h[2]];
}

/** The laboratory point that an ideal pixel shows at a depth, mm. */
export const unproject = (view, [x, y], depth) => add(view.source, times(view.inverse, [x * depth, y * depth, depth]));

/** The recorded pixel of an ideal one, by the grid that the program wrote. */
export function recorded(view, x, y) {
  const grid = view.recorded;
  if (!grid) return [x, y];
  const limit = grid.count - 1;
  const [u, v] = [(x - grid.first[0]) / grid.step[0], (y - grid.first[1]) / grid.step[1]];
  const [i, j] = [u, v].map((c) => Math.max(0, Math.min(limit - 1, Math.floor(c))));
  const corner = (di, dj) => grid.px[(j + dj) * grid.count + i + di];
  const all = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
  if (all.some((c) => !c)) return [x, y];
  const [s, t] = [u - i, v - j];
  return [0, 1].map((k) => (1 - t) * ((1 - s) * all[0][k] + s * all[1][k]) + t * ((1 - s) * all[2][k] + s * all[3][k]));
}

/** Cells along the longer side of a shadow. */
const CELLS = 320;

/**
 * The outline of a posed mesh in a view: stretches of its rim that bound its shadow, in recorded px, each with its outward unit normal.
 * A rim edge lies between a face that looks at the source and one that does not; it bounds the shadow where no face covers what is beside it.
 */
export function outline(mesh, pose, view) {
  const m = matrixOf(pose.q);
  const count = mesh.xyz.length / 3;
  const xy = new Float64Array(2 * count);
  let [x0, y0, x1, y1] = [Infinity, Infinity, -Infinity, -Infinity];
  for (let i = 0; i < count; i++) {
    const p = [mesh.xyz[3 * i], mesh.xyz[3 * i + 1], mesh.xyz[3 * i + 2]];
    const [x, y, depth] = project(view, add(pose.at, times(m, p)));
    if (!(depth > 0)) return [];
    xy[2 * i] = x; xy[2 * i + 1] = y;
    x0 = Math.min(x0, x); x1 = Math.max(x1, x); y0 = Math.min(y0, y); y1 = Math.max(y1, y);
  }
  const cell = Math.max(x1 - x0, y1 - y0, 1e-6) / CELLS;
  const width = Math.ceil((x1 - x0) / cell) + 5, height = Math.ceil((y1 - y0) / cell) + 5;
  const at = (x, y) => [(x - x0) / cell + 2, (y - y0) / cell + 2];
  const shadow = new Uint8Array(width * height);
  const t = mesh.triangles;
  const front = new Uint8Array(t.length / 3);
  for (let face = 0; face < front.length; face++) {
    const [a, b, c] = [t[3 * face], t[3 * face + 1], t[3 * face + 2]];
    const area = (xy[2 * b] - xy[2 * a]) * (xy[2 * c + 1] - xy[2 * a + 1]) - (xy[2 * c] - xy[2 * a]) * (xy[2 * b + 1] - xy[2 * a + 1]);
    front[face] = area > 0 ? 1 : 0;
    fill(shadow, width, height, [a, b, c].map((k) => at(xy[2 * k], xy[2 * k + 1])));
  }
  const pieces = [];
  for (const { a, b, faces } of mesh.edges) {
    if (faces.length === 2 && front[faces[0]] === front[faces[1]]) continue;
    const [ax, ay, bx, by] = [xy[2 * a], xy[2 * a + 1], xy[2 * b], xy[2 * b + 1]];
    const length = Math.hypot(bx - ax, by - ay);
    if (length < 1e-9) continue;
    let [nx, ny] = [(by - ay) / length, (ax - bx) / length];
    const third = [0, 1, 2].map((k) => t[3 * faces[0] + k]).find((k) => k !== a && k !== b);
    // Both faces of a rim edge lie on the shadow's side of it.
    if ((xy[2 * third] - ax) * nx + (xy[2 * third + 1] - ay) * ny > 0) { nx = -nx; ny = -ny; }
    const [cx, cy] = at((ax + bx) / 2 + 1.5 * cell * nx, (ay + by) / 2 + 1.5 * cell * ny);
    if (shadow[Math.round(cy) * width + Math.round(cx)]) continue;
    const [p, q] = [recorded(view, ax, ay), recorded(view, bx, by)];
    pieces.push({ ax: p[0], ay: p[1], bx: q[0], by: q[1], nx, ny });
  }
  return pieces;
}

/** Marks the cells whose centres a triangle covers. */
function fill(cells, width, height, [[ax, ay], [bx, by], [cx, cy]]) {
  const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
  if (!area) return;
  const s = Math.sign(area);
  const from = (a, b, c) => Math.max(0, Math.ceil(Math.min(a, b, c)));
  const [top, bottom] = [from(ay, by, cy), Math.min(height - 1, Math.floor(Math.max(ay, by, cy)))];
  const [left, right] = [from(ax, bx, cx), Math.min(width - 1, Math.floor(Math.max(ax, bx, cx)))];
  for (let y = top; y <= bottom; y++) {
    for (let x = left; x <= right; x++) {
      const inside = s * ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) >= 0 && s * ((cx - bx) * (y - by) - (x - bx) * (cy - by)) >= 0 && s * ((ax - cx) * (y - cy) - (x - cx) * (ay - cy)) >= 0;
      if (inside) cells[y * width + x] = 1;
    }
  }
}

/** Side of a cell of edges, px; as far as one looks for an edge. */
const REACH_PX = 16;
const MIN_COSINE = 0.7;

/** Edge curves sorted into cells, with the direction across each (from dark to bright), for a body. */
export function edgeIndex(curves, place) {
  const cells = new Map();
  for (const { xy, closed, bodies } of curves) {
    if (bodies && !bodies.includes(place)) continue;
    const n = xy.length / 2;
    for (let i = 0; i < n; i++) {
      const [before, after] = [i > 0 ? i - 1 : closed ? n - 1 : 0, i + 1 < n ? i + 1 : closed ? 0 : n - 1];
      const [cx, cy] = [xy[2 * after] - xy[2 * before], xy[2 * after + 1] - xy[2 * before + 1]];
      const length = Math.hypot(cx, cy) || 1;
      // The course of a curve is its direction turned by a quarter from x to y.
      const point = { x: xy[2 * i], y: xy[2 * i + 1], dx: cy / length, dy: -cx / length };
      const key = `${Math.floor(point.x / REACH_PX)},${Math.floor(point.y / REACH_PX)}`;
      if (cells.has(key)) cells.get(key).push(point); else cells.set(key, [point]);
    }
  }
  return cells;
}

/**
 * How an outline fits its edges: of each stretch how far outside it the nearest edge of its direction lies (px, less the inset), the root mean
 * square, and the share of the length on the picture that found one.
 */
export function fit(pieces, index, { size, inset, bright }) {
  let [sum, found, all] = [0, 0, 0];
  const residuals = pieces.map(({ ax, ay, bx, by, nx, ny }) => {
    const [x, y, length] = [(ax + bx) / 2, (ay + by) / 2, Math.hypot(bx - ax, by - ay)];
    if (x < 0 || y < 0 || x > size[0] - 1 || y > size[1] - 1) return NaN;
    all += length;
    let [best, residual] = [REACH_PX ** 2, NaN];
    const [ci, cj] = [Math.floor(x / REACH_PX), Math.floor(y / REACH_PX)];
    for (let j = cj - 1; j <= cj + 1; j++) {
      for (let i = ci - 1; i <= ci + 1; i++) {
        for (const e of index.get(`${i},${j}`) ?? []) {
          const d = (e.x - x) ** 2 + (e.y - y) ** 2;
          if (d >= best) continue;
          const cosine = (e.dx * nx + e.dy * ny) * (bright ? -1 : 1);
          if (cosine < MIN_COSINE) continue;
          best = d;
          // Along the outline's normal to the edge's tangent.
          residual = ((e.x - x) * e.dx + (e.y - y) * e.dy) / (e.dx * nx + e.dy * ny) + inset;
        }
      }
    }
    if (!Number.isNaN(residual)) { sum += residual * residual * length; found += length; }
    return residual;
  });
  return { residuals, rms: Math.sqrt(sum / found), share: all ? found / all : NaN };
}

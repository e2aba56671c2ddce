// A picture with what is drawn over it: zoomed with the wheel, moved with the mouse, all vectors in recorded pixels.

const NO_EDGE = '#9aa0a6';

/** Colour of a residual, px: grey-blue where it fits, yellow at 0.5, red from 1.5. */
export function heat(residual) {
  if (Number.isNaN(residual)) return NO_EDGE;
  const t = Math.min(1, Math.abs(residual) / 1.5);
  const stops = [[0, [64, 190, 160]], [0.33, [240, 220, 80]], [1, [240, 60, 60]]];
  const k = t < 0.33 ? 0 : 1;
  const s = (t - stops[k][0]) / (stops[k + 1][0] - stops[k][0]);
  return `rgb(${stops[k][1].map((v, i) => Math.round(v + s * (stops[k + 1][1][i] - v))).join(',')})`;
}

/** How many times residuals are drawn larger than they are. */
const MAGNIFIED = 12;

export class Picture {
  /** @param {HTMLElement} host gets the canvas, a label and a button */
  constructor(host) {
    this.host = host;
    host.classList.add('view');
    host.innerHTML = '<canvas tabindex="0"></canvas><div class="tag"></div><div class="tools"><button type="button" title="Whole picture (double click)">fit</button></div>';
    this.canvas = host.querySelector('canvas');
    this.tag = host.querySelector('.tag');
    this.view = null;
    this.scale = 0;
    this.offset = [0, 0];
    this.overlay = null;
    this.drag = null;
    /** Takes a drag if it returns true; without, or with the middle button, the picture is moved. */
    this.grab = null;
    host.querySelector('button').addEventListener('click', () => this.fit());
    this.canvas.addEventListener('dblclick', () => this.fit());
    this.canvas.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    this.canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    this.canvas.addEventListener('pointerdown', (event) => this.down(event));
    this.canvas.addEventListener('pointermove', (event) => this.move(event));
    for (const end of ['pointerup', 'pointercancel']) this.canvas.addEventListener(end, () => this.up());
    new ResizeObserver(() => { if (this.resize()) this.draw(); }).observe(host);
  }

  resize() {
    const { clientWidth: w, clientHeight: h } = this.host;
    if (!w || !h) return false;
    const ratio = window.devicePixelRatio || 1;
    const fitted = !this.scale || this.fitted;
    this.canvas.width = Math.round(w * ratio);
    this.canvas.height = Math.round(h * ratio);
    this.ratio = ratio;
    if (fitted && this.view) this.whole();
    return true;
  }

  whole() {
    const [w, h] = this.view.size;
    this.scale = Math.min(this.canvas.width / w, this.canvas.height / h) * 0.98;
    this.offset = [(this.canvas.width - w * this.scale) / 2, (this.canvas.height - h * this.scale) / 2];
    this.fitted = true;
  }

  fit() { if (this.view) { this.whole(); this.draw(); } }

  /** Recorded px of a place on the canvas, CSS px. */
  pixel(x, y) { return [x, y].map((v, k) => (v * this.ratio - this.offset[k]) / this.scale - 0.5); }

  wheel(event) {
    event.preventDefault();
    if (this.turnWheel?.(event)) return;
    const factor = Math.exp(-event.deltaY * 0.0015);
    const at = [event.offsetX * this.ratio, event.offsetY * this.ratio];
    const scale = Math.max(0.05, Math.min(64, this.scale * factor));
    this.offset = this.offset.map((o, k) => at[k] - (at[k] - o) * scale / this.scale);
    this.scale = scale;
    this.fitted = false;
    this.draw();
  }

  down(event) {
    this.canvas.focus({ preventScroll: true });
    try { this.canvas.setPointerCapture(event.pointerId); } catch { /* an event that a test made */ }
    const own = event.button !== 1 && this.grab?.(event);
    this.drag = { x: event.clientX, y: event.clientY, own };
  }

  move(event) {
    if (!this.drag) return;
    const delta = [event.clientX - this.drag.x, event.clientY - this.drag.y];
    Object.assign(this.drag, { x: event.clientX, y: event.clientY });
    if (this.drag.own) { this.drag.own(scaled(delta, this.ratio / this.scale), event); return; }
    this.offset = this.offset.map((o, k) => o + delta[k] * this.ratio);
    this.fitted = false;
    this.draw();
  }

  up() { const own = this.drag?.own; this.drag = null; if (own) this.released?.(); }

  /** Shows the picture of a frame. `overlay(pen)` draws over it. */
  show(view, overlay) {
    const first = !this.view || String(this.view.size) !== String(view.size);
    this.view = view;
    this.overlay = overlay;
    if (first) { this.scale = 0; this.resize(); }
    this.draw();
  }

  draw() {
    if (!this.view || !this.canvas.width || !this.scale) return;
    const pen = this.canvas.getContext('2d');
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.setTransform(this.scale, 0, 0, this.scale, this.offset[0], this.offset[1]);
    pen.imageSmoothingEnabled = this.scale < 3;
    const look = Picture.look;
    pen.filter = look.brightness === 100 && look.contrast === 100 ? 'none' : `brightness(${look.brightness}%) contrast(${look.contrast}%)`;
    pen.drawImage(this.view.image, 0, 0, this.view.size[0], this.view.size[1]);
    pen.filter = 'none';
    // The centre of the first pixel is at (0, 0).
    pen.translate(0.5, 0.5);
    pen.lineCap = 'butt';
    this.overlay?.(pen, this.ratio / this.scale);
  }
}
/** Brightness and contrast of all pictures, per cent. */
Picture.look = { brightness: 100, contrast: 100 };

const scaled = (v, s) => v.map((c) => c * s);

/** Draws edge curves; `px` is the width of one screen pixel. */
export function drawEdges(pen, curves, px) {
  pen.lineWidth = px;
  pen.strokeStyle = 'rgba(255,255,120,.55)';
  pen.beginPath();
  for (const { xy, closed } of curves) {
    pen.moveTo(xy[0], xy[1]);
    for (let i = 2; i < xy.length; i += 2) pen.lineTo(xy[i], xy[i + 1]);
    if (closed) pen.closePath();
  }
  pen.stroke();
}

/** Draws an outline of samples: in the body's colour, broken where its match failed, or by its residuals with short normals. */
export function drawOutline(pen, points, px, { colour, failed, residuals }) {
  const stretch = (p) => {
    const half = Math.max(p.length, 1.2) / 2 + 0.15;
    pen.moveTo(p.x - half * p.ny, p.y + half * p.nx);
    pen.lineTo(p.x + half * p.ny, p.y - half * p.nx);
  };
  pen.lineWidth = 1.7 * px;
  if (!residuals) {
    pen.strokeStyle = colour;
    pen.beginPath();
    for (const p of points) if (!failed || (p.x + p.y) / 9 % 2 < 1) stretch(p);
    pen.stroke();
    return;
  }
  const groups = new Map();
  points.forEach((p, i) => {
    const key = heat(Number.isNaN(p.residual) ? NaN : Math.round(p.residual * 10) / 10);
    if (!groups.has(key)) groups.set(key, []);
    groups.get(key).push([p, i]);
  });
  for (const [key, list] of groups) {
    pen.strokeStyle = key;
    pen.lineWidth = 1.9 * px;
    pen.beginPath();
    for (const [p] of list) stretch(p);
    pen.stroke();
    if (key === NO_EDGE) continue;
    pen.lineWidth = px;
    pen.beginPath();
    for (const [p, i] of list) {
      if (i % 2) continue;
      pen.moveTo(p.x, p.y);
      pen.lineTo(p.x + p.nx * p.residual * MAGNIFIED, p.y + p.ny * p.residual * MAGNIFIED);
    }
    pen.stroke();
  }
}

/** Draws stretches of a rim that were computed here, by their residuals where given. */
export function drawPieces(pen, pieces, px, colour, residuals) {
  const groups = new Map();
  pieces.forEach((piece, i) => {
    const key = residuals ? heat(Number.isNaN(residuals[i]) ? NaN : Math.round(residuals[i] * 10) / 10) : colour;
    if (!groups.has(key)) groups.set(key, []);
    groups.get(key).push(piece);
  });
  pen.lineWidth = 1.8 * px;
  for (const [key, list] of groups) {
    pen.strokeStyle = key;
    pen.beginPath();
    for (const { ax, ay, bx, by } of list) { pen.moveTo(ax, ay); pen.lineTo(bx, by); }
    pen.stroke();
  }
}

/** Samples of an outline in the order along it: from each to the nearest one not used yet. Gives `{ s, point }` with `s` in px. */
export function chained(points) {
  const left = new Set(points.keys());
  const out = [];
  let s = 0;
  let here = null;
  while (left.size) {
    let [best, next] = [Infinity, -1];
    for (const i of left) {
      const d = here === null ? points[i].x + points[i].y : (points[i].x - points[here].x) ** 2 + (points[i].y - points[here].y) ** 2;
      if (d < best) { best = d; next = i; }
    }
    if (here !== null) {
      const step = Math.sqrt(best);
      // A gap begins another piece.
      if (step > 8) { out.push({ s: s + 1, point: null }); s += 8; } else s += step;
    }
    left.delete(next);
    here = next;
    out.push({ s, point: points[next] });
  }
  return out;
}

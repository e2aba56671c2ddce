// Verdicts of every frame and body at a glance, what wants a look first, and the table of all poses.

import { colour, el, fixed } from './dom.js';
import { VERDICTS, lookAt, onChange, shown, state, study } from './study.js';

/** How high the bar of a verdict is, of the strip's height: so it can be told without its colour. */
const HEIGHTS = { g: 0.3, d: 0.6, a: 0.8, f: 1 };

/** Goes to a frame in the part of the page that shows frames. */
export function goTo(trial, frame) {
  lookAt(trial, frame);
  location.hash = `frame/${encodeURIComponent(study.trials[trial].name)}/${encodeURIComponent(study.trials[trial].frames[frame])}`;
}

/** A strip of a body's verdicts over a trial; a click goes to the frame. */
export function strip(trial, place, click) {
  const { rows, frames } = study.trials[trial];
  const canvas = el('canvas', { tabindex: 0, role: 'img', 'aria-label': said(rows[place].verdicts) });
  const at = (event) => Math.max(0, Math.min(frames.length - 1, Math.floor(event.offsetX / canvas.clientWidth * frames.length)));
  canvas.addEventListener('click', (event) => click(trial, at(event)));
  canvas.addEventListener('mousemove', (event) => {
    const frame = at(event);
    canvas.title = `${frames[frame]}: ${VERDICTS[rows[place].verdicts[frame]]}${rows[place].reasons[frame] ? ` (${rows[place].reasons[frame]})` : ''}`;
  });
  const draw = () => {
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio];
    if (!width) return;
    Object.assign(canvas, { width, height });
    const pen = canvas.getContext('2d');
    pen.fillStyle = colour('line');
    pen.fillRect(0, 0, width, height);
    const step = width / frames.length;
    const gap = step > 5 * ratio ? ratio : 0;
    // Good ones first, so that one bad frame among many to a pixel is seen.
    for (const letter of 'gdaf') {
      pen.fillStyle = colour(`${VERDICTS[letter]}-mark`);
      for (let i = 0; i < frames.length; i++) {
        if (rows[place].verdicts[i] !== letter) continue;
        pen.fillRect(i * step, height * (1 - HEIGHTS[letter]), Math.max(step - gap, ratio), height * HEIGHTS[letter]);
      }
    }
    if (step > 12 * ratio) {
      pen.fillStyle = colour('ink');
      pen.font = `${10 * ratio}px system-ui`;
      pen.textAlign = 'center';
      for (let i = 0; i < frames.length; i++) {
        if (rows[place].verdicts[i] !== 'g') pen.fillText(rows[place].verdicts[i].toUpperCase(), (i + 0.5) * step, height - 3 * ratio);
      }
    }
    pen.fillStyle = colour('focus');
    for (const i of rows[place].edited) pen.fillRect(i * step, 0, Math.max(step - gap, 2 * ratio), 3 * ratio);
    if (state.trial === trial) {
      pen.strokeStyle = colour('ink');
      pen.lineWidth = 2 * ratio;
      pen.strokeRect(state.frame * step + 1, 1, Math.max(step - gap, 3 * ratio) - 2 + (step < 4 ? 3 : 0), height - 2);
    }
  };
  new ResizeObserver(draw).observe(canvas);
  onChange(draw);
  return canvas;
}

function said(verdicts) {
  return Object.entries(VERDICTS).map(([letter, word]) => `${[...verdicts].filter((v) => v === letter).length} ${word}`).join(', ');
}

/** The name of a body with its colour. */
export function named(trial, place) {
  const t = study.trials[trial];
  return el('span', { class: 'name' }, el('i', { class: 'c', style: `background:${t.colours[place]}` }), study.bodies[t.bodies[place]].name);
}

/** Strips of all bodies of a trial. */
export function strips(trial, click) {
  return study.trials[trial].bodies.map((_, place) => el('div', { class: 'strip' }, named(trial, place), strip(trial, place, click),
    el('span', { class: 'soft' }, said(study.trials[trial].rows[place].verdicts).replace(/(^|, )0 \w+/g, '').replace(/^, /, ''))));
}

export function legend() {
  const mark = (letter) => el('span', {}, el('i', { style: `background:var(--${VERDICTS[letter]}-mark);height:${11 * HEIGHTS[letter]}px` }), VERDICTS[letter]);
  return el('div', { class: 'legend' }, ...'gdaf'.split('').map(mark),
    el('span', {}, el('i', { style: 'background:var(--focus);height:3px' }), 'edited by hand'), 'click: go to the frame');
}

/** Poses that want a look, the worst first: not good, then with an outline that is not clear, then good ones by how badly they fit. */
export function worst() {
  const all = [];
  study.trials.forEach((trial, t) => trial.rows.forEach((row, place) => {
    for (let frame = 0; frame < trial.frames.length; frame++) {
      const badness = 1000 * 'gdaf'.indexOf(row.verdicts[frame]) + (row.look[frame] && !row.edited.includes(frame) ? 500 : 0);
      const fit = Math.max(0, ...(row.rms_px[frame] ?? [9]));
      all.push({ trial: t, place, frame, badness: badness + Math.min(99, fit) });
    }
  }));
  return all.sort((a, b) => b.badness - a.badness || a.trial - b.trial || a.frame - b.frame);
}

const MOST = 12;
const PAGE = 200;

export function overview() {
  const host = document.getElementById('strips');
  study.trials.forEach((trial, t) => host.append(el('div', { class: 'panel' }, el('h3', {}, trial.name, ' ', el('small', { class: 'soft' }, `${trial.frames.length} frames`)), strips(t, goTo), t === study.trials.length - 1 ? legend() : null)));
  const first = worst().filter((item) => item.badness >= 500);
  if (first.length) {
    const line = ({ trial, place, frame }) => {
      const { name, frames, rows, bodies } = study.trials[trial];
      const row = rows[place];
      return el('tr', {}, el('td', { class: 't' }, link(trial, frame, `${name} · ${frames[frame]}`)), el('td', { class: 't' }, study.bodies[bodies[place]].name),
        el('td', { class: 't' }, pill(row.verdicts[frame])), el('td', { class: 'reason' }, [row.reasons[frame], row.look[frame]].filter(Boolean).join('; ')));
    };
    const body = el('tbody', {}, first.slice(0, MOST).map(line));
    const more = first.length > MOST ? el('button', { type: 'button', onclick: (event) => { body.append(...first.slice(MOST, 500).map(line)); event.target.remove(); } }, `all ${first.length}`) : null;
    document.getElementById('first').append(el('h2', {}, `Look at these first (${first.length})`), el('div', { class: 'table' }, el('table', {}, body)), el('p', {}, more, ' ', el('a', { href: '#review' }, 'put poses right in the review')));
  }
  table(document.getElementById('table'));
}

const link = (trial, frame, text) => el('a', { href: `#frame/${encodeURIComponent(study.trials[trial].name)}/${encodeURIComponent(study.trials[trial].frames[frame])}` }, text);
export const pill = (letter) => el('span', { class: `v ${VERDICTS[letter]}` }, VERDICTS[letter]);

/** All poses; as many rows at a time as one can look through. */
function table(host) {
  const rows = [];
  study.trials.forEach((trial, t) => trial.frames.forEach((_, frame) => trial.rows.forEach((_, place) => rows.push([t, frame, place]))));
  let [only, page] = [false, 0];
  const body = el('tbody');
  const where = el('span', { class: 'soft' });
  const show = () => {
    const chosen = only ? rows.filter(([t, frame, place]) => study.trials[t].rows[place].verdicts[frame] !== 'g') : rows;
    const pages = Math.max(1, Math.ceil(chosen.length / PAGE));
    page = Math.max(0, Math.min(pages - 1, page));
    where.textContent = `${chosen.length ? page * PAGE + 1 : 0} to ${Math.min(chosen.length, (page + 1) * PAGE)} of ${chosen.length}`;
    body.replaceChildren(...chosen.slice(page * PAGE, (page + 1) * PAGE).map(([t, frame, place]) => {
      const { name, frames, times, bodies, rows: of } = study.trials[t];
      const row = of[place];
      const half = row.half_95[frame];
      const views = (list, scale, digits) => (list ?? []).map((v) => fixed(v * scale, digits)).join(' / ');
      return el('tr', {}, el('td', { class: 't' }, link(t, frame, `${study.trials.length > 1 ? `${name} · ` : ''}${frames[frame]}`)), el('td', {}, fixed(times[frame], 3)),
        el('td', { class: 't' }, study.bodies[bodies[place]].name), el('td', { class: 't' }, pill(row.verdicts[frame])), el('td', {}, fixed(row.fit_mm[frame], 3)),
        el('td', {}, views(row.rms_px[frame], 1, 2)), el('td', {}, views(row.share[frame], 100, 0)), el('td', {}, half ? half.slice(0, 3).map((v) => fixed(v, 2)).join(' / ') : ''),
        el('td', {}, half ? half.slice(3).map((v) => fixed(v, 2)).join(' / ') : ''), el('td', { class: 'reason' }, [row.reasons[frame], row.look[frame]].filter(Boolean).join('; ')));
    }));
  };
  const turn = (by) => () => { page += by; show(); };
  const head = ['frame', 'time s', 'body', 'verdict', 'fit mm', 'fit px, by view', 'found %, by view', '95 % ± mm x / y / z', '95 % ± ° x / y / z', 'why'];
  host.append(el('h2', {}, 'All poses'), el('div', { class: 'bar' }, label('only what is not good', (on) => { only = on; page = 0; show(); }), el('button', { type: 'button', onclick: turn(-1) }, '‹'), where, el('button', { type: 'button', onclick: turn(1) }, '›')),
    el('div', { class: 'table' }, el('table', {}, el('thead', {}, el('tr', {}, head.map((text, i) => el('th', { class: [0, 2, 3, 9].includes(i) ? 't' : null }, text)))), body)));
  show();
}

const label = (text, change) => { const box = el('input', { type: 'checkbox', onchange: () => change(box.checked) }); return el('label', {}, box, text); };
export { link, shown };

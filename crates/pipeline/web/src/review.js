// A person puts poses right: the worst ones first, the model moved over all views until its outline fits, then saved as `edits/poses.csv`.

import { el, fixed } from './dom.js';
import { add, cross, edgeIndex, fit, moved, outline, placed, poseOf, project, scale, sub, times, unit } from './geometry.js';
import { pill, worst } from './overview.js';
import { Picture, drawEdges, drawPieces } from './picture.js';
import { frameOf, models, shown, study } from './study.js';

const HEADER = 'trial,frame,body,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz';
const KEY = `biplane-review-${study.name}`;

/** A table of poses by trial, frame and body. Rows that are not understood are kept as they are. */
export class Table {
  constructor() { this.rows = new Map(); this.odd = []; }

  set(trial, frame, body, pose) {
    const cells = [...pose.slice(0, 3).map((v) => v.toFixed(4)), ...pose.slice(3).map((v) => v.toFixed(7))];
    this.rows.set([trial, frame, body].join('\u0000'), [...[trial, frame, body].map(cell), ...cells].join(','));
  }

  delete(trial, frame, body) { this.rows.delete([trial, frame, body].join('\u0000')); }

  has(trial, frame, body) { return this.rows.has([trial, frame, body].join('\u0000')); }

  /** Adds the rows of a file that are not here yet. */
  merge(text) {
    const lines = text.split(/\r?\n/).filter((line) => line.trim());
    const columns = split(lines[0] ?? '').map((name) => name.trim());
    const at = HEADER.split(',').map((name) => columns.indexOf(name));
    if (at.some((k) => k < 0)) throw new Error(`the first line of the file is not ${HEADER}`);
    let added = 0;
    for (const line of lines.slice(1)) {
      const cells = split(line);
      const row = at.map((k) => cells[k] ?? '');
      const key = row.slice(0, 3).join('\u0000');
      if (this.rows.has(key)) continue;
      this.rows.set(key, [...row.slice(0, 3).map(cell), ...row.slice(3)].join(','));
      added++;
    }
    return added;
  }

  text() { return `${[HEADER, ...[...this.rows.values()].sort()].join('\n')}\n`; }
}

const cell = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/** Cells of a line of CSV. */
function split(line) {
  const cells = [];
  const pattern = /("([^"]|"")*"|[^,]*)(,|$)/gy;
  for (let found = pattern.exec(line); found; found = pattern.exec(line)) {
    cells.push(found[1].startsWith('"') ? found[1].slice(1, -1).replaceAll('""', '"') : found[1]);
    if (!found[3]) break;
  }
  return cells;
}

export function reviewTab(host, visible) {
  const table = new Table();
  // What a person gave before stays.
  for (const trial of study.trials) {
    trial.rows.forEach((row, place) => Object.entries(row.edits).forEach(([frame, pose]) => table.set(trial.name, trial.frames[frame], study.bodies[trial.bodies[place]].name, pose)));
  }
  const given = table.rows.size;
  try { table.rows = new Map([...table.rows, ...JSON.parse(sessionStorage.getItem(KEY) ?? '[]')]); } catch { /* nothing kept */ }

  const queue = el('div', { class: 'queue' });
  const title = el('div', { class: 'bar' });
  const views = el('div', { class: 'views', style: '--height:calc(100vh - 372px)' });
  const live = el('span', { class: 'live' });
  const note = el('div', { class: 'note' }, 'Choose a pose on the left.');
  const lines = el('textarea', { readonly: true, 'aria-label': 'edits/poses.csv', spellcheck: 'false' });
  const told = el('span', { class: 'soft' });
  const button = (text, action, hint, kind) => el('button', { type: 'button', onclick: action, title: hint, class: kind }, text);
  const buttons = {
    undo: button('undo', () => step(-1), 'Ctrl Z'), redo: button('redo', () => step(1), 'Ctrl Y'), reset: button('as found', reset, 'the pose of the last run'), other: button('the other pose', other, 'the pose that fits as well'),
    take: button('take this pose', take, 'Enter: into the table below, and to the next', 'main'), drop: button('take it back', drop, 'out of the table below'),
  };
  const file = el('input', { type: 'file', accept: '.csv', hidden: true, onchange: read });
  const items = worst().filter(({ trial, frame }) => shown(trial, frame));
  host.append(el('div', { class: 'review' }, queue, el('div', {}, title, note, views,
    el('div', { class: 'bar' }, buttons.take, buttons.drop, buttons.undo, buttons.redo, buttons.reset, buttons.other, live),
    el('p', { class: 'soft' }, 'drag: move · right or ', el('kbd', {}, 'Ctrl'), ' drag: turn · ', el('kbd', {}, 'Alt'), ' drag: turn in the picture · ', el('kbd', {}, 'Shift'), ' drag up or down, or ', el('kbd', {}, 'Shift'), ' wheel: depth · wheel: zoom · middle drag: move the picture · arrows, ', el('kbd', {}, 'PgUp'), ' ', el('kbd', {}, 'PgDn'), ': small steps'),
    el('div', { class: 'panel' }, el('div', { class: 'bar' }, el('b', {}, 'edits/poses.csv'), button('save', save, 'a file', 'main'), button('copy', copy), button('merge a file…', () => file.click(), 'rows of edits/poses.csv that are not here yet'), file, told),
      lines, el('p', { class: 'soft' }, 'Put the file into the folder ', el('code', {}, 'edits/'), ' beside pipeline.toml, in place of the one there, and run again: those matches start from these poses, and nothing else runs.')))));

  let current = null;
  let pictures = [];

  const MOST = 300;
  const short = items.slice(0, MOST);
  function fill() {
    const line = (item) => {
      const t = study.trials[item.trial];
      const row = t.rows[item.place];
      const body = study.bodies[t.bodies[item.place]].name;
      const taken = table.has(t.name, t.frames[item.frame], body);
      return el('button', { type: 'button', onclick: () => open(item), 'aria-current': current && same(current.item, item) ? 'true' : null }, pill(row.verdicts[item.frame]), ` ${t.frames[item.frame]} `, taken ? '✓' : '', el('small', {}, `${body} · ${row.rms_px[item.frame] ? `${fixed(Math.max(...row.rms_px[item.frame]), 2)} px` : 'no match'}`), el('small', {}, row.reasons[item.frame] ?? ''));
    };
    queue.replaceChildren(...short.map(line));
    lines.value = table.text();
  }
  const same = (a, b) => a.trial === b.trial && a.frame === b.frame && a.place === b.place;

  let opening = null;
  async function open(item) {
    if (opening && same(opening, item)) return;
    opening = item;
    const t = study.trials[item.trial];
    const body = t.bodies[item.place];
    const name = study.bodies[body].name;
    try {
      const [frame, all] = await Promise.all([frameOf(item.trial, item.frame), models()]);
      if (opening !== item) return;
      const mesh = all.get(body);
      if (!mesh) throw new Error(`The model of ${name} is not shown; the overview says why.`);
      const row = t.rows[item.place];
      const pose = row.poses[item.frame];
      // Without a pose the body begins in the middle of what the views see together.
      const found = pose ? placed(pose, mesh.centroid) : { q: [1, 0, 0, 0], at: middle(t.views.map((v) => study.views[v])) };
      const views = frame.views.map((view) => ({
        slot: view.slot, picture: view, camera: study.views[t.views[view.slot]], index: edgeIndex(view.edges, item.place),
        inset: view.outlines.find((o) => o.place === item.place)?.inset ?? 0,
      }));
      current = { item, name, mesh, found, pose: found, past: [found], at: 0, views, alternative: row.alternatives[item.frame] };
      note.hidden = true;
      begin();
    } catch (error) {
      if (opening !== item) return;
      note.hidden = false;
      note.textContent = error.message;
    }
    if (opening === item) opening = null;
  }

  function begin() {
    const { item, name, views: of } = current;
    const t = study.trials[item.trial];
    title.replaceChildren(el('h3', {}, `${t.name} · ${t.frames[item.frame]} · ${name}`), pill(t.rows[item.place].verdicts[item.frame]), el('span', { class: 'soft' }, t.rows[item.place].reasons[item.frame] ?? ''));
    pictures = of.map((view) => {
      const picture = new Picture(el('div'));
      picture.grab = (event) => drag(view, event);
      picture.released = keep;
      picture.turnWheel = (event) => { if (!event.shiftKey) return false; change(deeper(view, -(event.deltaY || event.deltaX) * 0.02)); keep(); return true; };
      picture.canvas.addEventListener('keydown', (event) => nudge(view, event));
      return picture;
    });
    views.replaceChildren(...pictures.map((p) => p.host));
    views.style.setProperty('--columns', Math.min(3, pictures.length));
    fill();
    draw();
  }

  function draw() {
    const { item, mesh, views: of } = current;
    const t = study.trials[item.trial];
    const told = of.map((view, k) => {
      const pieces = outline(mesh, current.pose, view.camera);
      const how = fit(pieces, view.index, { size: view.picture.size, inset: view.inset, bright: study.contrast_bright });
      view.how = how;
      const picture = pictures[k];
      view.first ??= how;
      picture.tag.replaceChildren(el('b', {}, view.camera.name), `\n${fixed(how.rms, 2)} px, ${fixed(100 * how.share, 0)} % found`, `\nas found: ${fixed(view.first.rms, 2)} px, ${fixed(100 * view.first.share, 0)} %`);
      picture.show(view.picture, (pen, px) => {
        drawEdges(pen, view.picture.edges.filter((e) => !e.bodies || e.bodies.includes(item.place)), px);
        drawPieces(pen, pieces, px, t.colours[item.place], how.residuals);
      });
      return `${view.camera.name}: ${fixed(how.rms, 2)} px, ${fixed(100 * how.share, 0)} %`;
    });
    live.textContent = told.join('   ');
    buttons.undo.disabled = current.at === 0;
    buttons.redo.disabled = current.at === current.past.length - 1;
    buttons.other.hidden = !current.alternative;
    buttons.drop.hidden = !table.has(t.name, t.frames[item.frame], current.name);
  }

  /** What a drag does, by the keys held: gives what to do with each move, recorded px. */
  function drag(view, event) {
    const turning = event.button === 2 || event.ctrlKey || event.metaKey;
    const kind = event.altKey ? 'spin' : event.shiftKey ? 'depth' : turning ? 'turn' : 'move';
    return (delta) => change({ move: shifted, turn: turned, spin: spun, depth: (v, d) => deeper(v, -d[1] * 0.5) }[kind](view, delta));
  }

  const depthOf = (view) => project(view.camera, current.pose.at)[2];
  /** In the picture's plane, at the depth of the body. */
  function shifted(view, [dx, dy]) {
    const depth = depthOf(view);
    return moved(current.pose, times(view.camera.inverse, [dx * depth, dy * depth, 0]), [0, 0, 0]);
  }
  /** About axes in the picture's plane, so that what is near follows the mouse. */
  function turned(view, [dx, dy]) {
    const depth = depthOf(view);
    const by = times(view.camera.inverse, [dx * depth, dy * depth, 0]);
    const away = unit(sub(current.pose.at, view.camera.source));
    return moved(current.pose, [0, 0, 0], scale(cross(by, away), 0.5 / current.mesh.radius));
  }
  /** About the ray through the body. */
  function spun(view, [dx]) {
    return moved(current.pose, [0, 0, 0], scale(unit(sub(current.pose.at, view.camera.source)), dx * 0.005));
  }
  /** Along the ray through the body, mm. */
  function deeper(view, mm) {
    return moved(current.pose, scale(unit(sub(current.pose.at, view.camera.source)), mm), [0, 0, 0]);
  }

  function nudge(view, event) {
    if (!current) return;
    const by = { ArrowLeft: [-0.5, 0], ArrowRight: [0.5, 0], ArrowUp: [0, -0.5], ArrowDown: [0, 0.5] }[event.key];
    if (by) change(event.ctrlKey ? turned(view, scale(by, 2)) : shifted(view, by));
    else if (event.key === 'PageUp' || event.key === 'PageDown') change(deeper(view, event.key === 'PageUp' ? 0.5 : -0.5));
    else return;
    event.preventDefault();
    event.stopPropagation();
    keep();
  }

  function change(pose) { current.pose = pose; draw(); }
  function keep() {
    if (!current || current.past[current.at] === current.pose) return;
    current.past = [...current.past.slice(0, current.at + 1), current.pose];
    current.at = current.past.length - 1;
    draw();
  }
  function step(by) {
    if (!current) return;
    current.at = Math.max(0, Math.min(current.past.length - 1, current.at + by));
    change(current.past[current.at]);
  }
  function reset() { if (current) { change(current.found); keep(); } }
  function other() { if (current?.alternative) { change(placed(current.alternative, current.mesh.centroid)); keep(); } }

  const names = () => { const t = study.trials[current.item.trial]; return [t.name, t.frames[current.item.frame], current.name]; };
  function stored() { try { sessionStorage.setItem(KEY, JSON.stringify([...table.rows])); } catch { /* not kept over a reload */ } }
  function take() {
    if (!current) return;
    table.set(...names(), poseOf(current.pose, current.mesh.centroid));
    stored();
    told.textContent = `${table.rows.size} poses${given ? `, ${given} of them there before` : ''}; not saved yet`;
    const next = short[short.findIndex((item) => same(item, current.item)) + 1];
    fill();
    draw();
    if (next && study.trials[next.trial].rows[next.place].verdicts[next.frame] !== 'g') open(next);
  }
  function drop() { table.delete(...names()); stored(); fill(); draw(); }
  async function save() {
    const text = table.text();
    try {
      if (window.showSaveFilePicker) {
        const handle = await window.showSaveFilePicker({ suggestedName: 'poses.csv', types: [{ accept: { 'text/csv': ['.csv'] } }] });
        const out = await handle.createWritable();
        await out.write(text);
        await out.close();
        told.textContent = 'saved; run again to start from these poses';
        return;
      }
    } catch (error) {
      if (error.name === 'AbortError') return;
    }
    const link = el('a', { href: URL.createObjectURL(new Blob([text], { type: 'text/csv' })), download: 'poses.csv' });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    told.textContent = 'saved with the downloads; put it into edits/ beside pipeline.toml';
  }
  async function copy() {
    lines.select();
    try { await navigator.clipboard.writeText(table.text()); told.textContent = 'copied'; } catch { told.textContent = document.execCommand('copy') ? 'copied' : 'select the text and copy it'; }
  }
  async function read() {
    const [chosen] = file.files;
    if (!chosen) return;
    try { told.textContent = `${table.merge(await chosen.text())} poses added from ${chosen.name}`; } catch (error) { told.textContent = `${chosen.name}: ${error.message}`; }
    file.value = '';
    stored();
    fill();
  }

  document.addEventListener('keydown', (event) => {
    if (!visible() || !current || event.target === lines) return;
    const key = event.key.toLowerCase();
    if ((event.ctrlKey || event.metaKey) && key === 'z') { step(event.shiftKey ? 1 : -1); event.preventDefault(); }
    if ((event.ctrlKey || event.metaKey) && key === 'y') { step(1); event.preventDefault(); }
    if (key === 'enter' && event.target.tagName !== 'BUTTON') { take(); event.preventDefault(); }
  });

  function show() {
    if (!visible()) return;
    if (!queue.childElementCount) fill();
    const [, trial, frame, place] = location.hash.slice(1).split('/').map(decodeURIComponent);
    const t = study.trials.findIndex((one) => one.name === trial);
    const number = t < 0 ? -1 : study.trials[t].frames.indexOf(frame);
    if (number >= 0) {
      const item = { trial: t, frame: number, place: Math.max(0, Math.min(study.trials[t].rows.length - 1, +place || 0)) };
      if (!short.some((one) => same(one, item))) short.unshift(item);
      if (!current || !same(current.item, item)) return open(item);
    } else if (!current && short.length) return open(short[0]);
    return undefined;
  }
  return { show, current: () => current, table, pictures: () => pictures, live, take, step, draw };
}

/** The point nearest to the middle rays of all views. */
function middle(views) {
  let [sum, count] = [[0, 0, 0], 0];
  for (const a of views) {
    const ray = unit(times(a.inverse, [(a.size[0] - 1) / 2, (a.size[1] - 1) / 2, 1]));
    for (const b of views) {
      if (a === b) continue;
      const other = unit(times(b.inverse, [(b.size[0] - 1) / 2, (b.size[1] - 1) / 2, 1]));
      const n = cross(other, cross(ray, other));
      const s = n.reduce((t, v, i) => t + v * (b.source[i] - a.source[i]), 0) / n.reduce((t, v, i) => t + v * ray[i], 0);
      if (Number.isFinite(s)) { sum = add(sum, add(a.source, scale(ray, s))); count++; }
    }
    if (!count && views.length === 1) return add(a.source, scale(ray, a.detector_mm ? a.detector_mm * 0.75 : 700));
  }
  return scale(sum, 1 / Math.max(1, count));
}

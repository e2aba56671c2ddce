// Joints over a trial, and each body's six degrees of freedom, with bands of 95 %.

import { el } from './dom.js';
import { conjugate, matrixOf, product, add, times, vectorOf } from './geometry.js';
import { seriesPlot } from './plots.js';
import { goTo } from './overview.js';
import { onChange, state, study } from './study.js';

const AXES = ['x', 'y', 'z'];

/** Six series of a body: where its centroid is, mm, and its rotation vector since the first pose of the trial that is good, degrees. */
export function freedoms(trial, place) {
  const { rows, bodies } = study.trials[trial];
  const row = rows[place];
  const centroid = study.bodies[bodies[place]].centroid ?? [0, 0, 0];
  // A failed pose is only where the search ended: it would make the others unreadable.
  const used = row.poses.map((pose, i) => (pose && row.verdicts[i] !== 'f' ? pose : null));
  const first = used.findIndex((pose, i) => pose && row.verdicts[i] === 'g');
  const from = used[first >= 0 ? first : used.findIndex(Boolean)];
  const places = (poses) => poses.map((pose) => pose && add(pose.slice(0, 3), times(matrixOf(pose.slice(3)), centroid)));
  const turns = (poses) => poses.map((pose) => pose && vectorOf(product(pose.slice(3), conjugate(from.slice(3)))).map((v) => v * 180 / Math.PI));
  const [at, turned] = [places(used), turns(used)];
  const [smoothAt, smoothTurned] = row.smoothed && from ? [places(row.smoothed), turns(row.smoothed)] : [null, null];
  const half = (k) => row.half_95.map((h, i) => (h && used[i] ? h[k] : null));
  return [...AXES.map((name, k) => ({ title: `${name}`, unit: 'mm, centroid', values: at.map((p) => p && p[k]), half: half(k), smoothed: smoothAt?.map((p) => p && p[k]) })),
    ...AXES.map((name, k) => ({ title: `rotation ${name}`, unit: '°, since the first good frame', values: turned.map((v) => v && v[k]), half: half(3 + k), smoothed: smoothTurned?.map((v) => v && v[k]) }))];
}

export function kinematicsTab(host, visible) {
  const picker = el('select', { 'aria-label': 'trial', onchange: () => goToTrial(+picker.value) }, study.trials.map((t, i) => el('option', { value: i }, t.name)));
  const all = el('div');
  host.append(el('div', { class: 'bar' }, study.trials.length > 1 ? picker : null, el('span', { class: 'soft' }, 'click a plot: go to the frame · drag: zoom · double click: all · marks at the bottom: frames that are not good · upright line: the frame looked at')), all);
  let shownTrial = -1;
  const goToTrial = (trial) => { state.trial = trial; state.frame = 0; show(); };
  const click = (frame) => goTo(state.trial, frame);

  function show() {
    if (!visible() || shownTrial === state.trial) return;
    shownTrial = state.trial;
    picker.value = state.trial;
    const trial = state.trial;
    const t = study.trials[trial];
    const x = t.times.length ? t.times : t.frames.map((_, i) => i);
    const named = t.times.length ? null : t.frames;
    const groups = t.joints.map((joint) => el('div', {}, el('h2', {}, joint.name), el('div', { class: 'plots' }, joint.quantities.map((q) => seriesPlot({ title: q.label, unit: q.unit, x, values: q.values, half: q.half_width_95, smoothed: q.smoothed, stroke: '#2f7ed8', trial, named }, click)))));
    const bodies = t.bodies.map((body, place) => el('div', {}, el('h2', {}, study.bodies[body].name), el('div', { class: 'plots' }, freedoms(trial, place).map((f) => seriesPlot({ ...f, x, stroke: t.colours[place], trial, named }, click)))));
    all.replaceChildren(...groups, ...bodies, el('p', { class: 'soft' }, `Over ${t.times.length ? 'time in s' : 'frames'}. Axes are those of the laboratory. Bands hold the truth with 95 % by what residuals and, where known, the calibration say; failed poses are left out. Rotations are one rotation vector, not three successive turns.`));
  }
  onChange(show);
  return { show };
}

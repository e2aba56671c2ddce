// One frame: all views side by side with the outlines over them, how they fit along the outline, and a slider through the trial.

import { el, fixed, tick } from './dom.js';
import { outline, placed } from './geometry.js';
import { goTo, legend, pill, strips } from './overview.js';
import { Picture, chained, drawEdges, drawOutline, drawPieces } from './picture.js';
import { residualPlot, searchPlot } from './plots.js';
import { frameOf, lookAt, models, onChange, play, state, study, verdictOf } from './study.js';

const settings = { edges: false, residuals: false, hidden: new Set(), path: true };

export function frameTab(host, visible) {
  const strip = el('div');
  const picker = el('select', { 'aria-label': 'trial', onchange: () => goTo(+picker.value, 0) }, study.trials.map((t, i) => el('option', { value: i }, t.name)));
  const slider = el('input', { type: 'range', class: 'grow', min: 0, 'aria-label': 'frame', oninput: () => lookAt(state.trial, +slider.value) });
  const player = el('button', { type: 'button', title: 'space', onclick: () => play(!state.playing, ready) }, 'play');
  const label = el('b');
  const bodies = el('span', { class: 'bar', style: 'margin:0' });
  const range = (name) => el('label', {}, `${name} `, el('input', { type: 'range', class: 'narrow', min: 20, max: 300, value: 100, oninput: (e) => { Picture.look[name] = +e.target.value; redraw(); } }));
  const views = el('div', { class: 'views' });
  const note = el('div', { class: 'note', hidden: true });
  const facts = el('div', { class: 'panel' });
  const plots = el('div', { class: 'plots' });
  host.append(el('div', { class: 'bar' }, study.trials.length > 1 ? picker : null, player, button('‹', -1, 'left'), label, button('›', 1, 'right'), slider),
    el('div', { class: 'bar' }, bodies, tick('edges', settings.edges, (on) => { settings.edges = on; redraw(); }), tick('residuals', settings.residuals, (on) => { settings.residuals = on; redraw(); }),
      range('brightness'), range('contrast'), el('span', { class: 'soft' }, 'wheel: zoom · drag: move · ', el('kbd', {}, '←'), ' ', el('kbd', {}, '→'), ' frame · ', el('kbd', {}, 'space'), ' play')),
    note, views, facts, plots, el('div', { class: 'panel' }, strip, legend()));

  let pictures = [];
  let current = null;
  let highlighted = null;
  let trialShown = -1;
  let asked = 0;
  let meshes = null;

  function button(text, by, key) { return el('button', { type: 'button', title: `${key} arrow`, onclick: () => lookAt(state.trial, state.frame + by) }, text); }
  const ready = () => current?.trial === state.trial && current?.frame === state.frame;

  function trialChanged() {
    trialShown = state.trial;
    const trial = study.trials[state.trial];
    slider.max = trial.frames.length - 1;
    picker.value = state.trial;
    strip.replaceChildren(...strips(state.trial, goTo));
    settings.hidden.clear();
    bodies.replaceChildren(...trial.bodies.map((body, place) => {
      const box = tick(study.bodies[body].name, true, (on) => { settings.hidden[on ? 'delete' : 'add'](place); redraw(); });
      box.insertBefore(el('i', { class: 'c', style: `background:${trial.colours[place]}` }), box.lastChild);
      return box;
    }));
    pictures = trial.views.map(() => new Picture(el('div')));
    views.replaceChildren(...pictures.map((p) => p.host));
    views.style.setProperty('--columns', Math.min(3, pictures.length));
  }

  async function show() {
    player.textContent = state.playing ? 'pause' : 'play';
    if (!visible()) return;
    if (trialShown !== state.trial) trialChanged();
    const { trial, frame } = state;
    slider.value = frame;
    const t = study.trials[trial];
    label.textContent = `${t.frames[frame]}${t.times.length ? ` · ${t.times[frame].toFixed(3)} s` : ''}`;
    const ticket = ++asked;
    try {
      const found = await frameOf(trial, frame);
      if (study.searches.some((s) => s.trial === trial && s.frame === frame)) meshes = await models().catch(() => null);
      if (ticket !== asked) return;
      note.hidden = true;
      views.hidden = false;
      current = { trial, frame, ...found };
      highlighted = null;
      redraw();
      if (!state.playing) more();
      if (frame + 1 < t.frames.length) frameOf(trial, frame + 1).catch(() => {});
    } catch (error) {
      if (ticket !== asked) return;
      current = { trial, frame, views: [] };
      note.hidden = false;
      views.hidden = true;
      note.textContent = error.message;
      facts.replaceChildren();
      plots.replaceChildren();
    }
  }

  function redraw() {
    if (!current) return;
    const t = study.trials[current.trial];
    pictures.forEach((picture, slot) => {
      const view = current.views.find((v) => v.slot === slot);
      const name = study.views[t.views[slot]].name;
      picture.tag.replaceChildren(el('b', {}, name));
      if (!view) { picture.tag.append('\nthis picture could not be used'); return; }
      const shown = view.outlines.filter((o) => !settings.hidden.has(o.place));
      for (const { place } of shown) {
        const row = t.rows[place];
        const [rms, share] = [row.rms_px[current.frame]?.[slot], row.share[current.frame]?.[slot]];
        picture.tag.append(`\n${study.bodies[t.bodies[place]].name}: ${fixed(rms, 2)} px, ${fixed(100 * share, 0)} % found`);
      }
      picture.show(view, (pen, px) => {
        if (settings.edges) drawEdges(pen, view.edges, px);
        for (const { place, points } of shown) {
          drawOutline(pen, points, px, { colour: t.colours[place], failed: verdictOf(current.trial, place, current.frame) === 'f', residuals: settings.residuals });
        }
        if (settings.path) drawPath(pen, px, slot);
        if (highlighted && highlighted.slot === slot) {
          pen.fillStyle = '#fff';
          pen.beginPath();
          pen.arc(highlighted.point.x, highlighted.point.y, 4 * px, 0, 7);
          pen.fill();
        }
      });
    });
  }

  const searches = () => study.searches.filter((s) => s.trial === current.trial && s.frame === current.frame && !settings.hidden.has(s.place));

  /** The outline at some steps of the search, from white to the body's colour. */
  function drawPath(pen, px, slot) {
    if (!meshes) return;
    for (const { place, steps } of searches()) {
      const t = study.trials[current.trial];
      const mesh = meshes.get(t.bodies[place]);
      if (!mesh) continue;
      const some = [...new Set([0, 1, 2, 3, 4].map((k) => Math.round(k / 5 * (steps.length - 1))))];
      some.forEach((step, k) => {
        const [, { translation_mm: at, quaternion_wxyz: q }] = steps[step];
        drawPieces(pen, outline(mesh, placed([...at, ...q], mesh.centroid), study.views[t.views[slot]]), px, `rgba(255,255,255,${0.35 + 0.1 * k})`);
      });
    }
  }

  function more() {
    const t = study.trials[current.trial];
    facts.replaceChildren(el('table', {}, el('tbody', {}, t.rows.map((row, place) => {
      const half = row.half_95[current.frame];
      return el('tr', {}, el('td', { class: 't' }, el('i', { class: 'c', style: `background:${t.colours[place]}` }), study.bodies[t.bodies[place]].name), el('td', { class: 't' }, pill(row.verdicts[current.frame])),
        el('td', {}, row.fit_mm[current.frame] === null ? '' : `fit ${fixed(row.fit_mm[current.frame], 3)} mm`), el('td', {}, half ? `95 %: ± ${half.slice(0, 3).map((v) => fixed(v, 2)).join(' / ')} mm, ± ${half.slice(3).map((v) => fixed(v, 2)).join(' / ')}°` : ''),
        el('td', { class: 'reason' }, [row.reasons[current.frame], row.look[current.frame], row.edited.includes(current.frame) ? 'edited by hand' : ''].filter(Boolean).join('; ')),
        el('td', {}, el('a', { href: `#review/${encodeURIComponent(t.name)}/${encodeURIComponent(t.frames[current.frame])}/${place}` }, 'put right')));
    }))));
    plots.replaceChildren(...current.views.map((view) => residualPlot(
      `Residual along the outline, view ${study.views[t.views[view.slot]].name}`,
      view.outlines.map((o) => ({ name: study.bodies[t.bodies[o.place]].name, colour: t.colours[o.place], chain: chained(o.points) })),
      (point) => { highlighted = point && { slot: view.slot, point }; redraw(); },
    )), ...searches().map((s) => searchPlot(`Search of ${study.bodies[t.bodies[s.place]].name}`, s.steps.map(([objective]) => objective))));
  }

  onChange(show);
  return { show, ready, pictures: () => pictures, current: () => current };
}

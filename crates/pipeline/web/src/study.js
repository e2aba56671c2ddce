// The study as the page holds it, and the files beside it that are loaded when they are looked at.
//
// A page opened from disk may load scripts but fetch no data, so a frame is a script that calls `biplaneFrame` with one object, and the
// bodies are one that calls `biplaneModels`. In a page that is one file the same scripts lie in it as text.

import { bytes, edgesOf, meshOf, outlineOf } from './decode.js';

export const study = JSON.parse(document.getElementById('data').textContent);
study.views.forEach((view) => { view.inverse = inverse3(view.matrix); });

export const VERDICTS = { g: 'good', d: 'doubtful', a: 'ambiguous', f: 'failed' };

/** Inverse of a 3 x 3 matrix of rows. */
export function inverse3(m) {
  const [[a, b, c], [d, e, f], [g, h, i]] = m;
  const det = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
  return [[e * i - f * h, c * h - b * i, b * f - c * e], [f * g - d * i, a * i - c * g, c * d - a * f], [d * h - e * g, b * g - a * h, a * e - b * d]]
    .map((row) => row.map((v) => v / det));
}

const inert = new Map([...document.querySelectorAll('script[data-src]')].map((s) => [s.dataset.src, s]));
/** Whether the page is one file, with some frames alone. */
export const alone = inert.size > 0;

const calls = new Map();
for (const name of ['biplaneFrame', 'biplaneModels']) {
  window[name] = (value) => calls.get(document.currentScript)?.(value);
}

/** The object that a script beside the page hands over. */
function load(address) {
  const inside = inert.get(address);
  if (inside) {
    const text = inside.textContent;
    return Promise.resolve(JSON.parse(text.slice(text.indexOf('(') + 1, text.lastIndexOf(')'))));
  }
  if (alone) return Promise.reject(new Error('This frame is not in this file: it holds some frames alone.'));
  return new Promise((resolve, reject) => {
    const script = document.createElement('script');
    const end = () => { calls.delete(script); script.remove(); };
    calls.set(script, (value) => { end(); resolve(value); });
    script.onerror = () => { end(); reject(new Error(`${address} cannot be read: is the folder report/ beside the page?`)); };
    script.onload = () => { if (calls.has(script)) { end(); reject(new Error(`${address} is not as the page expects it; run again`)); } };
    script.src = address;
    document.head.append(script);
  });
}

const KEPT = 48;
const frames = new Map();

/** A frame with its pictures decoded; the latest ones are kept. */
export function frameOf(trial, number) {
  const address = study.trials[trial].scripts[number];
  if (!address) return Promise.reject(new Error('None of the pictures of this frame could be used; the overview says why.'));
  let frame = frames.get(address);
  if (frame) frames.delete(address);
  else frame = load(address).then(decoded);
  frames.set(address, frame);
  frame.catch(() => frames.delete(address));
  while (frames.size > KEPT) frames.delete(frames.keys().next().value);
  return frame;
}

/** Whether a frame can be shown at all. */
export function shown(trial, number) {
  const address = study.trials[trial].scripts[number];
  return !!address && (!alone || inert.has(address));
}

async function decoded(page) {
  const views = await Promise.all(page.views.map(async (view) => {
    const image = await new Promise((resolve, reject) => {
      const picture = new Image();
      picture.onload = () => resolve(picture);
      picture.onerror = () => reject(new Error('A picture of this frame is damaged; run again.'));
      picture.src = view.picture;
    });
    return { slot: view.slot, size: view.size, image, edges: edgesOf(view.edges), outlines: view.outlines.map(outlineOf) };
  }));
  return { views };
}

let bodies = null;
/** The bodies' meshes by their number in the study. */
export function models() {
  bodies ??= load('report/models.js').then((list) => new Map(list.map((m) => [m.body, meshOf(m, study.bodies[m.body].centroid)])));
  return bodies;
}

export { bytes };

// What is looked at: one for all parts of the page.
const listeners = new Set();
export const state = { trial: 0, frame: 0, playing: false };

/** Calls `listener` whenever what is looked at changes. */
export function onChange(listener) { listeners.add(listener); }

/** Looks at a frame of a trial. */
export function lookAt(trial, frame) {
  const count = study.trials[trial].frames.length;
  const to = Math.max(0, Math.min(count - 1, frame));
  if (state.trial === trial && state.frame === to) return;
  Object.assign(state, { trial, frame: to });
  listeners.forEach((listener) => listener());
}

let timer = 0;
/** Plays the trial, or stops. */
export function play(on, ready = () => true) {
  state.playing = on;
  clearInterval(timer);
  const trial = study.trials[state.trial];
  const step = trial.times.length > 1 ? (trial.times.at(-1) - trial.times[0]) / (trial.times.length - 1) * 1000 : 120;
  if (on) {
    timer = setInterval(() => {
      if (ready()) lookAt(state.trial, (state.frame + 1) % study.trials[state.trial].frames.length);
    }, Math.max(33, Math.min(400, step)));
  }
  listeners.forEach((listener) => listener());
}

/** The verdict of a body in a frame, as a letter. */
export const verdictOf = (trial, place, frame) => study.trials[trial].rows[place].verdicts[frame];
/** The worst verdict of a frame. */
export function worstOf(trial, frame) {
  const all = study.trials[trial].rows.map((row) => 'gdaf'.indexOf(row.verdicts[frame]));
  return 'gdaf'[Math.max(0, ...all)];
}

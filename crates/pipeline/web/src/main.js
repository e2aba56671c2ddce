// The page: its parts, which one is shown, and the keys that go through the trial.

import { el } from './dom.js';
import { frameTab } from './frame.js';
import { kinematicsTab } from './kinematics.js';
import { overview } from './overview.js';
import { reviewTab } from './review.js';
import { selfTest } from './selftest.js';
import { spaceTab } from './space.js';
import { lookAt, play, state, study } from './study.js';

const NAMES = { overview: 'Overview', frame: 'Frames', kinematics: 'Kinematics', space: '3D', review: 'Review', calibration: 'Calibration', slices: 'Slices', models: 'Models', methods: 'Methods' };
const sections = [...document.querySelectorAll('section.tab')];
const nav = document.querySelector('nav');
nav.append(...sections.map((s) => el('a', { href: `#${s.id}` }, NAMES[s.id])));

let open = 'overview';
const visible = (id) => () => open === id;
const section = (id) => document.getElementById(id);
overview();
const tabs = {
  frame: frameTab(section('frame'), visible('frame')),
  kinematics: kinematicsTab(section('kinematics'), visible('kinematics')),
  space: spaceTab(section('space'), visible('space')),
  review: reviewTab(section('review'), visible('review')),
};

/** Shows the part, and the frame, that the address names. */
function follow() {
  const [id, trial, frame] = location.hash.slice(1).split('/').map(decodeURIComponent);
  if (id === 'selftest') return;
  const before = open;
  open = NAMES[id] && section(id) ? id : 'overview';
  for (const s of sections) s.hidden = s.id !== open;
  for (const link of nav.children) link.toggleAttribute('aria-current', link.hash === `#${open}`);
  if (open === 'frame') {
    const t = study.trials.findIndex((one) => one.name === trial);
    const number = t < 0 ? -1 : study.trials[t].frames.indexOf(frame);
    if (number >= 0) lookAt(t, number);
  }
  if (before !== open) {
    play(false);
    scrollTo(0, 0);
  }
  tabs[open]?.show();
}
addEventListener('hashchange', follow);

document.addEventListener('keydown', (event) => {
  const typing = /^(TEXTAREA|SELECT)$/.test(event.target.tagName) || (event.target.tagName === 'INPUT' && event.target.type !== 'range');
  if (typing || event.ctrlKey || event.metaKey || event.altKey || !['frame', 'space', 'kinematics'].includes(open)) return;
  const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
  if (by) lookAt(state.trial, state.frame + by);
  else if (event.key === ' ' && event.target.tagName !== 'BUTTON') play(!state.playing, () => (open === 'space' ? tabs.space.drawn() === state.frame : tabs.frame.ready()));
  else return;
  event.preventDefault();
});

document.getElementById('copy-methods').addEventListener('click', async (event) => {
  const text = document.getElementById('methods-text');
  try { await navigator.clipboard.writeText(text.textContent); } catch {
    getSelection().selectAllChildren(text);
    document.execCommand('copy');
  }
  event.target.textContent = 'Copied';
});

follow();
if (location.hash === '#selftest') selfTest(tabs, (hash) => { location.hash = hash; follow(); });

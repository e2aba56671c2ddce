// The page tries itself: `report.html#selftest` opens every part, plays, clicks, moves a body, and writes what came of it into the page, where a test
// in a browser without a screen reads it.

import { el } from './dom.js';
import { poseOf } from './geometry.js';
import { state, study } from './study.js';

const wait = (ms) => new Promise((resolve) => { setTimeout(resolve, ms); });

async function until(what, test) {
  for (let i = 0; i < 400; i++) {
    if (await test()) return;
    await wait(25);
  }
  throw new Error(`${what}: waited in vain`);
}

function check(what, holds, told = '') { if (!holds) throw new Error(`${what}${told === '' ? '' : `: ${told}`}`); }

/** How many pixels of a canvas are coloured, and how many are neither black nor empty. */
function ink(canvas) {
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let [coloured, lit] = [0, 0];
  for (let i = 0; i < data.length; i += 4) {
    const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
    if (Math.max(r, g, b) - Math.min(r, g, b) > 60) coloured++;
    if (r + g + b > 60) lit++;
  }
  return { coloured, lit };
}

const pointer = (target, type, x, y, more = {}) => target.dispatchEvent(new PointerEvent(type, { bubbles: true, pointerId: 7, clientX: x, clientY: y, ...more }));

/** Runs all of it; `go` opens a part of the page. */
export async function selfTest(tabs, go) {
  const lines = [];
  const parts = {
    async 'the overview has a strip a body and a row a pose'() {
      go('overview');
      const bodies = study.trials.reduce((n, t) => n + t.bodies.length, 0);
      await until('strips', () => [...document.querySelectorAll('#strips canvas')].every((c) => c.width > 50 && ink(c).coloured > 20));
      check('strips', document.querySelectorAll('#strips canvas').length === bodies);
      check('rows', document.querySelectorAll('#table tbody tr').length === Math.min(200, study.trials.reduce((n, t) => n + t.bodies.length * t.frames.length, 0)));
    },
    async 'a click on a strip shows that frame'() {
      const t = study.trials[0];
      const wanted = Math.floor(t.frames.length / 2);
      const canvas = document.querySelector('#strips canvas');
      const box = canvas.getBoundingClientRect();
      canvas.dispatchEvent(new MouseEvent('click', { bubbles: true, clientX: box.left + (wanted + 0.5) / t.frames.length * box.width, clientY: box.top + 5 }));
      // Where a frame is less than a pixel wide, as near as a pixel.
      const near = Math.ceil(t.frames.length / box.width);
      await until('the address', () => location.hash.startsWith(`#frame/${t.name}/`) && Math.abs(state.frame - wanted) <= (near > 1 ? near : 0));
      await until('the frame', () => tabs.frame.ready() && tabs.frame.current().views.length);
      check('frame', location.hash === `#frame/${t.name}/${t.frames[state.frame]}` && document.querySelector('#frame b').textContent.startsWith(t.frames[state.frame]));
      const drawn = tabs.frame.pictures().map((p) => ink(p.canvas));
      check('pictures with outlines', drawn.length === t.views.length && drawn.every((d) => d.coloured > 100 && d.lit > 5000), JSON.stringify(drawn));
      await until('plots', () => document.querySelectorAll('#frame .plot canvas').length === t.views.length);
    },
    async 'keys go through the trial and play plays it'() {
      const count = study.trials[0].frames.length;
      const before = state.frame;
      document.dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowLeft', bubbles: true }));
      check('left', state.frame === Math.max(0, before - 1));
      if (count < 2) return;
      const start = state.frame;
      document.querySelector('#frame button').click();
      check('playing', state.playing);
      await until('the next frame', () => state.frame !== start);
      document.querySelector('#frame button').click();
      check('stopped', !state.playing);
    },
    async 'zoom and residuals change the picture'() {
      await until('the frame', () => tabs.frame.ready());
      const [picture] = tabs.frame.pictures();
      const before = picture.scale;
      picture.canvas.dispatchEvent(new WheelEvent('wheel', { deltaY: -400, bubbles: true, cancelable: true }));
      check('zoomed', picture.scale > 1.5 * before);
      picture.fit();
      check('whole again', Math.abs(picture.scale - before) < 1e-9);
      const whole = picture.canvas.toDataURL();
      [...document.querySelectorAll('#frame label')].find((l) => l.textContent === 'residuals').querySelector('input').click();
      check('residuals are drawn', picture.canvas.toDataURL() !== whole);
    },
    async 'kinematics has six plots a body'() {
      go('kinematics');
      const t = study.trials[state.trial];
      const wanted = 6 * t.bodies.length + t.joints.reduce((n, j) => n + j.quantities.length, 0);
      await until('plots', () => document.querySelectorAll('#kinematics .plot canvas').length === wanted);
      await until('ink', () => [...document.querySelectorAll('#kinematics .plot canvas')].some((c) => ink(c).coloured > 50));
    },
    async 'the bodies stand in space'() {
      go('space');
      await until('3D', () => tabs.space.drawn() === state.frame || document.querySelector('#scene .note'));
      check('3D', !document.querySelector('#scene .note'), document.querySelector('#scene .note')?.textContent);
      const { renderer } = tabs.space.world();
      const copy = el('canvas', { width: renderer.domElement.width, height: renderer.domElement.height });
      copy.getContext('2d').drawImage(renderer.domElement, 0, 0);
      const drawn = ink(copy);
      check('bodies in colour, pictures in grey', drawn.coloured > 200 && drawn.lit > 2000, JSON.stringify(drawn));
    },
    async 'in the review a body is dragged, turned, put back and taken'() {
      go('review');
      const { review } = tabs;
      await until('a pose', () => review.current() && review.pictures().length);
      await until('the picture', () => review.pictures().every((p) => p.scale));
      const { item, found, mesh, name, views } = review.current();
      const fits = () => views.map((v) => v.how.rms);
      const before = fits();
      check('residuals', before.every((v) => v < 16), before.join());
      const [picture] = review.pictures();
      const box = picture.canvas.getBoundingClientRect();
      const at = [box.left + box.width / 2, box.top + box.height / 2];
      const drag = (dx, dy, more) => {
        pointer(picture.canvas, 'pointerdown', ...at, more);
        pointer(picture.canvas, 'pointermove', at[0] + dx, at[1] + dy, more);
        pointer(picture.canvas, 'pointerup', at[0] + dx, at[1] + dy, more);
      };
      drag(14, 9);
      const shifted = review.current().pose;
      check('moved', Math.hypot(...shifted.at.map((v, i) => v - found.at[i])) > 0.3 && String(shifted.q) === String(found.q));
      check('the residual is live', String(fits()) !== String(before), fits().join());
      drag(20, 0, { ctrlKey: true });
      check('turned', String(review.current().pose.q) !== String(found.q) && String(review.current().pose.at) === String(shifted.at));
      drag(0, 30, { shiftKey: true });
      review.step(-1); review.step(-1); review.step(-1);
      check('undone', review.current().pose === found);
      review.step(1);
      const pose = poseOf(review.current().pose, mesh.centroid);
      review.take();
      const t = study.trials[item.trial];
      const rows = review.table.text().trim().split('\n');
      const row = rows.find((line) => line.startsWith(`${t.name},${t.frames[item.frame]},${name},`));
      check('a row', rows[0] === 'trial,frame,body,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz' && row);
      const numbers = row.split(',').slice(3).map(Number);
      check('its pose', numbers.length === 7 && numbers.every((v, i) => Math.abs(v - pose[i]) < 1e-4) && Math.abs(Math.hypot(...numbers.slice(3)) - 1) < 1e-6, row);
      lines.push(`row ${row}`);
    },
  };
  const start = performance.now();
  let failed = 0;
  for (const [name, part] of Object.entries(parts)) {
    try { await part(); lines.push(`ok ${name}`); } catch (error) { failed++; lines.push(`FAILED ${name}: ${error.message}`); }
  }
  lines.push(failed ? `selftest failed: ${failed}` : 'selftest passed', `ms ${Math.round(performance.now() - start)}`);
  document.body.prepend(el('pre', { id: 'selftest-result' }, lines.join('\n')));
}

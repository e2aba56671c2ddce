// Plots: series with bands of 95 %, residuals along outlines, the objective of a search. Drawn by uPlot.

import uPlot from 'uplot';
import css from 'uplot/dist/uPlot.min.css';

import { colour, el } from './dom.js';
import { VERDICTS, onChange, state, study, worstOf } from './study.js';

document.head.append(el('style', {}, css));
document.head.append(el('style', {}, '.uplot,.u-legend{font:12px system-ui;color:inherit} .u-legend{text-align:left} .u-legend .u-marker{width:10px;height:3px}'));

const HEIGHT = 170;

function axes(unit) {
  const common = { stroke: colour('soft'), grid: { stroke: colour('line'), width: 1 }, ticks: { stroke: colour('line'), width: 1 }, font: '11px system-ui' };
  return [{ ...common, size: 26 }, { ...common, size: 52, values: (_, list) => list.map((v) => `${+v.toPrecision(6)}`), label: unit, labelSize: 16, labelFont: '11px system-ui' }];
}

/** A plot as wide as the place it is put into. */
function framed(title, unit, options, data) {
  const host = el('div', { class: 'plot' }, el('h3', {}, title, ' ', el('small', {}, unit)));
  let plot = null;
  new ResizeObserver(() => {
    const width = host.clientWidth - 20;
    if (width < 50) return;
    if (plot) plot.setSize({ width, height: HEIGHT });
    else plot = new uPlot({ width, height: HEIGHT, axes: axes(''), ...options }, data, host);
  }).observe(host);
  host.plot = () => plot;
  return host;
}

/**
 * A quantity over a trial with its band, and its smoothed course where there is one. A click goes to the frame. `named` are the labels of the
 * frames where `x` is their number.
 * @param {{title: string, unit: string, x: number[], values: (number|null)[], half: (number|null)[], smoothed?: (number|null)[], stroke: string, trial: number, named?: string[]}} what
 */
export function seriesPlot({ title, unit, x, values, half, smoothed, stroke, trial, named }, click) {
  const edge = (sign) => values.map((v, i) => (v === null || half[i] === null || half[i] === undefined ? null : v + sign * half[i]));
  const line = { label: 'found', stroke, width: 1.5, points: { show: values.length <= 60, size: 4, fill: stroke } };
  const none = { stroke: 'transparent', points: { show: false } };
  const series = [{ label: '' }, line, { label: '95 % to', ...none }, { label: 'from', ...none }];
  const data = [x, values, edge(1), edge(-1)];
  if (smoothed) {
    series.push({ label: 'smoothed', stroke: colour('ink'), width: 1, dash: [5, 4], points: { show: false } });
    data.push(smoothed);
  }
  let drawn = null;
  const host = framed(title, unit, {
    scales: { x: { time: false } },
    axes: named ? axes('').map((axis, k) => (k ? axis : { ...axis, values: (_, list) => list.map((v) => named[v] ?? '') })) : axes(''),
    series,
    bands: [{ series: [2, 3], fill: tinted(stroke) }],
    legend: { show: !!smoothed },
    cursor: { sync: { key: `trial${trial}` }, drag: { x: true, y: false } },
    hooks: {
      draw: [(u) => {
        const pen = u.ctx;
        const { left, top, width, height } = u.bbox;
        const ratio = window.devicePixelRatio || 1;
        // Frames whose verdict is not good, by colour and height as in the strips.
        x.forEach((at, frame) => {
          const letter = worstOf(trial, frame);
          if (letter === 'g') return;
          pen.fillStyle = colour(`${VERDICTS[letter]}-mark`);
          const tall = { d: 4, a: 6, f: 9 }[letter] * ratio;
          pen.fillRect(u.valToPos(at, 'x', true) - ratio, top + height - tall, 2 * ratio, tall);
        });
        if (state.trial === trial) {
          const here = u.valToPos(x[state.frame], 'x', true);
          if (here >= left && here <= left + width) {
            pen.fillStyle = colour('ink');
            pen.fillRect(here - ratio / 2, top, ratio, height);
          }
        }
      }],
      ready: [(u) => {
        drawn = u;
        let down = 0;
        u.over.addEventListener('mousedown', (event) => { down = event.clientX; });
        u.over.addEventListener('mouseup', (event) => { if (Math.abs(event.clientX - down) < 3 && u.cursor.idx !== null) click(u.cursor.idx); });
      }],
    },
  }, data);
  let before = -1;
  onChange(() => { if (drawn && host.isConnected && host.offsetParent && before !== state.frame) { before = state.frame; drawn.redraw(false, false); } });
  return host;
}

/** A colour with little of its strength. */
function tinted(stroke) {
  const pen = document.createElement('canvas').getContext('2d');
  pen.fillStyle = stroke;
  const [r, g, b] = [1, 3, 5].map((k) => parseInt(pen.fillStyle.slice(k, k + 2), 16));
  return `rgba(${r},${g},${b},.28)`;
}

/** Residuals of outlines along them; `point` is told which one is pointed at. */
export function residualPlot(title, outlines, point) {
  const xs = [...new Set(outlines.flatMap((o) => o.chain.map((c) => c.s)))].sort((a, b) => a - b);
  const at = new Map(xs.map((x, i) => [x, i]));
  const maps = outlines.map(() => new Array(xs.length).fill(undefined));
  const values = outlines.map((o, k) => {
    const column = new Array(xs.length).fill(undefined);
    for (const { s, point: p } of o.chain) {
      column[at.get(s)] = p && !Number.isNaN(p.residual) ? p.residual : null;
      maps[k][at.get(s)] = p;
    }
    return column;
  });
  return framed(title, 'px, outside positive', {
    scales: { x: { time: false }, y: { range: (_, low, high) => { const most = Math.max(1, Math.abs(low ?? 0), Math.abs(high ?? 0)); return [-most, most]; } } },
    series: [{ label: 'px along' }, ...outlines.map((o) => ({ label: o.name, stroke: o.colour, width: 1.2, points: { show: false } }))],
    legend: { show: outlines.length > 1 },
    hooks: { setCursor: [(u) => {
      const i = u.cursor.idx;
      const hit = i === null || i === undefined ? null : maps.map((m) => m[i]).find(Boolean);
      point(hit ?? null);
    }] },
  }, [xs, ...values]);
}

/** The objective over the steps of a search. */
export function searchPlot(title, objectives) {
  return framed(title, 'objective', { scales: { x: { time: false } }, series: [{ label: 'step' }, { label: 'objective', stroke: colour('focus'), width: 1.5 }] }, [objectives.map((_, i) => i), objectives]);
}

/** A small plot: lines or points over two axes. */

import {short} from '../words.js';
import {element, svgElement} from './element.js';
import {partAt, scaleOf, thinned, ticksOf, valueAt} from './plot_scale.js';

/**
 * @typedef {object} PlotOptions
 * @property {string} label    what the plot shows, for those who do not see it
 * @property {string} xLabel
 * @property {string} yLabel
 * @property {boolean} [logX]
 * @property {boolean} [logY]
 * @property {boolean} [lines] a line through each series; else its points alone
 * @property {(x: number) => void} [onPick]  a place along x was clicked
 */
/**
 * @typedef {object} Series
 * @property {string} name
 * @property {string} colour
 * @property {[number, number][]} points
 * @property {string[]} [words]    of each point, where the pointer rests
 * @property {boolean} [ticks]     drawn as short strokes on the axis below
 * @property {number} [current]    the place of the point that is marked
 */

const [width, height] = [340, 190];
const [left, right, top, bottom] = [52, 10, 10, 34];
const [across, down] = [width - left - right, height - top - bottom];

/**
 * @param {PlotOptions} options
 * @returns {{element: HTMLElement, set: (series: Series[]) => void, mark: (x: number) => void}}
 */
export function plot(options) {
  const drawing = svgElement('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': options.label});
  const cursor = svgElement('line', {class: 'cursor', y1: top, y2: top + down, visibility: 'hidden'});
  const legend = element('p', {class: 'legend'});
  let scaleX = scaleOf([], Boolean(options.logX));
  const {onPick} = options;
  if (onPick) {
    drawing.classList.add('picked');
    drawing.addEventListener('pointerdown', (event) => {
      const box = drawing.getBoundingClientRect();
      const part = (((event.clientX - box.left) / box.width) * width - left) / across;
      onPick(valueAt(scaleX, Math.min(1, Math.max(0, part))));
    });
  }

  /** @param {Series[]} series */
  const set = (series) => {
    const points = series.filter((each) => !each.ticks).flatMap((each) => each.points);
    scaleX = scaleOf(
      series.flatMap((each) => each.points.map(([x]) => x)),
      Boolean(options.logX),
    );
    const scaleY = scaleOf(
      points.map(([, y]) => y),
      Boolean(options.logY),
    );
    const x = (/** @type {number} */ value) => left + across * partAt(scaleX, value);
    const y = (/** @type {number} */ value) => top + down * (1 - partAt(scaleY, value));
    drawing.replaceChildren(
      ...axes(scaleX, scaleY, x, y, options),
      ...series.flatMap((each) => drawn(each, x, y, Boolean(options.lines))),
      cursor,
    );
    legend.replaceChildren(...(series.length < 2 ? [] : series.map(legendEntry)));
  };
  set([]);
  return {
    element: element('figure', {class: 'plot'}, /** @type {any} */ (drawing), legend),
    set,
    mark: (value) => {
      const at = left + across * partAt(scaleX, value);
      cursor.setAttribute('visibility', 'visible');
      cursor.setAttribute('x1', String(at));
      cursor.setAttribute('x2', String(at));
    },
  };
}

/**
 * @param {import('./plot_scale.js').Scale} scaleX
 * @param {import('./plot_scale.js').Scale} scaleY
 * @param {(value: number) => number} x
 * @param {(value: number) => number} y
 * @param {PlotOptions} options
 */
function axes(scaleX, scaleY, x, y, {xLabel, yLabel}) {
  return [
    ...ticksOf(scaleY, 4).flatMap((value) => [
      svgElement('line', {class: 'grid', x1: left, x2: left + across, y1: y(value), y2: y(value)}),
      svgElement('text', {x: left - 4, y: y(value) + 3, 'text-anchor': 'end'}, short(value)),
    ]),
    ...ticksOf(scaleX, 5).flatMap((value) => [
      svgElement('line', {class: 'axis', x1: x(value), x2: x(value), y1: top + down, y2: top + down + 3}),
      svgElement('text', {x: x(value), y: top + down + 13, 'text-anchor': 'middle'}, short(value)),
    ]),
    svgElement('path', {class: 'axis', d: `M${left} ${top}v${down}h${across}`}),
    svgElement('text', {x: left + across / 2, y: height - 5, 'text-anchor': 'middle'}, xLabel),
    svgElement('text', {x: 10, y: top + down / 2, 'text-anchor': 'middle', transform: `rotate(-90 10 ${top + down / 2})`}, yLabel),
  ];
}

/**
 * @param {Series} series
 * @param {(value: number) => number} x
 * @param {(value: number) => number} y
 * @param {boolean} lines
 * @returns {SVGElement[]}
 */
function drawn({points, colour, words, ticks, current}, x, y, lines) {
  if (ticks) {
    const strokes = thinned(points, 200)
      .map(([at]) => `M${x(at).toFixed(1)} ${top + down}v-7`)
      .join('');
    return [svgElement('path', {class: 'late', d: strokes, stroke: colour})];
  }
  if (lines) {
    const shown = thinned(
      points.filter(([, value]) => Number.isFinite(value)),
      across,
    );
    const path = shown.map(([at, value], i) => `${i ? 'L' : 'M'}${x(at).toFixed(1)} ${y(value).toFixed(1)}`).join('');
    return [svgElement('path', {class: 'line', d: path, stroke: colour})];
  }
  return points.flatMap(([at, value], i) => {
    const [cx, cy] = [x(at), y(value)];
    // What has no place, as 0 on a logarithmic axis, is not drawn.
    if (!Number.isFinite(cx) || !Number.isFinite(cy)) return [];
    return [
      svgElement(
        'circle',
        {class: i === current ? 'point current' : 'point', cx, cy, r: i === current ? 6 : 4, fill: colour},
        svgElement('title', {}, words?.[i] ?? `${short(at)}, ${short(value)}`),
      ),
    ];
  });
}

/** @param {Series} series */
function legendEntry({name, colour}) {
  const swatch = element('span', {class: 'swatch'});
  swatch.style.background = colour;
  return element('span', {}, swatch, name);
}

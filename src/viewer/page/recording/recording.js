/** A recording of `ist run`, read from its JSON lines (docs/recording-format.md). */

import {identity} from '../pose.js';
import {pointsOf} from './points.js';

/** @typedef {import('../protocol.js').Pose} Pose */
/** @typedef {import('../protocol.js').Line} Line */
/** @typedef {import('./points.js').Point} Point */

/**
 * @typedef {object} Recording
 * @property {Line} header
 * @property {number} dt          s
 * @property {Tick[]} ticks
 * @property {Change[]} changes
 * @property {boolean} byPoints  the scene has contact: contact points and no leaf pairs
 * @property {number} strongest   N, the largest force of a contact point
 * @property {string | null} cutOff  a sentence if the last line is cut off
 */
/**
 * @typedef {object} Tick
 * @property {number} tick
 * @property {number} time        s, from the recording's first tick on
 * @property {Pose | null} device metres
 * @property {Pose} tool          metres
 * @property {number[]} wrench    N, N m
 * @property {number} force       N
 * @property {number} torque      N m
 * @property {number | null} contacts  leaf pairs
 * @property {boolean} late       ticks before it are missing, or it ended after its period
 * @property {Point[]} points     the contacts that push the tool
 * @property {number} steps       of the tool; 0 with springs
 * @property {boolean} held       the tool stayed at its last free pose
 * @property {boolean} halved     a step was shortened
 * @property {boolean} fault
 * @property {number} microseconds
 */
/** @typedef {{before: number, body: string, kind: 'attach' | 'release', status: string}} Change  `before`: index of the tick that it precedes */

const version = 3;
// A step takes less than a frame does.
const linesAStep = 32;

/**
 * @param {string} text
 * @returns {Recording} throws an Error whose text is for people
 */
export function parseRecording(text) {
  const steps = recordingSteps(text);
  for (;;) {
    const {done, value} = steps.next();
    if (done) return value;
  }
}

/**
 * Reads a recording by steps of some lines, so that a page can draw between them.
 * @param {string} text
 * @returns {Generator<number, Recording, void>} yields the part that is read; throws an Error whose
 *   text is for people
 */
export function* recordingSteps(text) {
  const lines = linesOf(text);
  const first = lines.next().value;
  if (!first) throw new Error('The recording is empty: run ist run SCENE --record run.jsonl again.');
  const header = headerOf(first.line, first.number);
  /** @type {Tick[]} */
  const ticks = [];
  /** @type {Change[]} */
  const changes = [];
  let cutOff = null;
  for (const {line: written, number, end} of lines) {
    let line;
    try {
      line = parsed(written, number);
    } catch (error) {
      if (text.slice(end).trim() !== '') throw error;
      cutOff = `The recording is cut off in line ${number}: it is shown up to the tick before.`;
      break;
    }
    const change = changeOf(line, ticks.length);
    if (change) changes.push(change);
    else ticks.push(tickOf(line, number, ticks));
    if (number % linesAStep === 0) yield end / text.length;
  }
  if (ticks.length === 0) throw new Error('The recording has a header, but no ticks: run the scene for longer.');
  const strongest = ticks.reduce((most, {points}) => points.reduce((largest, {force}) => Math.max(largest, Math.hypot(...force)), most), 0);
  const byPoints = ticks.some(({steps}) => steps > 0);
  return {header, dt: header.dt, ticks, changes, byPoints, strongest, cutOff};
}

/**
 * @param {string} text
 * @returns {Generator<{line: string, number: number, end: number}, undefined, void>} those that are not blank
 */
function* linesOf(text) {
  let number = 0;
  for (let begin = 0; begin < text.length;) {
    const found = text.indexOf('\n', begin),
      end = found < 0 ? text.length : found + 1;
    const line = text.slice(begin, end);
    number += 1;
    if (line.trim() !== '') yield {line, number, end};
    begin = end;
  }
}

/**
 * @param {string} line
 * @param {number} number
 * @returns {Line}
 */
function headerOf(line, number) {
  if (!line.trimStart().startsWith('{')) {
    throw new Error(
      /^tick,/.test(line)
        ? 'This recording is CSV, which does not say of what it is: record JSON lines, ist run SCENE --record run.jsonl.'
        : 'This is no recording of ist run: its first line is no JSON. Record one by ist run SCENE --record run.jsonl.',
    );
  }
  const header = parsed(line, number);
  if (header.recording === undefined) {
    throw new Error(
      'tick' in header
        ? 'This recording is of version 1, which has no header: record the scene again with this version of ist.'
        : 'This is no recording of ist run: its first line has no recording version. Record one by ist run SCENE --record run.jsonl.',
    );
  }
  if (header.recording !== version) {
    throw new Error(
      `This recording is of version ${header.recording}, and the page reads version ${version}: ` +
        (header.recording > version
          ? 'open it in a page of the version of ist that wrote it.'
          : 'record the scene again with this version of ist.'),
    );
  }
  const named =
    Array.isArray(header.bodies) &&
    header.bodies.every((/** @type {unknown} */ body) => typeof (/** @type {any} */ (body)?.name) === 'string');
  if (!(header.dt > 0) || !(header.unit > 0) || !named) {
    throw new Error(
      'The header of this recording is damaged: it needs dt and unit (numbers above 0) and bodies with names. Record the scene again.',
    );
  }
  return header;
}

/**
 * @param {number[]} row  a position, and a rotation column by column
 * @returns {Pose}
 */
export function poseOfRow([x, y, z, ...turn]) {
  return [turn[0], turn[1], turn[2], 0, turn[3], turn[4], turn[5], 0, turn[6], turn[7], turn[8], 0, x, y, z, 1];
}

/**
 * @param {string} line
 * @param {number} number
 * @returns {Line}
 */
function parsed(line, number) {
  try {
    const value = JSON.parse(line);
    if (value !== null && typeof value === 'object') return value;
  } catch {
    // The error below names JSON that is no object, too.
  }
  throw new Error(`Line ${number} of the recording is damaged: record the scene again, or take the line out.`);
}

/**
 * @param {Line} line
 * @param {number} before
 * @returns {Change | null}
 */
function changeOf(line, before) {
  if ('attach' in line) return {before, body: line.attach, kind: 'attach', status: line.status};
  if ('release' in line) return {before, body: line.release, kind: 'release', status: line.status};
  return null;
}

/**
 * @param {Line} line
 * @param {number} number
 * @param {Tick[]} before
 * @returns {Tick}
 */
function tickOf(line, number, before) {
  const previous = before[before.length - 1];
  const row = (/** @type {unknown} */ value) => Array.isArray(value) && value.length === 12 && value.every(Number.isFinite);
  const points = pointsOf(line.points);
  if (
    !points ||
    !Number.isInteger(line.tick) ||
    !(line.dt > 0) ||
    !Array.isArray(line.wrench) ||
    line.wrench.length !== 6 ||
    (line.tool !== null && !row(line.tool)) ||
    (line.device !== null && !row(line.device))
  ) {
    throw new Error(
      `Line ${number} of the recording is no tick: it needs tick, dt, tool, device (12 numbers each, or null), wrench (6 numbers) and points. Record the scene again.`,
    );
  }
  const wrench = line.wrench.map((/** @type {unknown} */ value) => (typeof value === 'number' ? value : 0));
  if (previous !== undefined && line.tick <= previous.tick) {
    throw new Error(
      `Line ${number} of the recording is damaged: tick ${line.tick} comes after tick ${previous.tick}. Record the scene again.`,
    );
  }
  const first = before.length ? before[0].tick : line.tick;
  return {
    tick: line.tick,
    time: (line.tick - first) * line.dt,
    device: line.device && poseOfRow(line.device),
    tool: line.tool ? poseOfRow(line.tool) : (previous?.tool ?? [...identity]),
    wrench,
    force: Math.hypot(wrench[0], wrench[1], wrench[2]),
    torque: Math.hypot(wrench[3], wrench[4], wrench[5]),
    contacts: line.contacts ?? null,
    late:
      (previous !== undefined && line.tick > previous.tick + 1) || (line.late_microseconds ?? 0) + (line.microseconds ?? 0) > line.dt * 1e6,
    points,
    steps: line.steps ?? 0,
    held: line.held === true,
    halved: line.halved === true,
    fault: line.fault === true,
    microseconds: line.microseconds ?? NaN,
  };
}

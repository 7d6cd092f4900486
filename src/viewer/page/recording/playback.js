/** The clock of a recording: it plays, pauses and jumps. */

/**
 * @typedef {object} Playback
 * @property {(at: number) => void} jump   to a tick's index
 * @property {() => void} toggle
 * @property {() => void} pause
 * @property {(factor: number) => void} setSpeed
 * @property {() => boolean} playing
 * @property {() => number} at
 */

/**
 * @param {import('./recording.js').Tick[]} ticks
 * @param {(at: number, playing: boolean) => void} onTick  with each frame while it plays, and where it stops
 * @returns {Playback}
 */
export function makePlayback(ticks, onTick) {
  let at = 0,
    speed = 1,
    playing = false;
  let begun = 0,
    from = 0;
  const last = ticks.length - 1;
  const restart = () => {
    begun = performance.now();
    from = ticks[at].time;
  };
  const turn = () => {
    if (!playing) return;
    at = indexAt(ticks, from + ((performance.now() - begun) / 1000) * speed);
    if (at >= last) playing = false;
    onTick(at, playing);
    if (playing) requestAnimationFrame(turn);
  };
  return {
    jump(to) {
      at = Math.min(last, Math.max(0, Math.round(to)));
      restart();
      onTick(at, playing);
    },
    toggle() {
      playing = !playing;
      if (playing && at >= last) at = 0;
      restart();
      if (playing) requestAnimationFrame(turn);
      onTick(at, playing);
    },
    pause() {
      if (!playing) return;
      playing = false;
      onTick(at, false);
    },
    setSpeed(factor) {
      speed = factor;
      restart();
    },
    playing: () => playing,
    at: () => at,
  };
}

/**
 * @param {import('./recording.js').Tick[]} ticks
 * @param {number} time
 * @returns {number} index of the last tick that began by then
 */
export function indexAt(ticks, time) {
  let low = 0,
    high = ticks.length - 1;
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if (ticks[middle].time <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}

/**
 * The way of the tool through a recording, for a picture in which the tool's frame stands alone.
 * @param {import('./recording.js').Tick[]} ticks  at least one
 * @param {number} scale  of the picture's lengths to metres
 * @returns {{points: number[], middle: number[], size: number}} three numbers a tick; their mean; and how
 *   far from it the farthest coordinate is, 1 at least
 */
export function toolPath(ticks, scale) {
  /** @type {number[]} */
  const points = [];
  const middle = [0, 0, 0];
  for (const {tool} of ticks) {
    for (let axis = 0; axis < 3; axis++) {
      const place = tool[12 + axis] * scale;
      points.push(place);
      middle[axis] += place / ticks.length;
    }
  }
  // An hour has millions of numbers: too many for the arguments of one call.
  const size = points.reduce((most, place, at) => Math.max(most, Math.abs(place - middle[at % 3])), 1);
  return {points, middle, size};
}

/** Numbers as words for people. What is saved has all digits; what is read has few. */

/** @typedef {import('./protocol.js').Line} Line */
/** @typedef {import('./protocol.js').Unit} Unit */

const units = {mm: 'mm', m: 'm', inch: 'in', µm: 'µm', um: 'µm', cm: 'cm'};
const millimetres = {mm: 1, m: 1000, inch: 25.4, µm: 1e-3, um: 1e-3, cm: 10};

/**
 * @param {number} value
 * @param {number} [digits]  that count
 * @returns {string}
 */
export function short(value, digits = 4) {
  if (!Number.isFinite(value)) return value > 0 ? 'infinite' : '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(2).replace('e+', 'e').replace('-', '−');
  const rounded = Number(value.toPrecision(digits));
  return (size >= 1000 ? Math.round(value).toLocaleString('en-US') : String(rounded)).replace('-', '−');
}

/** @param {number} value */
export function count(value) {
  return Math.round(value).toLocaleString('en-US');
}

/** @type {Record<import('./protocol.js').Unit, string>} */
export const unitNames = {mm: 'millimetres', m: 'metres', inch: 'inches', µm: 'micrometres'};

/**
 * @param {string | null | undefined} unit  of a body; none: millimetres are assumed
 * @returns {string}
 */
export function unitWord(unit) {
  return units[/** @type {keyof typeof units} */ (unit ?? 'mm')] ?? 'units';
}

/**
 * @param {string | null | undefined} unit
 * @returns {number}
 */
export function millimetresIn(unit) {
  return millimetres[/** @type {keyof typeof millimetres} */ (unit ?? 'mm')] ?? 1;
}

/**
 * @param {number | null} lower
 * @param {number | null} upper
 * @param {string} unit
 */
export function interval(lower, upper, unit) {
  if (lower === null || upper === null || lower === undefined || upper === undefined) return 'not known';
  const [from, to] = [short(lower), short(upper)];
  return from === to ? `${from} ${unit}` : `${from} to ${to} ${unit}`;
}

/**
 * @param {Line} line  of `ist collide --json`
 * @returns {[number[], number[]] | null}  the nearest points of the fixed and of the moving body, fixed coordinates
 */
export function nearestPoints({nearest_fixed: fixed, nearest_moving: moving}) {
  return Array.isArray(fixed) && Array.isArray(moving) ? [fixed, moving] : null;
}

/**
 * @param {Line} line  of `ist collide --json`
 * @returns {string}  both points, or one if the bodies touch
 */
export function nearestWords(line) {
  const points = nearestPoints(line);
  if (!points) return 'not known';
  const [fixed, moving] = points.map((point) => `(${point.map((value) => short(value)).join(', ')})`);
  return line.distance_upper === 0 ? `both at ${fixed}` : `${fixed} and ${moving}`;
}

/**
 * How deep two bodies are in each other, by a line of `ist collide --json` or `ist occlusion --json`. For open scans a
 * lower bound is known, the depth of the deepest vertex. If no vertex is inside, the depth is 0 only if they are apart.
 * @param {Line} line
 * @param {string} unit
 */
export function depthWords(
  {touch, inside, self_intersecting: crosses, depth_lower: lower, depth_upper: upper, depth_at_vertices: deepest},
  unit,
) {
  if (typeof lower === 'number') return interval(lower, upper, unit);
  const least = `≥ ${short(deepest, 3)} ${unit} (open scans)`;
  if (touch === 'yes' && deepest > 0) return least;
  if (touch !== 'no' || inside === 'fixed' || inside === 'moving') return 'not known';
  if (deepest > 0) return `0, or ${least}`;
  const hasTriangles = typeof crosses === 'boolean';
  return hasTriangles || inside === 'none' ? `0 ${unit}` : 'not known';
}

/** @param {number} bytes */
export function bytesWords(bytes) {
  if (bytes < 1e3) return `${bytes} bytes`;
  return bytes < 1e6 ? `${short(bytes / 1e3, 3)} kB` : `${short(bytes / 1e6, 3)} MB`;
}

/**
 * @param {import('./protocol.js').BodyFacts} body
 * @returns {string} RAS or LPS
 */
export function frameWord(body) {
  return String(body.info.frame).toUpperCase();
}

/**
 * @param {import('./protocol.js').BodyFacts} a
 * @param {import('./protocol.js').BodyFacts} b
 * @returns {boolean} whether both files name a frame of the patient, and not the same one
 */
export function differInFrame(a, b) {
  return Boolean(a.info.frame && b.info.frame && a.info.frame !== b.info.frame);
}

/**
 * What `ist info` says of a body, in sentences.
 * @param {Line} info
 * @param {string} [assumed]  the unit that counts if the file names none
 * @returns {string[]}
 */
export function infoSentences(info, assumed = 'mm') {
  const sentences = [];
  if (info.kind === 'tree' && info.voxels === null) {
    sentences.push('A tree of triangles without voxels: the page builds its own tree.');
  } else if (info.kind === 'tree') {
    sentences.push(
      `A tree of ${count(info.voxels)} voxels of ${short(info.voxel_size)}, ` +
        (info.triangles
          ? 'which keeps its triangles: the page builds its own.'
          : 'without triangles: touch is known to voxels alone, and it cannot be built again.'),
    );
  } else {
    const parts = info.components === 1 ? '1 component' : `${count(info.components)} components`;
    sentences.push(`A mesh of ${count(info.triangles)} triangles and ${count(info.vertices)} vertices, ${parts}.`);
  }
  if (Array.isArray(info.extent)) {
    const named = info.unit ? ` ${unitWord(info.unit)}` : '';
    sentences.push(
      `Extent ${info.extent.map((/** @type {number} */ side) => short(side)).join(' × ')}${named}` +
        (info.unit ? '.' : `; the file names no unit, so ${unitNames[/** @type {Unit} */ (assumed)]} are assumed.`),
    );
  }
  if (info.frame) sentences.push(`Frame ${info.frame.toUpperCase()}, as the file says.`);
  if (typeof info.closed === 'boolean') {
    const wound = info.consistent === false ? 'not wound consistently' : 'wound consistently';
    const border = typeof info.boundary_edges === 'number' ? ` (${count(info.boundary_edges)} border edges)` : '';
    const volume = typeof info.volume === 'number' ? `, volume ${short(info.volume)}` : '';
    sentences.push(info.closed ? `Closed, ${wound}${volume}.` : `Open${border}, ${wound}: its inside is assumed from the winding.`);
  }
  return sentences;
}

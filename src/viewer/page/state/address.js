/** The address of the page: it follows the state, but not each of its changes. */

// Browsers refuse an address that changes too often, the strictest after 100 times in 30 s.
const free = 20,
  span = 30_000,
  slow = 1000;

/**
 * @param {(fragment: string) => void} write
 * @param {{now?: () => number, later?: (call: () => void, milliseconds: number) => void}} [clock]
 * @returns {(fragment: string) => void}  writes it at once; after many in a short time, the last one a second later
 */
export function makeAddress(write, {now = () => performance.now(), later = (call, milliseconds) => setTimeout(call, milliseconds)} = {}) {
  /** @type {number[]} */
  let written = [];
  /** @type {string | null} */
  let waiting = null;
  const writeNow = (/** @type {string} */ fragment) => {
    written.push(now());
    write(fragment);
  };
  return (fragment) => {
    const waits = waiting !== null;
    written = written.filter((time) => now() - time < span);
    if (!waits && written.length < free) {
      writeNow(fragment);
      return;
    }
    waiting = fragment;
    if (waits) return;
    later(() => {
      const last = /** @type {string} */ (waiting);
      waiting = null;
      writeNow(last);
    }, slow);
  };
}

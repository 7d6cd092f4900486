/** Elements, made in one call. */

/** @typedef {Node | string | null | false} Child */

/**
 * Makes an element. Of the attributes, a function is a listener of the event after "on", true is an
 * attribute without a value, and null, undefined and false are none.
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {Record<string, unknown>} [attributes]
 * @param {...Child} children
 * @returns {HTMLElementTagNameMap[Tag]}
 */
export function element(tag, attributes = {}, ...children) {
  return fill(document.createElement(tag), attributes, children);
}

/**
 * @template {keyof SVGElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {Record<string, unknown>} [attributes]
 * @param {...Child} children
 * @returns {SVGElementTagNameMap[Tag]}
 */
export function svgElement(tag, attributes = {}, ...children) {
  return fill(document.createElementNS('http://www.w3.org/2000/svg', tag), attributes, children);
}

let made = 0;

/**
 * @param {string} of
 * @returns {string} an id that no other element has
 */
export function newId(of) {
  made += 1;
  return `${of}-${made}`;
}

/**
 * @template {Element} Made
 * @param {Made} into
 * @param {Record<string, unknown>} attributes
 * @param {Child[]} children
 */
function fill(into, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function') {
      into.addEventListener(name.slice(2), /** @type {EventListener} */ (value));
    } else if (value === true) {
      into.setAttribute(name, '');
    } else if (value !== null && value !== undefined && value !== false) {
      into.setAttribute(name, String(value));
    }
  }
  into.append(...children.filter((child) => child !== null && child !== false));
  return into;
}

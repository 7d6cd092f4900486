/** What people set: sliders, lists, numbers and buttons, each with its label. */

import {element, newId} from './element.js';

/**
 * @typedef {object} SliderOptions
 * @property {string} label
 * @property {number} min
 * @property {number} max
 * @property {number} [step]         where it is missing: a thousandth of the way
 * @property {number} value
 * @property {boolean} [logarithmic]
 * @property {(value: number) => string} words
 * @property {(value: number) => void} onInput    while it moves
 * @property {(value: number) => void} [onChange] where it is let go
 */

const ways = 1000;

/**
 * @param {SliderOptions} options
 * @returns {{element: HTMLElement, set: (value: number) => void, range: (min: number, max: number) => void, name: (label: string) => void}}
 */
export function slider({label, min, max, step, value, logarithmic, words, onInput, onChange}) {
  const id = newId('slider');
  const output = element('output', {for: id});
  const toWay = (/** @type {number} */ of) => {
    const part = logarithmic ? Math.log(of / min) / Math.log(max / min) : (of - min) / (max - min);
    return Math.round(Math.min(1, Math.max(0, part)) * ways);
  };
  const fromWay = (/** @type {number} */ way) => (logarithmic ? min * (max / min) ** (way / ways) : min + ((max - min) * way) / ways);
  const stepped = step !== undefined;
  const input = element('input', {
    id,
    type: 'range',
    min: stepped ? min : 0,
    max: stepped ? max : ways,
    step: stepped ? step : 1,
    oninput: () => {
      show(read());
      onInput(read());
    },
    onchange: () => onChange?.(read()),
  });
  const read = () => (stepped ? input.valueAsNumber : fromWay(input.valueAsNumber));
  /** @param {number} of */
  const show = (of) => {
    output.value = words(of);
    input.setAttribute('aria-valuetext', words(of));
  };
  /** @param {number} to */
  const set = (to) => {
    value = to;
    input.valueAsNumber = stepped ? to : toWay(to);
    show(to);
  };
  set(value);
  const name = element('label', {for: id}, label);
  return {
    element: element('div', {class: 'control'}, name, output, input),
    set,
    name: (to) => {
      name.textContent = to;
    },
    range: (from, to) => {
      [min, max] = [from, to];
      if (stepped) Object.assign(input, {min: String(min), max: String(max)});
      set(value);
    },
  };
}

/**
 * @template {string} Value
 * @param {{label: string, choices: {value: Value, words: string}[], value: Value, onChange: (value: Value) => void}} options
 * @returns {{element: HTMLElement, set: (value: Value) => void, offer: (choices: {value: Value, words: string}[]) => void}}
 */
export function select({label, choices, value, onChange}) {
  const id = newId('select');
  const list = element('select', {id, onchange: () => onChange(/** @type {Value} */ (list.value))});
  /** @param {typeof choices} offered */
  const offer = (offered) => {
    list.replaceChildren(...offered.map((each) => element('option', {value: each.value}, each.words)));
    list.value = value;
  };
  offer(choices);
  return {
    element: element('div', {class: 'control'}, element('label', {for: id}, label), list),
    set: (to) => {
      value = to;
      list.value = to;
    },
    offer,
  };
}

/**
 * @param {{label: string, value: number, min?: number, max?: number, step?: number | 'any', onChange: (value: number) => void}} options
 * @returns {{element: HTMLElement, set: (value: number) => void}}
 */
export function numberField({label, value, min, max, step = 'any', onChange}) {
  const id = newId('number');
  const input = element('input', {
    id,
    type: 'number',
    min,
    max,
    step,
    inputmode: 'decimal',
    value,
    onchange: () => {
      if (input.validity.valid && Number.isFinite(input.valueAsNumber)) onChange(input.valueAsNumber);
      else input.reportValidity();
    },
  });
  return {
    element: element('div', {class: 'control'}, element('label', {for: id}, label), input),
    set: (to) => {
      if (document.activeElement !== input || Number(input.value) !== to) input.value = String(to);
    },
  };
}

/**
 * @param {string} label
 * @param {() => void} onClick
 * @param {{title?: string, primary?: boolean}} [options]
 */
export function button(label, onClick, {title, primary} = {}) {
  return element('button', {type: 'button', class: primary ? 'primary' : null, title, onclick: onClick}, label);
}

/**
 * @param {string} label
 * @param {boolean} value
 * @param {(value: boolean) => void} onChange
 * @returns {{element: HTMLElement, set: (value: boolean) => void}}
 */
export function checkbox(label, value, onChange) {
  const input = element('input', {type: 'checkbox', checked: value, onchange: () => onChange(input.checked)});
  return {
    element: element('label', {class: 'check'}, input, label),
    set: (to) => {
      input.checked = to;
    },
  };
}

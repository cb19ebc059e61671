// SPDX-License-Identifier: Apache-2.0
// Drawings: elements of SVG, scales, and what every plot has.

export function draw(tag, attributes = {}, ...children) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

export const picture = (width, height, ...children) =>
    draw('svg', {viewBox: `0 0 ${width} ${height}`, width, height, role: 'img'}, ...children);

export const text = (x, y, words, more = {}) => draw('text', {x, y, ...more}, words);

export function hint(element, words) {
  element.append(draw('title', {}, words));
  return element;
}

export const scale = (from, to, begin, end) => (value) =>
    begin + (to > from ? (value - from) / (to - from) : 0.5) * (end - begin);

// Round numbers between two, at most `most` of them.
export function ticks(from, to, most = 6) {
  if (!(to > from)) return [from];
  const power = 10 ** Math.floor(Math.log10((to - from) / most));
  const step = [1, 2, 5, 10].map((factor) => factor * power)
      .find((candidate) => (to - from) / candidate <= most);
  const out = [];
  for (let k = Math.ceil(from / step - 1e-9); k * step <= to + step * 1e-9; ++k) out.push(k * step);
  return out;
}

export const number = (value) => Number(value.toPrecision(4)).toString();

// With so many digits that only all of them are 100 and none of them 0.
export function percent(share) {
  const wrong = (words) => (Number(words) === 0 && share > 1e-9) || (Number(words) === 100 && share < 1 - 1e-9);
  let digits = 1;
  while (digits < 8 && wrong((100 * share).toFixed(digits))) ++digits;
  return `${(100 * share).toFixed(digits)} %`;
}

// What can be clicked can also be reached and pressed with the keyboard.
export function pressable(element, action, label) {
  element.setAttribute('tabindex', 0);
  element.setAttribute('role', 'button');
  if (label) element.setAttribute('aria-label', label);
  element.classList.add('pressable');
  element.addEventListener('click', action);
  element.addEventListener('keydown', (event) => {
    if (event.key !== 'Enter' && event.key !== ' ') return;
    event.preventDefault();
    action();
  });
  return element;
}

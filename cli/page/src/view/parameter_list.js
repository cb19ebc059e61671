// SPDX-License-Identifier: Apache-2.0
// Of the parameters what can be told without a page.

// [scope, parameters] in the order of the list, of those that hold all words of `filter`.
export function grouped(parameters, filter) {
  const words = filter.toLowerCase().split(/\s+/).filter(Boolean);
  const scopes = new Map();
  for (const one of parameters) {
    const text = `${one.name} ${one.description} ${one.variant ?? ''}`.toLowerCase();
    if (!words.every((word) => text.includes(word))) continue;
    const scope = one.name.split('.')[0];
    if (!scopes.has(scope)) scopes.set(scope, []);
    scopes.get(scope).push(one);
  }
  return [...scopes];
}

// Of a slider that fits the range: about 200 places, a whole number of integers.
export function stepOf({type, min, max}) {
  if (type === 'integer') return 1;
  const rough = (max - min) / 200;
  return rough > 0 ? 10 ** Math.floor(Math.log10(rough)) : 'any';
}

// Whether a value is not the default, but for rounding on its way through text.
export function isChanged({value, default: normal}) {
  if (typeof value !== 'number') return value !== normal;
  return Math.abs(value - normal) > 1e-9 * Math.max(1, Math.abs(normal));
}

// As short as it stays the same.
export const shown = (value) => typeof value === 'number' ? String(Number(value.toPrecision(7))) : String(value);

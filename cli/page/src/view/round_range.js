// SPDX-License-Identifier: Apache-2.0

// [from, to] around the values from `low` to `high`, at least `least` long. Rounded, so that it stays as
// it is while the values scroll by; null, as uPlot says it, if there are none.
export function roundRange(low, high, least) {
  if (!Number.isFinite(low) || !Number.isFinite(high)) return [0, least || 1];
  const missing = Math.max(0, least - (high - low)) / 2;
  const span = high - low + 2 * missing || 1;
  const step = 10 ** Math.floor(Math.log10(span)) / 4;
  return [step * Math.floor((low - missing) / step - 0.2), step * Math.ceil((high + missing) / step + 0.2)];
}

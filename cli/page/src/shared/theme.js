// SPDX-License-Identifier: Apache-2.0
// Light or dark, as the browser wants it; style.css has the same for what is text.
const dark = matchMedia('(prefers-color-scheme: dark)');
dark.addEventListener('change', () => location.reload());

export const theme = dark.matches ?
    {ink: '#d5d9dd', paper: '#17191c', grid: '#34383d', phase: '#ffffff12', sky: '#202429',
     ground: '#2b2e31', ground_lines: '#50555a', step: 12} :
    {ink: '#222222', paper: '#ffffff', grid: '#e2e2e2', phase: '#0000000f', sky: '#f4f6f8',
     ground: '#e9e7e1', ground_lines: '#b5b2aa', step: 0};

// Hue, saturation, lightness.
const kLines = [[205, 71, 41], [0, 69, 50], [120, 57, 40], [28, 100, 53], [271, 39, 57], [10, 30, 42],
                [318, 66, 68], [186, 80, 45], [60, 70, 44], [228, 89, 63], [162, 82, 40], [334, 86, 59],
                [50, 100, 30], [0, 0, 50]];

// The colour of the i-th line of a plot; of another log a paler one, for each log its own.
export function lineColor(i, log = 0) {
  const [hue, saturation, lightness] = kLines[i] ?? [Math.round(i * 137.5) % 360, 60, 35 + i % 5 * 6];
  const paler = log === 0 ? 0 : 12 + 6 * log;
  return `hsl(${hue}, ${saturation}%, ${Math.min(92, lightness + paler + theme.step)}%)`;
}

// Of pushes, everywhere.
export const kPushColor = dark.matches ? '#ff6fa5' : '#c2185b';
// Of loads, and of what pulls.
export const kLoadColor = dark.matches ? '#c9a06a' : '#8d6e3f';
export const kPullColor = dark.matches ? '#7fd1c7' : '#00796b';

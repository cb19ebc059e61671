// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';

import {clip} from '../src/shared/hull.js';

const kSole = [[0.13, -0.06], [0.13, 0.06], [-0.13, 0.06], [-0.13, -0.06]];
const reach = {back: -1, front: 1, right: -1, left: 1};
const area = (polygon) => polygon.reduce((sum, [x, y], i) => {
  const [u, v] = polygon.at(i - 1);
  return sum + 0.5 * (u * y - v * x);
}, 0);

test('A sole that bears on all of it stays as it is', () => {
  assert.deepEqual(clip(kSole, reach), kSole);
});

test('A sole is cut where it bears on no more', () => {
  const part = clip(kSole, {...reach, left: 0.01, back: -0.03});
  assert.ok(Math.abs(area(part) - 0.16 * 0.07) < 1e-12, `${area(part)}`);
  assert.equal(part.length, 4);
});

test('A corner that is cut off leaves two', () => {
  const rhomb = [[0.1, 0], [0, 0.1], [-0.1, 0], [0, -0.1]];
  const part = clip(rhomb, {...reach, front: 0.05});
  assert.equal(part.length, 5);
  assert.ok(Math.abs(area(part) - (0.02 - 0.0025)) < 1e-12, `${area(part)}`);
});

test('Nothing is left of a sole that bears on nothing', () => {
  assert.deepEqual(clip(kSole, {...reach, front: -0.2}), []);
});

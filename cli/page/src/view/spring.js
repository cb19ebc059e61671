// SPDX-License-Identifier: Apache-2.0

export const kStiffness = 600;  // N/m
export const kMostForce = 500;  // N

// Force in N on a point that a spring pulls to `target`; both [x, y, z] in m.
export function springForce(point, target) {
  const force = target.map((value, i) => kStiffness * (value - point[i]));
  const size = Math.hypot(...force);
  return size > kMostForce ? force.map((value) => value * kMostForce / size) : force;
}

// SPDX-License-Identifier: Apache-2.0

const kGravity = 9.81;

// The fastest that gaitd walks, from the parameters `drive.*` and the height of the centre of mass:
// {forward, backward, lateral} in m/s, {turn} in rad/s. What is not known is that of a robot of 1 m.
export function reachOf(parameters, height) {
  const value = (name, normal) => parameters.find((one) => one.name === `drive.${name}`)?.value ?? normal;
  const h = height > 0.1 ? height : 1;
  const pace = Math.sqrt(kGravity * h), forward = value('max_forward', 0.2) * pace;
  return {forward, backward: forward / 2, lateral: value('max_lateral', 0.06) * pace,
          turn: value('max_turn', 0.12) * Math.sqrt(kGravity / h)};
}

// Shares from -1 to 1 as a velocity; `speed` is the share of the fastest that a whole push of the stick
// is. Rounded: a mm/s more or less is not worth the digits.
export function velocityOf({forward, lateral, turn}, reach, speed) {
  const round = (value) => Math.round(1000 * speed * value) / 1000;
  return {forward: round(forward * (forward < 0 ? reach.backward : reach.forward)),
          lateral: round(lateral * reach.lateral), turn: round(turn * reach.turn)};
}

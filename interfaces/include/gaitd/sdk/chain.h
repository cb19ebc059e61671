// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "gaitd/abi/types.h"

namespace gaitd::sdk {

// Joints on the way from one body to another, in this order.
struct Chain {
  std::array<int, GAITD_MAX_MOTION_AXES> joints{};
  int count = 0;
};

// From body `from` outwards to body `to`. Empty where `to` does not hang on `from`, or by more
// joints than a motion has axes.
inline Chain chain_of(const GaitdModel& model, int from, int to) {
  Chain chain;
  for (int body = to; body != from; body = model.bodies[body].parent) {
    if (body <= 0 || chain.count == GAITD_MAX_MOTION_AXES) return {};
    chain.joints[chain.count++] = model.bodies[body].joint;
  }
  std::reverse(chain.joints.begin(), chain.joints.begin() + chain.count);
  return chain;
}

// The arm that carries a hand, GAITD_LEFT or GAITD_RIGHT, from the chest; empty if the robot has no
// hand there. Axis i of a motion of the arm is joint i of it.
inline Chain arm_of(const GaitdModel& model, int hand) {
  const int body = model.hands[hand].body;
  return body > 0 ? chain_of(model, model.chest_body, body) : Chain{};
}

}  // namespace gaitd::sdk

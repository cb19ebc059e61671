// SPDX-License-Identifier: Apache-2.0
#include "never.h"

#include <algorithm>
#include <iterator>

namespace gaitd::plugins {

GaitdStatus Never::process(const GaitdToeOffInput& in, GaitdToeOff& out) {
  out = {};
  out.size = sizeof(out);
  out.side = GAITD_BOTH;
  const int side = in.gait->trailing_side;
  if (side == GAITD_LEFT || side == GAITD_RIGHT) {
    std::copy(std::begin(model_.feet[side].toe_point), std::end(model_.feet[side].toe_point),
              out.toe_point);
  }
  return GAITD_OK;
}

}  // namespace gaitd::plugins

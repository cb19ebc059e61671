// SPDX-License-Identifier: Apache-2.0
#include "fixed_steps.h"

namespace gaitd::plugins {

GaitdStatus FixedSteps::process(const GaitdStepAdjusterInput& in, GaitdStepAdjustment& out) {
  feedback_.update(in, out);
  return GAITD_OK;
}

}  // namespace gaitd::plugins

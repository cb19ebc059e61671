// SPDX-License-Identifier: Apache-2.0
// Inputs of the layers for a synthetic walk, and their parameters by name.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <string_view>

#include "gaitd/abi/plugin.h"
#include "walking/test/synthetic_walk.h"

namespace gaitd::testing {

template <class Layer>
int parameter_index(std::string_view name) {
  for (std::size_t i = 0; i < Layer::kParameters.size(); ++i) {
    const GaitdParameter& p = Layer::kParameters[i];
    if (name == std::string_view(p.name, strnlen(p.name, GAITD_NAME_SIZE))) {
      return static_cast<int>(i);
    }
  }
  return -1;
}
template <class Layer>
double parameter_default(std::string_view name) {
  const int i = parameter_index<Layer>(name);
  EXPECT_GE(i, 0) << name;
  return i < 0 ? 0.0 : Layer::kParameters[i].default_value;
}
template <class Layer>
void set_parameter(Layer& layer, std::string_view name, double value) {
  const int i = parameter_index<Layer>(name);
  ASSERT_GE(i, 0) << name;
  layer.set_parameter(i, value);
}

inline GaitdLayerTime layer_time(double period, int tick = 0) {
  return {tick, tick * period, period};
}

// The plan of a walk by a planner layer.
template <class Planner>
SyntheticWalk::Planner planned_by(Planner& planner, double period) {
  return [&planner, period](const GaitdRobotState& robot, const GaitdGaitState& gait,
                            GaitdIcpPlan& plan) {
    const GaitdIcpPlannerInput in{sizeof(in), 0, layer_time(period), &robot, &gait};
    ASSERT_EQ(planner.process(in, plan), GAITD_OK);
  };
}

}  // namespace gaitd::testing

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "daemon/conformance/sample_walk.h"
#include "daemon/control/pipeline.h"
#include "daemon/host/layers.h"
#include "daemon/parameters/scopes.h"
#include "walking/test/atlas.h"

namespace gaitd::daemon {

using testing::atlas;
inline constexpr double kPipelinePeriod = 0.001;  // s
inline constexpr const char* kVariants[] = {"kinematic_inertial", "heel_to_toe",
                                            "step_plan",          "icp_criteria",
                                            "nullspace_qp",       "trajectory_player"};

inline std::vector<double> defaults(std::span<const GaitdParameter> table) {
  std::vector<double> values;
  for (const GaitdParameter& parameter : table) values.push_back(parameter.default_value);
  return values;
}

// The control pipeline with the shipped layers, and the sensors of a robot that stands still,
// whatever it is commanded.
class PipelineBench {
 public:
  // `planner`: a library instead of the shipped one, with these parameters.
  explicit PipelineBench(const std::string& planner = "", std::vector<double> values = {})
      : walk(std::make_unique<SampleWalk>(atlas())) {
    LayerChain::Layers layers;
    for (int i = 0; i < GAITD_LAYER_COUNT; ++i) {
      const bool other = i == GAITD_LAYER_ICP_PLANNER && !planner.empty();
      LoadedLayer::Request request;
      request.path = other ? planner
                           : std::string(GAITD_PLUGIN_DIR "/") + std::string(layer_name(i)) + "/" +
                                 kVariants[i] + ".so";
      request.layer = i;
      request.model = &atlas();
      request.parameters = other ? values : std::vector<double>{};
      request.probe = false;
      Refusal refusal;
      layers[i] = LoadedLayer::load(request, &refusal);
      EXPECT_NE(layers[i], nullptr) << refusal.text();
      const GaitdPluginDescriptor& d = layers[i]->descriptor();
      const std::span<const GaitdParameter> table{d.parameters, d.parameter_count};
      parameters.add(i, layer_name(i), d.id, table, defaults(table));
    }
    for (const DaemonScope& scope : daemon_scopes()) {
      parameters.add(scope.owner, scope.name, "", scope.table, defaults(scope.table));
    }
    pipeline = std::make_unique<Pipeline>(atlas(), Calibration{}, std::move(layers), GaitdStart{},
                                          &parameters, kPipelinePeriod);
  }
  // The readings of tick `number`. Nothing that is measured repeats itself.
  void read(std::int64_t number, GaitdSensors& sensors) {
    if (number == 0) walk->tick();
    sensors = walk->inputs().sensors;
    const double wobble = 1e-5 * static_cast<double>(number % 7);
    const auto sequence = static_cast<std::uint32_t>(number);
    for (auto& joint : sensors.joints) joint.info.sequence = sequence;
    for (auto& imu : sensors.imus) {
      imu.info.sequence = sequence;
      imu.specific_force[0] += wobble;
    }
    for (auto& foot : sensors.feet) {
      foot.info.sequence = sequence;
      foot.force[2] += wobble;
    }
  }
  void run_for(double seconds) {
    for (int i = 0; i < seconds / kPipelinePeriod; ++i, ++tick) {
      read(tick, pipeline->data().readings);
      pipeline->run(tick);
    }
  }
  CommandReply execute(CommandType type) {
    Command command;
    command.type = type;
    return pipeline->execute(command);
  }
  SafetyState state() const { return pipeline->safety().state(); }

  LiveParameters parameters;
  std::unique_ptr<SampleWalk> walk;
  std::unique_ptr<Pipeline> pipeline;
  std::int64_t tick = 0;
};

}  // namespace gaitd::daemon

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "daemon/control/tick_data.h"
#include "daemon/host/loaded_plugin.h"

namespace gaitd::daemon {

// The five layers and the check of what each wrote. A layer that fails or writes something that is
// not finite or out of range leaves its last good output in place; the caller decides what follows.
class LayerChain {
 public:
  using Layers = std::array<std::unique_ptr<LoadedLayer>, GAITD_LAYER_COUNT>;

  // What a layer did wrong last; layer -1 if none ever did.
  struct Failure {
    int layer = -1;
    const char* what = "";  // the field and its rule, or the status that process() returned
  };

  LayerChain(Layers layers, int joint_count)
      : layers_(std::move(layers)), joint_count_(joint_count) {}

  LoadedLayer& layer(int index) { return *layers_[index]; }
  const Failure& failure() const { return failure_; }
  void reset();

  // Each runs one layer on `data`. False: failed, the output is the last good one.
  bool estimate(const GaitdStart& start, TickData& data);
  bool plan(TickData& data);
  bool adjust(TickData& data);
  bool toe_off(TickData& data);
  bool control(TickData& data);

 private:
  template <class Input, class Output>
  bool run(int layer, const Input& input, Output& output, Output& last_good, TickTimes& times);

  Layers layers_;
  const int joint_count_;
  Failure failure_;
  // Last good outputs, taken back when a layer fails.
  GaitdRobotState robot_{};
  GaitdIcpPlan plan_{};
  GaitdStepAdjustment adjustment_{};
  GaitdToeOff toe_off_{};
  GaitdWholeBodyControllerOutput wbc_{};
};

}  // namespace gaitd::daemon

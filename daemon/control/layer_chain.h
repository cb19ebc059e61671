// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <tuple>

#include "daemon/control/layer_slot.h"
#include "daemon/control/tick_data.h"
#include "daemon/control/tick_watch.h"
#include "daemon/host/loaded_plugin.h"

namespace gaitd::daemon {

// The six layers, the check of what each wrote, and their hot swaps. A layer that fails or writes
// something that is not finite or out of range leaves its last good output in place; the caller
// decides what follows.
class LayerChain {
 public:
  using Layers = std::array<std::unique_ptr<LoadedLayer>, GAITD_LAYER_COUNT>;

  // What a layer did wrong last; layer -1 if none ever did.
  struct Failure {
    int layer = -1;
    const char* what = "";  // the field and its rule, or the status that process() returned
  };

  // `model` must outlive it.
  LayerChain(Layers layers, const GaitdModel& model);

  // Each runs one layer on `data`. False: failed, the output is the last good one.
  bool estimate(const GaitdStart& start, TickData& data);
  bool source_tasks(TickData& data);
  bool plan(TickData& data);
  bool adjust(TickData& data);
  bool toe_off(TickData& data);
  bool control(TickData& data);

  // [any thread] The layer that runs, or -1.
  int running() const noexcept { return running_.load(std::memory_order_relaxed); }

  // ---- Between ticks.

  const Failure& failure() const { return failure_; }
  LayerInstance& in_use(int layer);
  // What the layers may take, as their plugins declare it, in a swap both together. [rt]
  TickWatch::Budgets budgets() const;
  // All of them, or those that run under control only.
  void reset();
  void reset_controllers();
  // GAITD_OK, or what the layer in use says.
  GaitdStatus set_parameter(int layer, int index, double value);

  // `controlled`: the layers behind the estimator run. What comes of it is in the reports.
  void begin_swap(const SwapOrder& order, bool controlled);
  void refuse_swap(const SwapOrder& order, const char* why);
  // The layers behind the estimator have stopped: ends their swaps.
  void give_up_swaps(const char* why);
  // Ends the swaps whose layer has not come into use yet.
  void give_up_shadows(const char* why);
  // After each tick under control. Layers that came in a short while ago go again when it grows.
  void watch_icp_error(double error, double dt);
  void take_too_long(int layer);  // replay, see LayerSlot
  bool take_report(SwapReport* report);
  SwapRules& rules() { return rules_; }
  const SwapRules& rules() const { return rules_; }

 private:
  // Calls `function` with the slot of a layer.
  template <class Self, class Function>
  static auto with_slot(Self& self, int layer, Function&& function);
  template <int kLayer>
  bool run(const typename LayerSlot<kLayer>::Input& input,
           typename LayerSlot<kLayer>::Output& output, TickTimes& times);

  SwapRules rules_;
  std::tuple<LayerSlot<GAITD_LAYER_STATE_ESTIMATOR>, LayerSlot<GAITD_LAYER_ICP_PLANNER>,
             LayerSlot<GAITD_LAYER_STEP_ADJUSTER>, LayerSlot<GAITD_LAYER_TOE_OFF>,
             LayerSlot<GAITD_LAYER_WHOLE_BODY_CONTROLLER>, LayerSlot<GAITD_LAYER_TASK_SOURCE>>
      slots_;
  std::atomic<int> running_{-1};
  Failure failure_;
  double icp_error_before_ = 0.0;  // m, without any swap, the largest of late
};

}  // namespace gaitd::daemon

// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/layer_chain.h"

#include <algorithm>

namespace gaitd::daemon {
namespace {

constexpr double kErrorTime = 2.5;  // s, some steps, in which the largest ICP error so far fades

}  // namespace

LayerChain::LayerChain(Layers l, const GaitdModel& model)
    : slots_{LayerSlot<0>(std::move(l[0]), model, rules_),
             LayerSlot<1>(std::move(l[1]), model, rules_),
             LayerSlot<2>(std::move(l[2]), model, rules_),
             LayerSlot<3>(std::move(l[3]), model, rules_),
             LayerSlot<4>(std::move(l[4]), model, rules_),
             LayerSlot<5>(std::move(l[5]), model, rules_)} {}

template <class Self, class Function>
auto LayerChain::with_slot(Self& self, int layer, Function&& function) {
  switch (layer) {
    case GAITD_LAYER_STATE_ESTIMATOR:
      return function(std::get<GAITD_LAYER_STATE_ESTIMATOR>(self.slots_));
    case GAITD_LAYER_ICP_PLANNER:
      return function(std::get<GAITD_LAYER_ICP_PLANNER>(self.slots_));
    case GAITD_LAYER_STEP_ADJUSTER:
      return function(std::get<GAITD_LAYER_STEP_ADJUSTER>(self.slots_));
    case GAITD_LAYER_TOE_OFF:
      return function(std::get<GAITD_LAYER_TOE_OFF>(self.slots_));
    case GAITD_LAYER_TASK_SOURCE:
      return function(std::get<GAITD_LAYER_TASK_SOURCE>(self.slots_));
    default:
      return function(std::get<GAITD_LAYER_WHOLE_BODY_CONTROLLER>(self.slots_));
  }
}

LayerInstance& LayerChain::in_use(int layer) {
  return *with_slot(*this, layer, [](auto& slot) { return &slot.in_use(); });
}

TickWatch::Budgets LayerChain::budgets() const {
  TickWatch::Budgets budgets;
  for (int i = 0; i < GAITD_LAYER_COUNT; ++i) {
    budgets[i] = with_slot(*this, i, [](const auto& slot) { return slot.budget_us(); });
  }
  return budgets;
}

void LayerChain::reset() {
  std::apply([](auto&... slot) { (slot.reset(), ...); }, slots_);
  failure_ = {};
  icp_error_before_ = 0.0;
}

void LayerChain::reset_controllers() {
  for (int i = GAITD_LAYER_ICP_PLANNER; i < GAITD_LAYER_COUNT; ++i) {
    with_slot(*this, i, [](auto& slot) { slot.reset(); });
  }
}

GaitdStatus LayerChain::set_parameter(int layer, int index, double value) {
  return with_slot(*this, layer, [&](auto& slot) { return slot.set_parameter(index, value); });
}

void LayerChain::begin_swap(const SwapOrder& order, bool controlled) {
  const bool runs = controlled || order.layer == GAITD_LAYER_STATE_ESTIMATOR;
  with_slot(*this, order.layer, [&](auto& slot) { slot.begin(order, runs); });
}

void LayerChain::refuse_swap(const SwapOrder& order, const char* why) {
  with_slot(*this, order.layer, [&](auto& slot) { slot.refuse(order, why); });
}

void LayerChain::give_up_swaps(const char* why) {
  for (int i = GAITD_LAYER_ICP_PLANNER; i < GAITD_LAYER_COUNT; ++i) {
    with_slot(*this, i, [why](auto& slot) { slot.give_up(why); });
  }
}

void LayerChain::give_up_shadows(const char* why) {
  std::apply([why](auto&... slot) { (slot.give_up_shadow(why), ...); }, slots_);
}

// A newcomer is compared with the largest error of the last steps: a robot whose drives stick is
// off its plan by some centimetres at each touchdown.
void LayerChain::watch_icp_error(double error, double dt) {
  if (error > icp_error_before_ + rules_.icp_error_growth) {
    std::apply([](auto&... slot) { (slot.doubt("the ICP error grows"), ...); }, slots_);
  }
  // Beside a newcomer that is not in use yet the error is still that of the others.
  if (std::apply([](const auto&... slot) { return (slot.on_probation() || ...); }, slots_)) return;
  icp_error_before_ += std::min(1.0, dt / kErrorTime) * (error - icp_error_before_);
  icp_error_before_ = std::max(icp_error_before_, error);
}

void LayerChain::take_too_long(int layer) {
  with_slot(*this, layer, [](auto& slot) { slot.take_too_long(); });
}

bool LayerChain::take_report(SwapReport* report) {
  for (int i = 0; i < GAITD_LAYER_COUNT; ++i) {
    if (with_slot(*this, i, [report](auto& slot) { return slot.take_report(report); })) return true;
  }
  return false;
}

template <int kLayer>
bool LayerChain::run(const typename LayerSlot<kLayer>::Input& input,
                     typename LayerSlot<kLayer>::Output& output, TickTimes& times) {
  running_.store(kLayer, std::memory_order_relaxed);
  const char* error = std::get<kLayer>(slots_).run(input, output, &times.layer_us[kLayer]);
  running_.store(-1, std::memory_order_relaxed);
  if (error != nullptr) failure_ = {kLayer, error};
  return error == nullptr;
}

bool LayerChain::estimate(const GaitdStart& start, TickData& d) {
  GaitdStateEstimatorInput in{};
  in.size = sizeof(in);
  in.time = d.time;
  in.start = start;
  in.omega = d.gait.omega;
  in.sensors = &d.sensors;
  in.gait = &d.gait;
  in.commands = &d.commands;
  std::copy_n(d.robot.external_wrench, 6, in.external_wrench);
  in.external_wrench[5] += d.external.load;
  in.loads = &d.loads;
  return run<GAITD_LAYER_STATE_ESTIMATOR>(in, d.robot, d.times);
}

bool LayerChain::source_tasks(TickData& d) {
  const GaitdTaskSourceInput in{sizeof(in), 0, d.time, &d.robot, &d.gait, &d.motions};
  return run<GAITD_LAYER_TASK_SOURCE>(in, d.references, d.times);
}

bool LayerChain::plan(TickData& d) {
  const GaitdIcpPlannerInput in{sizeof(in), 0, d.time, &d.robot, &d.gait};
  return run<GAITD_LAYER_ICP_PLANNER>(in, d.plan, d.times);
}

bool LayerChain::adjust(TickData& d) {
  const GaitdStepAdjusterInput in{sizeof(in), 0, d.time, &d.robot, &d.gait, &d.plan, &d.toe_off};
  return run<GAITD_LAYER_STEP_ADJUSTER>(in, d.adjustment, d.times);
}

bool LayerChain::toe_off(TickData& d) {
  const GaitdToeOffInput in{sizeof(in), 0, d.time, &d.robot, &d.gait, &d.plan, &d.adjustment};
  return run<GAITD_LAYER_TOE_OFF>(in, d.toe_off, d.times);
}

bool LayerChain::control(TickData& d) {
  const GaitdWholeBodyControllerInput in{sizeof(in), 0,          d.time,       &d.robot,
                                         &d.gait,    &d.toe_off, &d.objectives};
  return run<GAITD_LAYER_WHOLE_BODY_CONTROLLER>(in, d.wbc, d.times);
}

}  // namespace gaitd::daemon

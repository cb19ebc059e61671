// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/layer_chain.h"

#include "daemon/control/stopwatch.h"
#include "daemon/host/check_output.h"

namespace gaitd::daemon {
namespace {

template <class Output>
void take_back(Output& output, const Output& last_good) {
  output = last_good;
}
// The log keeps why there is no solution.
void take_back(GaitdWholeBodyControllerOutput& output,
               const GaitdWholeBodyControllerOutput& last_good) {
  const int status = output.info.status;
  output = last_good;
  const bool known = status > GAITD_WBC_SOLVED && status <= GAITD_WBC_NON_FINITE;
  output.info.status = known ? status : int{GAITD_WBC_NON_FINITE};
}

}  // namespace

void LayerChain::reset() {
  for (auto& layer : layers_) layer->reset();
  robot_ = {};
  plan_ = {};
  adjustment_ = {};
  toe_off_ = {};
  wbc_ = {};
  failure_ = {};
}

template <class Input, class Output>
bool LayerChain::run(int layer, const Input& input, Output& output, Output& last_good,
                     TickTimes& times) {
  const Stopwatch watch;
  const GaitdStatus status = layers_[layer]->process(&input, &output);
  const char* error = status == GAITD_OK ? output_error(output, joint_count_) : status_name(status);
  times.layer_us[layer] = watch.microseconds();
  if (error == nullptr) {
    last_good = output;
    return true;
  }
  failure_ = {layer, error};
  take_back(output, last_good);
  return false;
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
  return run(GAITD_LAYER_STATE_ESTIMATOR, in, d.robot, robot_, d.times);
}

bool LayerChain::plan(TickData& d) {
  const GaitdIcpPlannerInput in{sizeof(in), 0, d.time, &d.robot, &d.gait};
  return run(GAITD_LAYER_ICP_PLANNER, in, d.plan, plan_, d.times);
}

bool LayerChain::adjust(TickData& d) {
  const GaitdStepAdjusterInput in{sizeof(in), 0, d.time, &d.robot, &d.gait, &d.plan, &d.toe_off};
  return run(GAITD_LAYER_STEP_ADJUSTER, in, d.adjustment, adjustment_, d.times);
}

bool LayerChain::toe_off(TickData& d) {
  const GaitdToeOffInput in{sizeof(in), 0, d.time, &d.robot, &d.gait, &d.plan, &d.adjustment};
  return run(GAITD_LAYER_TOE_OFF, in, d.toe_off, toe_off_, d.times);
}

bool LayerChain::control(TickData& d) {
  const GaitdWholeBodyControllerInput in{sizeof(in), 0,          d.time,       &d.robot,
                                         &d.gait,    &d.toe_off, &d.objectives};
  return run(GAITD_LAYER_WHOLE_BODY_CONTROLLER, in, d.wbc, wbc_, d.times);
}

}  // namespace gaitd::daemon

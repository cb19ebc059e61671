// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/layer_chain.h"

#include <cmath>

#include "daemon/control/stopwatch.h"

namespace gaitd::daemon {
namespace {

template <class T>
bool finite(const T* values, int count) {
  // A sum is not finite as soon as one term is not; far cheaper than asking each.
  double sum = 0.0;
  for (int i = 0; i < count; ++i) sum += values[i] - values[i];
  return sum == 0.0;
}
template <int N>
bool finite(const double (&values)[N]) {
  return finite(values, N);
}

bool sound(const GaitdRobotState& r) {
  return r.valid != 0 && finite(r.pelvis_position) && finite(r.pelvis_orientation) &&
         finite(r.pelvis_twist) && finite(r.joint_position, r.joint_count) &&
         finite(r.joint_velocity, r.joint_count) && finite(r.com) && finite(r.com_velocity) &&
         finite(r.icp);
}
bool sound(const GaitdIcpPlan& p) {
  return finite(p.icp) && finite(p.icp_velocity) && finite(p.ecmp) && std::isfinite(p.kappa);
}
bool sound(const GaitdStepAdjustment& a) {
  return finite(a.shift) && std::isfinite(a.time_shift) && finite(a.ecmp) && finite(a.cmp) &&
         finite(a.linear_momentum_rate) && finite(a.angular_momentum_rate);
}
bool sound(const GaitdToeOff& t) {
  return finite(t.toe_point) && (t.active == 0 || t.side == GAITD_LEFT || t.side == GAITD_RIGHT);
}
bool sound(const GaitdWholeBodyControllerOutput& w) {
  if (w.info.status != GAITD_WBC_SOLVED) return false;
  for (int i = 0; i < w.commands.joint_count; ++i) {
    const GaitdJointCommand& c = w.commands.joints[i];
    if (!std::isfinite(c.torque + c.position + c.velocity + c.stiffness + c.damping)) return false;
  }
  return true;
}

}  // namespace

void LayerChain::reset() {
  for (auto& layer : layers_) layer->reset();
  robot_ = {};
  plan_ = {};
  adjustment_ = {};
  toe_off_ = {};
  wbc_ = {};
}

template <class Input, class Output, class Check>
bool LayerChain::run(int layer, const Input& input, Output& output, Check&& last_good,
                     TickTimes& times) {
  const Stopwatch watch;
  const bool ok = layers_[layer]->process(&input, &output) == GAITD_OK && sound(output);
  times.layer_us[layer] = watch.microseconds();
  if (ok) {
    last_good = output;
  } else {
    output = last_good;
  }
  return ok;
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
  GaitdWbcInfo& info = d.wbc.info;
  const bool ok = run(GAITD_LAYER_WHOLE_BODY_CONTROLLER, in, d.wbc, wbc_, d.times);
  if (!ok && info.status == GAITD_WBC_SOLVED) info.status = GAITD_WBC_NON_FINITE;
  return ok;
}

}  // namespace gaitd::daemon

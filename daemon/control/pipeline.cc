// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/pipeline.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "daemon/control/stopwatch.h"

namespace gaitd::daemon {
namespace {

CommandReply refused(const Command& command, std::int64_t tick, const char* why) {
  CommandReply reply;
  reply.tick = tick;
  reply.request = command.request;
  std::snprintf(reply.message.data(), reply.message.size(), "%s", why);
  return reply;
}

}  // namespace

Pipeline::Pipeline(const GaitdModel& model, LayerChain::Layers layers, const GaitdStart& start,
                   const LimitsConfig& limits, double period)
    : model_(model),
      start_(start),
      period_(period),
      layers_(std::move(layers)),
      gait_(model),
      objectives_(model),
      safety_(model, limits) {
  data_.gait = gait_.state();
}

void Pipeline::reset() {
  layers_.reset();
  safety_.reset();
  const auto variants = data_.variants;
  data_ = TickData{};
  data_.variants = variants;
  gait_.reset(data_.robot);
  data_.gait = gait_.state();
  safety_.arm();
}

void Pipeline::begin_control() {
  gait_.reset(data_.robot);
  data_.gait = gait_.state();
  objectives_.reset(data_.robot, data_.gait);
  for (int i = GAITD_LAYER_ICP_PLANNER; i < GAITD_LAYER_COUNT; ++i) layers_.layer(i).reset();
}

void Pipeline::run(std::int64_t tick) {
  const Stopwatch watch;
  TickData& d = data_;
  d.time = {tick, static_cast<double>(tick) * period_, period_};
  const bool estimated = layers_.estimate(start_, d);
  safety_.check(d, estimated);
  if (safety_.update(period_, d, gait_.walking())) begin_control();
  const bool controlled = safety_.controlled();
  const bool ok = controlled && control(period_);
  safety_.write(period_, ok, d);
  d.times.total_us = watch.microseconds();
}

bool Pipeline::control(double dt) {
  TickData& d = data_;
  gait_.update(dt, d.robot, d.plan, d.toe_off, d.adjustment);
  d.gait = gait_.state();
  const bool sound = layers_.plan(d) & layers_.adjust(d) & layers_.toe_off(d);
  if (!sound) {
    safety_.raise(kFaultLayer);
    return false;
  }
  objectives_.update(dt, d.robot, d.gait, gait_.lift_off(), d.adjustment, d.toe_off, d.objectives);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) d.legs[side] = objectives_.leg(side);
  return layers_.control(d);
}

CommandReply Pipeline::execute(const Command& command) {
  CommandReply reply;
  reply.request = command.request;
  reply.tick = data_.time.tick;
  walking::Refusal refusal;
  const bool needs_control =
      command.type == CommandType::kWalk || command.type == CommandType::kFootsteps ||
      command.type == CommandType::kPause || command.type == CommandType::kResume;
  if (needs_control && !safety_.controlled()) {
    return refused(command, data_.time.tick,
                   safety_.state() == SafetyState::kFault
                       ? "a fault is latched; see `gaitctl status`, then `gaitctl reset` "
                         "and `gaitctl arm`"
                       : "the robot is not standing yet; arm it (`gaitctl arm`) and wait "
                         "until `gaitctl status` says standing");
  }
  const char* why = nullptr;
  switch (command.type) {
    case CommandType::kArm:
      why = data_.robot.valid != 0 && !safety_.upright(data_.robot)
                ? "arm: the robot is not upright; set it on its feet (simulation: `gaitctl sim "
                  "reset`), then arm"
                : safety_.arm();
      break;
    case CommandType::kDisarm:
      why = safety_.disarm();
      break;
    case CommandType::kEstop:
      safety_.raise(kFaultEstop);
      break;
    case CommandType::kReset:
      why = safety_.clear();
      break;
    case CommandType::kMode:
      refusal = gait_.set_mode(command.mode);
      break;
    case CommandType::kWalk:
      refusal = gait_.walk(command.walk);
      break;
    case CommandType::kFootsteps:
      refusal = gait_.footsteps(command.footsteps.data(), command.footstep_count, command.replace);
      break;
    case CommandType::kPause:
      refusal = gait_.pause();
      break;
    case CommandType::kResume:
      refusal = gait_.resume();
      break;
    case CommandType::kStop:
      refusal = gait_.stop();
      safety_.stopping();
      break;
    case CommandType::kAbort:
      refusal = gait_.abort();
      safety_.stopping();
      break;
    default:
      return refused(command, data_.time.tick, "this command is not for the control pipeline");
  }
  if (why != nullptr) return refused(command, data_.time.tick, why);
  if (refusal.refused()) return refused(command, data_.time.tick, refusal.message);
  reply.accepted = true;
  return reply;
}

}  // namespace gaitd::daemon

// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/pipeline.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "daemon/control/command_note.h"
#include "daemon/server/rights.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::daemon {
namespace {

// What a hand may miss without a word.
constexpr double kHandMiss = 0.005;      // m
constexpr double kHandTurnMiss = 0.015;  // rad

CommandReply refused(const Command& command, std::int64_t tick, const char* why) {
  CommandReply reply;
  reply.tick = tick;
  reply.request = command.request;
  std::snprintf(reply.message.data(), reply.message.size(), "%s", why);
  return reply;
}

}  // namespace

Pipeline::Pipeline(const GaitdModel& model, const Calibration& calibration,
                   LayerChain::Layers layers, const GaitdStart& start, LiveParameters* parameters,
                   double period)
    : model_(model),
      start_(start),
      period_(period),
      parameters_(parameters),
      layers_(std::move(layers), model_),
      gait_(model),
      external_(model),
      payload_(model),
      handholds_(model),
      objectives_(model),
      motions_(model),
      safety_(model),
      monitor_(model),
      compensation_(model, calibration) {
  layers_.rules().period = period;
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    layers_.in_use(layer).table = parameters_->table_in_use(layer);
  }
  for (int i = 0; i < parameters_->size(); ++i) {
    const LiveParameters::Row& row = parameters_->row(i);
    if (row.owner >= GAITD_LAYER_COUNT) apply(row.owner, row.index, parameters_->value(i));
  }
  data_.gait = gait_.state();
}

SwapRight Pipeline::swap_right() const {
  const SwapRules& rules = layers_.rules();
  if (rules.simulation) return SwapRight::kAllowed;
  if (!rules.on_hardware) return SwapRight::kNotOnHardware;
  const bool at_rest =
      !safety_.controlled() || (safety_.state() == SafetyState::kStanding && !gait_.walking());
  return at_rest ? SwapRight::kAllowed : SwapRight::kNotAtRest;
}

void Pipeline::begin_swap(const SwapOrder& order) {
  if (const char* why = swap_refusal(swap_right())) return layers_.refuse_swap(order, why);
  // What was set while it was loaded.
  if (order.candidate != nullptr) {
    for (int i = 0; i < parameters_->size(); ++i) {
      const LiveParameters::Row& row = parameters_->row(i);
      if (row.table == order.table) {
        order.candidate->set_parameter(row.index, parameters_->value(i));
      }
    }
  }
  layers_.begin_swap(order, safety_.controlled());
}

bool Pipeline::take_swap_report(SwapReport* report) {
  if (!layers_.take_report(report)) return false;
  // What counts as in use follows the layer that runs.
  const LayerInstance& now = layers_.in_use(report->layer);
  parameters_->use(report->layer, now.table);
  data_.variants[report->layer] = now.variant;
  return true;
}

void Pipeline::reset(bool arm) {
  layers_.reset();
  safety_.reset();
  monitor_.reset();
  compensation_.reset();
  external_.reset();
  payload_.reset();
  handholds_.reset();
  const auto variants = data_.variants;
  data_ = TickData{};
  data_.variants = variants;
  gait_.reset(data_.robot);
  data_.gait = gait_.state();
  if (arm) safety_.arm();
}

void Pipeline::begin_control() {
  gait_.reset(data_.robot);
  motions_.reset();
  data_.gait = gait_.state();
  objectives_.reset(data_.robot, data_.gait);
  layers_.reset_controllers();
}

void Pipeline::run(std::int64_t tick) {
  TickData& d = data_;
  d.time = {tick, static_cast<double>(tick) * period_, period_};
  monitor_.check(period_, safety_.parameters(), d);
  compensation_.sensors(period_, d);
  const bool estimated = layers_.estimate(start_, d);
  d.robot.loads = d.loads;
  update_handholds(period_);
  if (estimated && d.robot.valid != 0) observe_external(period_);
  update_payload(period_);
  safety_.check(d, estimated);
  if (safety_.update(period_, d, gait_.walking())) begin_control();
  if (const SwapRight right = swap_right(); right == SwapRight::kNotAtRest) {
    layers_.give_up_shadows(swap_refusal(right));
  }
  const bool controlled = safety_.controlled();
  const bool ok = controlled && control(period_);
  d.controlled = controlled;
  if (!controlled) {
    layers_.give_up_swaps("the robot is not under control any more");
    d.drive = {};
    d.icp_margin = std::numeric_limits<double>::quiet_NaN();
  }
  safety_.write(period_, ok, d);
  compensation_.commands(period_, d, safety_.torque_ratio());
}

bool Pipeline::control(double dt) {
  TickData& d = data_;
  gait_.update(dt, d.robot, d.plan, d.toe_off, d.adjustment);
  d.gait = gait_.state();
  d.height_offset = gait_.height_offset();
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    d.told[side] = gait_.told(side);
    d.bearing[side] = gait_.contact(side).share();
  }
  const walking::VelocityWalk& drive = gait_.velocity_walk();
  d.icp_margin =
      walking::support_region(model_, d.gait, d.robot).inside_distance(sdk::view(d.robot.icp));
  d.drive = drive.active() ? Drive{true, drive.target(), drive.step().velocity} : Drive{};
  d.motions = motions_.state();
  const bool moved = layers_.source_tasks(d);
  const bool planned = layers_.plan(d);
  walking::shift_plan(d.gait, d.references, d.plan);
  const bool adjusted = layers_.adjust(d);
  const bool rolled = layers_.toe_off(d);  // of the step as it was adjusted
  if (!moved || !planned || !adjusted || !rolled) {
    safety_.raise(kFaultLayer);
    return false;
  }
  objectives_.set_references(d.references);
  objectives_.update(dt, d.robot, d.gait, gait_.lift_off(), d.adjustment, d.toe_off, d.objectives);
  d.clearance = objectives_.clearance();
  for (int side = 0; side < GAITD_MAX_FEET; ++side) d.legs[side] = objectives_.leg(side);
  const bool solved = layers_.control(d);
  layers_.watch_icp_error(
      std::hypot(d.robot.icp[0] - d.plan.icp[0], d.robot.icp[1] - d.plan.icp[1]), dt);
  return solved;
}

CommandReply Pipeline::move(const Command& command) {
  const int hand = command.pose.part - GAITD_PART_LEFT_ARM;
  if (hand >= 0 && handholds_.busy(hand)) {
    return refused(command, data_.time.tick,
                   "pose: this hand holds on to something; `gaitctl handhold release` first");
  }
  const walking::Refusal refusal =
      motions_.command(command.pose, data_.robot, gait_.state(), data_.references);
  if (refusal.refused()) return refused(command, data_.time.tick, refusal.message);
  CommandReply reply;
  reply.request = command.request;
  reply.tick = data_.time.tick;
  reply.accepted = true;
  const walking::JointChain::Miss miss = motions_.last_miss();
  if (miss.position > kHandMiss || miss.turn > kHandTurnMiss) {
    std::snprintf(reply.message.data(), reply.message.size(),
                  "out of reach: the hand will miss by %.3f m and %.3f rad, its arm at its limits",
                  miss.position, miss.turn);
  }
  return reply;
}

CommandReply Pipeline::execute(const Command& command) {
  CommandReply reply;
  reply.request = command.request;
  reply.tick = data_.time.tick;
  walking::Refusal refusal;
  const bool needs_control =
      command.type == CommandType::kWalk || command.type == CommandType::kFootsteps ||
      command.type == CommandType::kPause || command.type == CommandType::kResume ||
      command.type == CommandType::kPose || command.type == CommandType::kGoto ||
      command.type == CommandType::kHandhold ||
      (command.type == CommandType::kDrive && !command.drive.ends);
  const char* why = needs_control ? safety_.refusal(kRequestWalk, data_) : nullptr;
  if (why != nullptr) return refused(command, data_.time.tick, why);
  const bool steps = command.type == CommandType::kWalk ||
                     command.type == CommandType::kFootsteps ||
                     command.type == CommandType::kGoto ||
                     (command.type == CommandType::kResume && gait_.state().footstep_count > 0) ||
                     (command.type == CommandType::kDrive && !command.drive.ends);
  if (steps && handholds_.busy()) {
    return refused(command, data_.time.tick,
                   "a hand holds on to something, the robot could not leave it; `gaitctl handhold "
                   "release`, then walk");
  }
  if (steps) refusal = too_weak_to_walk();
  if (refusal.refused()) return refused(command, data_.time.tick, refusal.message);
  const char* note = command_note(command, safety_.state(), gait_.state());
  switch (command.type) {
    case CommandType::kArm:
      why = safety_.arm(data_);
      break;
    case CommandType::kDisarm:
      why = safety_.disarm();
      break;
    case CommandType::kEstop:
      safety_.raise(kFaultEstop);
      break;
    case CommandType::kReset:
      if (safety_.state() == SafetyState::kFault) {
        gait_.reset(data_.robot);  // the walk that the fault has ended
        data_.gait = gait_.state();
      }
      why = safety_.clear();
      break;
    case CommandType::kJointTest:
      why = safety_.test_joint(data_, command.joint_test);
      break;
    case CommandType::kMode:
      refusal = gait_.set_mode(command.mode);
      break;
    case CommandType::kWalk:
      refusal = gait_.walk(command.walk);
      break;
    case CommandType::kDrive:
      if (command.drive.ends) {
        const bool drives =
            gait_.velocity_walk().why_not(command.drive.session) == walking::RefusalReason::kNone;
        if (!safety_.controlled() || !drives) {
          note = "nothing to end: this session does not drive";
          break;
        }
      }
      refusal = gait_.drive(command.drive);
      if (gait_.velocity_walk().limit().refused()) note = gait_.velocity_walk().limit().message;
      break;
    case CommandType::kFootsteps:
      refusal = gait_.footsteps(command.footsteps.data(), command.footstep_count, command.replace,
                                command.routed);
      break;
    case CommandType::kRefine:
      refusal = gait_.refine(command.footsteps.data(), command.footstep_count);
      break;
    case CommandType::kGoto:  // whether it may; the footsteps come as such
      if (gait_.mode() == GAITD_MODE_STAND) {
        why = "goto: the gait mode is stand; choose one to walk in: gaitctl mode walk-bent";
      }
      break;
    case CommandType::kPose:
      return move(command);
    case CommandType::kTare:
      why = tare();
      note = "nobody may touch the robot for the next second at rest";
      break;
    case CommandType::kPayload:
      if (payload_.estimating()) note = "the weighing that went on is given up";
      refusal = payload(command.payload);
      if (command.payload.action == PayloadAction::kEstimate) {
        note = "weighed for four seconds at rest; `gaitctl status` shows the load";
      }
      break;
    case CommandType::kHandhold:
      return handhold(command);
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
    case CommandType::kSetParameter:
      return set_parameter(command);
    default:
      return refused(command, data_.time.tick, "this command is not for the control pipeline");
  }
  if (why != nullptr) return refused(command, data_.time.tick, why);
  if (refusal.refused()) {
    reply = refused(command, data_.time.tick, refusal.message);
    reply.reason = refusal.reason;
    return reply;
  }
  if (command.type == CommandType::kWalk || command.type == CommandType::kFootsteps ||
      (command.type == CommandType::kDrive && !gait_.velocity_walk().idle())) {
    safety_.going_on();
  }
  reply.accepted = true;
  if (note != nullptr) std::snprintf(reply.message.data(), reply.message.size(), "%s", note);
  return reply;
}

}  // namespace gaitd::daemon

// SPDX-License-Identifier: Apache-2.0
// The part of the pipeline that knows what pulls at the robot and what it carries.
#include <cstdio>

#include "daemon/control/pipeline.h"
#include "gaitd/sdk/loads.h"
#include "gaitd/sdk/views.h"

namespace gaitd::daemon {

bool Pipeline::stands() const {
  return safety_.state() == SafetyState::kStanding && !gait_.walking();
}

// Before anything is made of the forces: those of the hands are not of a pull.
void Pipeline::update_handholds(double dt) {
  handholds_.update(dt, safety_.controlled(), data_.gait, data_.wbc.info, data_.robot,
                    data_.dropped);
  for (int side = 0; side < GAITD_MAX_HANDS; ++side) {
    data_.handhold_changes[side] = handholds_.change(side);
  }
}

CommandReply Pipeline::handhold(const Command& command) {
  const walking::HandholdCommand& c = command.handhold;
  walking::Refusal refusal;
  if (c.release) {
    refusal = handholds_.release(c.hand);
  } else if (!stands()) {
    refusal = walking::refuse(
        "handhold.take: a hand holds on while the robot stands; `gaitctl stop`, then again");
  } else if (!external_.sensed()) {
    refusal = walking::refuse(
        "handhold.take: the feet of this robot have no force sensors: the forces on a hand would "
        "be taken for forces on the feet");
  } else if (external_.tare_waits()) {
    refusal = walking::refuse(
        "handhold.take: what pulls at the robot is being tared, and the hand would be a part of "
        "it; again in two seconds");
  } else if (payload_.estimating()) {
    refusal = walking::refuse(
        "handhold.take: what the robot carries is being weighed, and the hand would be a part of "
        "it; again when it is done");
  } else if (handholds_.fails(c.hand, data_.dropped)) {
    refusal = walking::refuse("handhold.take: a joint of this arm has failed and is damped");
  } else {
    refusal = handholds_.take(c, data_.robot);
  }
  CommandReply reply;
  reply.request = command.request;
  reply.tick = data_.time.tick;
  reply.accepted = !refusal.refused();
  if (refusal.refused()) {
    std::snprintf(reply.message.data(), reply.message.size(), "%s", refusal.message);
  } else if (!c.release && handholds_.allowed() < c.force) {
    std::snprintf(reply.message.data(), reply.message.size(),
                  "counted on for %.0f N: the arm bears no more in this posture",
                  handholds_.allowed());
  }
  return reply;
}

const char* Pipeline::tare() {
  if (handholds_.busy()) {
    return "the tare is taken of a robot that touches the ground only; `gaitctl handhold release`, "
           "then try again";
  }
  if (!stands()) {
    return "the tare is taken of a robot that stands; `gaitctl stop`, then try again";
  }
  if (payload_.estimating()) {
    return "a load is being weighed, the tare would swallow it; try again when it is found";
  }
  external_.tare();
  return nullptr;
}

void Pipeline::observe_external(double dt) {
  TickData& d = data_;
  external_.update(dt, safety_.controlled(), d.gait, d.robot);
  const dynamics::Vector6d steady = external_.steady();
  sdk::view(d.external.wrench) = external_.estimate();
  d.external.tared = external_.tared();
  d.external.pulled = external_.pulled();
  sdk::view(d.robot.external_wrench) = steady;
  d.external.load = external_.unknown_load();
  d.external.surplus = external_.surplus();
  d.external.misjudged = external_.misjudged();
  sdk::view(d.robot.icp) +=
      walking::lean(steady, sdk::total_mass(model_, d.robot.loads), model_.gravity, d.gait.omega);
}

// From the next tick on, in all layers.
void Pipeline::update_payload(double dt) {
  PayloadData& p = data_.payload;
  const walking::Payload::Outcome outcome = payload_.update(dt, stands(), external_);
  p.concluded = outcome != walking::Payload::Outcome::kNone;
  if (p.concluded) p.outcome = outcome;
  p.estimating = payload_.estimating();
  p.found = payload_.found();
  sdk::view(p.uncertainty) = payload_.uncertainty();
  data_.loads = payload_.loads();
}

walking::Refusal Pipeline::payload(const PayloadCommand& command) {
  switch (command.action) {
    case PayloadAction::kEstimate:
      if (handholds_.busy()) {
        return walking::refuse(
            "payload.estimate: a hand holds on to something, which would be weighed too; `gaitctl "
            "handhold release`, then again");
      }
      return payload_.estimate(command.load.body, external_, stands());
    case PayloadAction::kClear:
      if (command.load.body < 0) {
        payload_.reset();
        return {};
      }
      [[fallthrough]];
    default:
      return payload_.set(command.load, data_.robot);
  }
}

}  // namespace gaitd::daemon

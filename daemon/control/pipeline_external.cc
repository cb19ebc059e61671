// SPDX-License-Identifier: Apache-2.0
// The part of the pipeline that knows what pulls at the robot and what it carries.
#include "daemon/control/pipeline.h"
#include "gaitd/sdk/loads.h"
#include "gaitd/sdk/views.h"

namespace gaitd::daemon {

bool Pipeline::stands() const {
  return safety_.state() == SafetyState::kStanding && !gait_.walking();
}

const char* Pipeline::tare() {
  if (!stands()) {
    return "the tare is taken of a robot that stands; `gaitctl stop`, then try again";
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

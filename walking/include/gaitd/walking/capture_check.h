// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/abi/types.h"
#include "gaitd/walking/refusal.h"

namespace gaitd::walking {

// A foot never meets the ground exactly when it should, and until it does the ICP runs on. Whether
// a footstep leaves the feet enough time and room to bring it back: over its transfer with both
// feet, and over its swing with the foot that has landed.
class CaptureCheck {
 public:
  explicit CaptureCheck(const GaitdModel& model) : model_(model) {}

  struct Room {
    double error;    // m, of the ICP when that foot lands earlier or later than planned
    double capture;  // m, that the feet can bring back before the next one lands
  };
  // `steps[0]` lands beside a foot that stands on `stance`; the others follow (2 to kAhead, with
  // all durations). Of early and late the one with less room.
  Room room(const GaitdFoothold& stance, const GaitdFootstep* steps, int count,
            double final_transfer, double omega) const;
  // `number` names `steps[1]` in the message, from 1.
  Refusal check(const GaitdFoothold& stance, const GaitdFootstep* steps, int count,
                double final_transfer, double omega, int number) const;

  static constexpr int kAhead = 4;  // footsteps; what comes later moves the ICP of now by nothing

 private:
  const GaitdModel model_;
};

}  // namespace gaitd::walking

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "daemon/control/tick_data.h"
#include "daemon/parameters/safety_parameters.h"

namespace gaitd::daemon {

// Stands between the sensors and the layers: readings that cannot be true are not passed on. In
// their place stands the last one that could, and its age grows, so that a lasting fault becomes a
// stale signal and that the fault `sensors`, while a single spike passes unnoticed.
//
//   no frame, or none that is valid                             silent
//   not finite, out of range, or a jump that nothing explains   the reading is not taken
//   an IMU, or a foot that carries, repeats itself to the bit   frozen
//   a joint repeats itself while it is commanded to move        stuck
class SensorMonitor {
 public:
  enum class Suspicion { kNone = 0, kSilent, kUntrue, kFrozen, kStuck };
  struct Suspect {
    Suspicion suspicion = Suspicion::kNone;
    const char* sensor = "";  // name of the joint, "imu" or a foot
    double age = 0.0;         // s
  };

  explicit SensorMonitor(const GaitdModel& model) : model_(model) {}
  void reset() { *this = SensorMonitor(model_); }

  // Fills d.sensors from d.readings; d.gait and d.commands are those of the tick before.
  void check(double dt, const sdk::Parameters<SafetyParameter>& p, TickData& d);

  // The one that has been wrong for longest.
  const Suspect& suspect() const { return suspect_; }

 private:
  struct History {
    bool known = false;      // a credible reading was there
    double untrue = 0.0;     // s, since the last credible reading
    double unchanged = 0.0;  // s, since the reading changed
    double travel = 0.0;     // rad, that a joint was commanded to move since then
  };

  void note(const char* sensor, Suspicion suspicion, double age);

  GaitdModel model_;
  GaitdSensors last_{};  // raw, of the tick before
  std::array<History, GAITD_MAX_JOINTS> joints_{};
  std::array<History, GAITD_MAX_IMUS> imus_{};
  std::array<History, GAITD_MAX_FEET> feet_{};
  Suspect suspect_;
};

const char* name_of(SensorMonitor::Suspicion suspicion);

}  // namespace gaitd::daemon

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
//
// A reading that repeats itself is suspect only where something shows that it should change: see
// `Evidence`. A joint that balance does not need (balance_joints.h) does not become that fault
// while the robot is under control: it is dropped, which damps its drive and holds its last
// credible position at rest, until the robot is armed again.
class SensorMonitor {
 public:
  enum class Suspicion { kNone = 0, kSilent, kUntrue, kFrozen, kStuck };
  struct Suspect {
    Suspicion suspicion = Suspicion::kNone;
    const char* sensor = "";  // name of the joint, "imu" or a foot
    double age = 0.0;         // s
  };

  explicit SensorMonitor(const GaitdModel& model)
      : model_(model), balance_(balance_joints(model_)) {}
  void reset() { *this = SensorMonitor(model_); }

  // Fills d.sensors and d.dropped from d.readings; d.gait, d.robot, d.safety and d.commands are
  // those of the tick before.
  void check(double dt, const sdk::Parameters<SafetyParameter>& p, TickData& d);

  // The one that has been wrong for longest, of those that can stop the robot.
  const Suspect& suspect() const { return suspect_; }
  // Why a joint of d.dropped was dropped.
  const Suspect& dropped(int joint) const { return dropped_[joint]; }

 private:
  struct History {
    bool known = false;      // a credible reading was there
    double untrue = 0.0;     // s, since the last credible reading
    double unchanged = 0.0;  // s, since the reading changed
    double travel = 0.0;     // rad, that a joint was commanded to move since then
  };
  // What tells, apart from a sensor itself, that its reading should change.
  struct Evidence {
    bool controlled = false;  // the robot balances on its feet
    bool joints = false;      // a joint reads other than in the tick before
    bool imus = false;        // so does an IMU
    // N, that the IMU says something carries; 0: nobody knows.
    double weight = 0.0;
  };

  using Limits = sdk::Parameters<SafetyParameter>;
  Evidence gather(const TickData& d) const;
  void check_joints(double dt, const Limits& p, bool controlled, const GaitdSensors& before,
                    TickData& d);
  void check_imus(double dt, const Limits& p, const Evidence& evidence, const GaitdSensors& before,
                  TickData& d);
  void check_feet(double dt, const Limits& p, const Evidence& evidence, const GaitdSensors& before,
                  TickData& d);
  void note(const Suspect& suspect);

  GaitdModel model_;
  JointMask balance_;
  GaitdSensors last_{};    // raw, of the tick before
  GaitdSensors passed_{};  // what was passed on then
  std::array<History, GAITD_MAX_JOINTS> joints_{};
  std::array<History, GAITD_MAX_IMUS> imus_{};
  std::array<History, GAITD_MAX_FEET> feet_{};
  Suspect suspect_;
  std::array<Suspect, GAITD_MAX_JOINTS> dropped_{};
};

const char* name_of(SensorMonitor::Suspicion suspicion);

// Of a signal that is not valid, or older than `timeout` (s).
inline bool is_stale(const GaitdSignalInfo& info, double timeout) {
  return info.valid == 0 || info.age > timeout;
}

}  // namespace gaitd::daemon

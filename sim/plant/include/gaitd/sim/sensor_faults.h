// SPDX-License-Identifier: Apache-2.0
// Sensors that fail: what a reading becomes while one of them does.
#ifndef GAITD_SIM_SENSOR_FAULTS_H_
#define GAITD_SIM_SENSOR_FAULTS_H_

#include <optional>
#include <string>
#include <vector>

#include "gaitd/abi/types.h"

namespace gaitd::sim {

struct SensorFault {
  enum class Sensor { kJoint, kImu, kFoot };
  enum class Kind {
    kFreeze,  // new frames with the reading of the beginning
    kNan,     // not a number
    kSpike,   // far off
    kDead,    // zero
    kSilent,  // no new frames: the last reading grows old
  };
  Sensor sensor = Sensor::kImu;
  int index = 0;  // of the joint or the foot
  Kind kind = Kind::kFreeze;
  double from = 0;      // s
  double duration = 0;  // s
};

// Names of the kinds, in their order.
inline constexpr const char* kSensorFaultKinds[] = {"freeze", "nan", "spike", "dead", "silent"};

// The sensor called `name`: a joint, "imu", "left_foot" or "right_foot". False: there is none.
bool find_sensor(const GaitdModel& model, const std::string& name, SensorFault* fault);

class SensorFaults {
 public:
  explicit SensorFaults(const std::vector<SensorFault>& faults)
      : faults_(faults), held_(faults.size()) {}
  void reset() { held_.assign(faults_.size(), std::nullopt); }
  // Damages what is read at `time` (s).
  void apply(double time, GaitdSensors* sensors);

 private:
  std::vector<SensorFault> faults_;
  std::vector<std::optional<GaitdSensors>> held_;  // as each fault began
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_SENSOR_FAULTS_H_

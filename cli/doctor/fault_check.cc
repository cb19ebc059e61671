// SPDX-License-Identifier: Apache-2.0
#include "cli/doctor/log_checks.h"
#include "daemon/control/tick_data.h"

namespace gaitd::doctor {
namespace {

// The first sensor that is not to be trusted in that tick.
std::string bad_sensor(const LogCase& log, std::size_t tick) {
  const GaitdModel* model = log.model();
  const double timeout = log.setting("safety.sensor_timeout", 0.02);
  auto cursor = log.log().sensors();
  GaitdSensors sensors{};
  for (std::size_t i = 0; i <= tick; ++i) {
    if (!cursor.next(&sensors)) return "";
  }
  const auto bad = [&](const GaitdSignalInfo& info) {
    return info.valid == 0 || info.age > timeout;
  };
  const auto text = [](const std::string& name, const GaitdSignalInfo& info) {
    return name + (info.valid == 0 ? std::string(" gave no valid value")
                                   : format(" was %.0f ms old", 1e3 * info.age));
  };
  for (int i = 0; i < sensors.imu_count; ++i) {
    if (bad(sensors.imus[i].info)) {
      return text(model == nullptr ? "an IMU" : model->imus[i].name, sensors.imus[i].info);
    }
  }
  for (int i = 0; i < sensors.joint_count; ++i) {
    if (bad(sensors.joints[i].info)) {
      return text(model == nullptr ? "a joint" : model->joints[i].name, sensors.joints[i].info);
    }
  }
  for (int i = 0; i < sensors.foot_count; ++i) {
    if (bad(sensors.feet[i].info)) {
      return text(std::string("the force sensor of the ") + daemon::kSides[i] + " foot",
                  sensors.feet[i].info);
    }
  }
  return "";
}

}  // namespace

// A fall, a tilt and a lost capture point are consequences; an overrun and the solver have checks
// of their own.
Findings check_faults(const LogCase& log) {
  Findings findings;
  const auto add = [&](const char* check, const std::string& what, const std::string& advice) {
    findings.push_back(log_finding(log, check, log.end(), what, advice));
  };
  const std::uint32_t faults = log.faults();
  if (log.end() >= log.run().ticks()) return {};
  if ((faults & daemon::kFaultEstop) != 0) {
    add("estop", "somebody stopped the robot (estop)", "`gaitctl reset`, then `gaitctl arm`");
  }
  if ((faults & daemon::kFaultMotor) != 0) {
    add("motor", "a motor reported an error or stopped answering (motor)",
        "what gaitd printed names it: its temperature, its supply, its cable; `gaitctl status`");
  }
  if ((faults & daemon::kFaultBus) != 0) {
    add("bus", "the link to the robot failed (bus)",
        "what gaitd printed names it; plugs and termination of the bus, the network; "
        "`gaitctl doctor` looks at the CAN interfaces");
  }
  if ((faults & daemon::kFaultHeartbeat) != 0) {
    add("heartbeat", "the e-stop fell silent (heartbeat)",
        "batteries and reach of its sender, the cable of its receiver");
  }
  if ((faults & daemon::kFaultSensors) != 0) {
    const std::string which = bad_sensor(log, log.end());
    add("sensors",
        "the sensors could not be trusted any more" + (which.empty() ? "" : ": " + which),
        format("cable, driver and rate of that sensor; safety.sensor_timeout (%g s)",
               log.setting("safety.sensor_timeout", 0.02)));
  }
  if ((faults & daemon::kFaultEstimator) != 0) {
    add("estimator", "the state estimator gave no usable state",
        "the event in `gaitctl log info` names the field; state_estimator.variant");
  }
  if ((faults & daemon::kFaultLayer) != 0) {
    add("layer", "a control layer failed",
        "the event in `gaitctl log info` names layer and field; `gaitctl plugin check` its file");
  }
  if ((faults & daemon::kFaultBackend) != 0) {
    add("backend", "the backend failed: no link to the drives, or a simulation that diverged",
        "what gaitd printed; `gaitctl doctor` looks at the CAN interfaces");
  }
  if ((faults & daemon::kFaultReadying) != 0) {
    add("readying", "the robot did not come into its standing posture, or a foot carries nothing",
        "safety.ready_stiffness, safety.ready_tolerance; the zeros of the "
        "joints");
  }
  return findings;
}

}  // namespace gaitd::doctor

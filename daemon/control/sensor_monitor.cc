// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/sensor_monitor.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gaitd::daemon {
namespace {

using P = SafetyParameter;
using Limits = sdk::Parameters<SafetyParameter>;

// Encoder noise and play, on top of what the fastest joint can do between two readings (rad).
constexpr double kJointPlay = 0.05;
constexpr double kLongestBounce = 0.15;  // s
constexpr double kLongestHover = 0.05;   // s, of a soft landing just above the ground
constexpr double kRestingSpeed = 0.03;   // m/s, of a foot on the ground
// Joints are overtaken by impacts; only this multiple of the limit is impossible.
constexpr double kVelocityRatio = 3.0;

template <std::size_t kSize>
bool finite(const double (&values)[kSize]) {
  return std::all_of(values, values + kSize, [](double v) { return std::isfinite(v); });
}

template <std::size_t kSize>
bool within(const double (&values)[kSize], double limit) {
  return std::all_of(values, values + kSize, [&](double v) { return std::abs(v) <= limit; });
}

template <std::size_t kSize>
bool near(const double (&now)[kSize], const double (&last)[kSize], double limit) {
  for (std::size_t i = 0; i < kSize; ++i) {
    if (std::abs(now[i] - last[i]) > limit) return false;
  }
  return true;
}

template <std::size_t kSize>
bool same(const double (&a)[kSize], const double (&b)[kSize]) {
  return std::memcmp(a, b, sizeof(a)) == 0;
}

}  // namespace

const char* name_of(SensorMonitor::Suspicion suspicion) {
  switch (suspicion) {
    case SensorMonitor::Suspicion::kUntrue:
      return "not credible";
    case SensorMonitor::Suspicion::kFrozen:
      return "frozen";
    case SensorMonitor::Suspicion::kStuck:
      return "stuck";
    case SensorMonitor::Suspicion::kSilent:
      return "silent";
    default:
      return "sound";
  }
}

void SensorMonitor::note(const char* sensor, Suspicion suspicion, double age) {
  if (age > suspect_.age) suspect_ = {suspicion, sensor, age};
}

void SensorMonitor::check(double dt, const Limits& p, TickData& d) {
  suspect_ = {};
  const GaitdSensors& now = d.readings;
  const GaitdSensors before = d.sensors;
  d.sensors = now;
  // Passes on `reading` or keeps `held`.
  const auto pass = [&](History& h, bool credible, double repeated, Suspicion repeats,
                        const auto& held, auto& reading, const char* sensor) {
    h.untrue = credible ? 0.0 : h.untrue + dt;
    h.known = h.known || credible;
    if (credible) {
      if (reading.info.valid == 0 || reading.info.age > p[P::kSensorTimeout]) {
        note(sensor, Suspicion::kSilent, std::max(reading.info.age, dt));
      }
      reading.info.age += repeated;
      if (repeated > 0.0) note(sensor, repeats, repeated);
      return;
    }
    note(sensor, Suspicion::kUntrue, h.untrue);
    const GaitdSignalInfo info = reading.info;
    reading = held;
    reading.info = info;
    reading.info.age = std::max(info.age, 0.0) + h.untrue;
    if (!h.known) reading.info.valid = 0;
  };
  // How long the reading has repeated itself: new frames with the old content.
  const auto count_repeats = [&](History& h, const GaitdSignalInfo& info,
                                 const GaitdSignalInfo& last, bool repeats) {
    if (!repeats) {
      h.unchanged = 0.0;
    } else if (info.sequence != last.sequence) {
      h.unchanged += dt;
    }
  };

  for (int i = 0; i < now.joint_count; ++i) {
    const GaitdJointSensor& joint = now.joints[i];
    const GaitdJointSensor& held = before.joints[i];
    History& h = joints_[i];
    const double limit = kVelocityRatio * model_.joints[i].velocity_limit;
    const bool credible = std::isfinite(joint.position) && std::isfinite(joint.velocity) &&
                          std::isfinite(joint.torque) && std::abs(joint.velocity) <= limit &&
                          (!h.known || std::abs(joint.position - held.position) <=
                                           kJointPlay + limit * (h.untrue + dt));
    const bool repeats = joint.position == last_.joints[i].position;
    const bool moving = d.gait.phase != GAITD_PHASE_STAND;
    h.travel = repeats && moving ? h.travel + dt * std::abs(d.commands.joints[i].velocity) : 0.0;
    count_repeats(h, joint.info, last_.joints[i].info, repeats && moving);
    const bool stuck = p[P::kStuckTravel] > 0.0 && h.travel > p[P::kStuckTravel];
    pass(h, credible, stuck ? h.unchanged : 0.0, Suspicion::kStuck, held, d.sensors.joints[i],
         model_.joints[i].name);
  }
  const double frozen_time = p[P::kFrozenTime];
  const auto frozen = [&](const History& h) {
    return frozen_time > 0.0 && h.unchanged > frozen_time ? h.unchanged : 0.0;
  };
  for (int i = 0; i < now.imu_count; ++i) {
    const GaitdImuSensor& imu = now.imus[i];
    const GaitdImuSensor& held = before.imus[i];
    History& h = imus_[i];
    const double missed = 1.0 + h.untrue / dt;
    const bool credible =
        finite(imu.angular_rate) && finite(imu.specific_force) && finite(imu.orientation) &&
        (!h.known ||
         (near(imu.angular_rate, held.angular_rate, missed * p[P::kGyroJump]) &&
          near(imu.specific_force, held.specific_force, missed * p[P::kAccelerometerJump])));
    count_repeats(h, imu.info, last_.imus[i].info,
                  same(imu.angular_rate, last_.imus[i].angular_rate) &&
                      same(imu.specific_force, last_.imus[i].specific_force));
    pass(h, credible, frozen(h), Suspicion::kFrozen, held, d.sensors.imus[i], "imu");
  }
  for (int side = 0; side < now.foot_count; ++side) {
    const GaitdFootForceSensor& foot = now.feet[side];
    History& h = feet_[side];
    const double most = p[P::kForceRange] * model_.total_mass * model_.gravity;
    const bool credible = finite(foot.force) && finite(foot.moment) && within(foot.force, most);
    // Overdue and not moving down any more: on the ground, whatever the sensor says.
    const bool rests = d.gait.late_contact != 0 && d.gait.next_side == side &&
                       std::abs(d.robot.feet[side].twist[5]) < kRestingSpeed;
    const bool carries = rests || d.gait.footholds[side].contact != GAITD_CONTACT_NONE;
    const bool zero = foot.force[0] == 0.0 && foot.force[1] == 0.0 && foot.force[2] == 0.0;
    count_repeats(h, foot.info, last_.feet[side].info,
                  same(foot.force, last_.feet[side].force) && (carries || !zero));
    // A foot that bounces or hovers carries nothing for a while.
    const bool in_air = zero && h.unchanged < (rests ? kLongestHover : kLongestBounce);
    pass(h, credible, in_air ? 0.0 : frozen(h), Suspicion::kFrozen, before.feet[side],
         d.sensors.feet[side], side == GAITD_LEFT ? "left foot force" : "right foot force");
  }
  last_ = now;
}

}  // namespace gaitd::daemon

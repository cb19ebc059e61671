// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/sensor_monitor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "gaitd/sdk/sensors.h"

namespace gaitd::daemon {
namespace {

using P = SafetyParameter;
using Suspicion = SensorMonitor::Suspicion;
using Suspect = SensorMonitor::Suspect;

// Encoder noise and play, on top of what the fastest joint can do between two readings (rad).
constexpr double kJointPlay = 0.05;
constexpr double kLongestBounce = 0.15;  // s
constexpr double kLongestHover = 0.05;   // s, of a soft landing just above the ground
constexpr double kRestingSpeed = 0.03;   // m/s, of a foot on the ground
// Joints are overtaken by impacts; only this multiple of the limit is impossible, and of a slow
// joint no less than what a light limb reaches when it is thrown about.
constexpr double kVelocityRatio = 3.0;
// In a tick: more is a wrong reading, and no blow. The tolerance grows only once a lasting fault
// has been told: the reading would become credible before.
constexpr double kGyroJump = 10.0;            // rad/s
constexpr double kAccelerometerJump = 200.0;  // m/s^2
constexpr double kForceRange = 20.0;          // weights, on a foot
constexpr double kFastestTurn = 30.0;         // rad/s
constexpr double kFastestSlide = 3.0;         // m/s
// Of the weight, that the IMU feels and the other foot does not show: this one must carry it.
constexpr double kMissingWeight = 0.25;

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

// To the bit: a reading that is no number repeats itself too.
template <std::size_t kSize>
bool same(const double (&a)[kSize], const double (&b)[kSize]) {
  return std::equal(a, a + kSize, b, [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

bool is_zero(const double (&force)[3]) {
  return force[0] == 0.0 && force[1] == 0.0 && force[2] == 0.0;
}

bool same(const GaitdJointSensor& a, const GaitdJointSensor& b) {
  return a.position == b.position && a.velocity == b.velocity && a.torque == b.torque;
}

bool same(const GaitdImuSensor& a, const GaitdImuSensor& b) {
  return same(a.angular_rate, b.angular_rate) && same(a.specific_force, b.specific_force);
}

double fastest(const GaitdJoint& joint) {
  const double floor = joint.type == GAITD_JOINT_PRISMATIC ? kFastestSlide : kFastestTurn;
  return std::max(kVelocityRatio * joint.velocity_limit, floor);
}

// Passes on `reading` or keeps `held`. `repeated`: s, for which it has repeated itself and should
// not have. What is wrong with it, if anything.
template <class History, class Sensor>
Suspect pass(double dt, double timeout, const char* name, History& h, bool credible,
             double repeated, Suspicion repeats, const Sensor& held, Sensor& reading) {
  h.untrue = credible ? 0.0 : h.untrue + dt;
  h.known = h.known || credible;
  if (!credible) {
    const GaitdSignalInfo info = reading.info;
    reading = held;
    reading.info = info;
    reading.info.age = std::max(info.age, 0.0) + h.untrue;
    if (!h.known) reading.info.valid = 0;
    return {Suspicion::kUntrue, name, h.untrue};
  }
  Suspect suspect;
  if (is_stale(reading.info, timeout)) {
    suspect = {Suspicion::kSilent, name, std::max(reading.info.age, dt)};
  }
  reading.info.age += repeated;
  return repeated > suspect.age ? Suspect{repeats, name, repeated} : suspect;
}

// s, of `unchanged`, if that is longer than a reading may repeat itself.
double frozen(const sdk::Parameters<P>& p, double unchanged) {
  return p[P::kFrozenTime] > 0.0 && unchanged > p[P::kFrozenTime] ? unchanged : 0.0;
}

// Who reads them takes the first that is valid: an old one is not, where there is a better one.
// Where there is none, it goes on until its age becomes the fault.
void leave_old_imus(double timeout, GaitdSensors& s) {
  const auto old = [&](const GaitdImuSensor& imu) { return is_stale(imu.info, timeout); };
  if (std::all_of(s.imus, s.imus + s.imu_count, old)) return;
  for (int i = 0; i < s.imu_count; ++i) {
    if (old(s.imus[i])) s.imus[i].info.valid = 0;
  }
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

void SensorMonitor::note(const Suspect& suspect) {
  if (suspect.age > suspect_.age) suspect_ = suspect;
}

void SensorMonitor::check(double dt, const Limits& p, TickData& d) {
  suspect_ = {};
  const GaitdSensors& before = passed_;
  d.sensors = d.readings;
  Evidence evidence = gather(d);
  check_joints(dt, p, evidence.controlled, before, d);
  check_imus(dt, p, evidence, before, d);
  leave_old_imus(p[P::kSensorTimeout], d.sensors);
  if (const int imu = sdk::first_usable_imu(model_, d.sensors); imu >= 0) {
    evidence.weight = model_.total_mass * sdk::view(d.sensors.imus[imu].specific_force).norm();
  }
  check_feet(dt, p, evidence, before, d);
  last_ = d.readings;
  passed_ = d.sensors;
}

SensorMonitor::Evidence SensorMonitor::gather(const TickData& d) const {
  const GaitdSensors& now = d.readings;
  Evidence evidence;
  evidence.controlled = d.safety == SafetyState::kStanding || d.safety == SafetyState::kWalking ||
                        d.safety == SafetyState::kStopping;
  for (int i = 0; i < now.joint_count; ++i) {
    evidence.joints = evidence.joints || !same(now.joints[i], last_.joints[i]);
  }
  for (int i = 0; i < now.imu_count; ++i) {
    evidence.imus = evidence.imus || !same(now.imus[i], last_.imus[i]);
  }
  return evidence;
}

void SensorMonitor::check_joints(double dt, const Limits& p, bool controlled,
                                 const GaitdSensors& before, TickData& d) {
  if (!controlled) d.dropped = 0;
  for (int i = 0; i < d.readings.joint_count; ++i) {
    const JointMask bit = JointMask{1} << i;
    const GaitdJointSensor& joint = d.readings.joints[i];
    const GaitdJointSensor& held = before.joints[i];
    History& h = joints_[i];
    const double limit = fastest(model_.joints[i]);
    const bool credible = std::isfinite(joint.position) && std::isfinite(joint.velocity) &&
                          std::isfinite(joint.torque) && std::abs(joint.velocity) <= limit &&
                          (!h.known || std::abs(joint.position - held.position) <=
                                           kJointPlay + limit * (h.untrue + dt));
    const bool moving = d.gait.phase != GAITD_PHASE_STAND;
    const bool repeats = moving && joint.position == last_.joints[i].position;
    h.travel = repeats ? h.travel + dt * std::abs(d.commands.joints[i].velocity) : 0.0;
    const bool fresh = joint.info.sequence != last_.joints[i].info.sequence;
    h.unchanged = repeats ? h.unchanged + (fresh ? dt : 0.0) : 0.0;
    const bool stuck = p[P::kStuckTravel] > 0.0 && h.travel > p[P::kStuckTravel];
    GaitdJointSensor& passed = d.sensors.joints[i];
    const Suspect suspect = pass(dt, p[P::kSensorTimeout], model_.joints[i].name, h, credible,
                                 stuck ? h.unchanged : 0.0, Suspicion::kStuck, held, passed);
    if (!controlled || (balance_ & bit) != 0) {
      note(suspect);
      continue;
    }
    const bool lasting = is_stale(passed.info, p[P::kSensorTimeout]);
    if (lasting && (d.dropped & bit) == 0) {
      d.dropped |= bit;
      dropped_[i] = suspect;
    }
    if ((d.dropped & bit) != 0 && suspect.suspicion != Suspicion::kNone) {
      passed.position = held.position;
      passed.velocity = 0.0;
      passed.info.valid = 1;  // something to compute with, in place of what each layer would hold
    }
  }
}

void SensorMonitor::check_imus(double dt, const Limits& p, const Evidence& evidence,
                               const GaitdSensors& before, TickData& d) {
  for (int i = 0; i < d.readings.imu_count; ++i) {
    const GaitdImuSensor& imu = d.readings.imus[i];
    const GaitdImuSensor& held = before.imus[i];
    History& h = imus_[i];
    const double timeout = std::max(p[P::kSensorTimeout], dt);
    const double missed = std::max(1.0, h.untrue / timeout);
    const bool credible =
        finite(imu.angular_rate) && finite(imu.specific_force) && finite(imu.orientation) &&
        (!h.known || (near(imu.angular_rate, held.angular_rate, missed * kGyroJump) &&
                      near(imu.specific_force, held.specific_force, missed * kAccelerometerJump)));
    const bool fresh = imu.info.sequence != last_.imus[i].info.sequence;
    const bool repeats = same(imu, last_.imus[i]) && (evidence.controlled || evidence.joints);
    h.unchanged = repeats ? h.unchanged + (fresh ? dt : 0.0) : 0.0;
    note(pass(dt, p[P::kSensorTimeout], "imu", h, credible, frozen(p, h.unchanged),
              Suspicion::kFrozen, held, d.sensors.imus[i]));
  }
}

void SensorMonitor::check_feet(double dt, const Limits& p, const Evidence& evidence,
                               const GaitdSensors& before, TickData& d) {
  const double weight = model_.total_mass * model_.gravity;
  for (int side = 0; side < d.readings.foot_count; ++side) {
    const GaitdFootForceSensor& foot = d.readings.feet[side];
    History& h = feet_[side];
    const bool credible =
        finite(foot.force) && finite(foot.moment) && within(foot.force, kForceRange * weight);
    // Overdue and not moving down any more: on the ground, whatever the sensor says.
    const bool rests = d.gait.late_contact != 0 && d.gait.next_side == side &&
                       std::abs(d.robot.feet[side].twist[5]) < kRestingSpeed;
    const bool carries = rests || d.gait.footholds[side].contact != GAITD_CONTACT_NONE;
    const bool zero = is_zero(foot.force);
    // Zero is what a foot in the air shows, and in a fall the gait does not know that it is there:
    // the sensor is dead only if the weight is not on the other foot either.
    const double other = sdk::view(d.readings.feet[1 - side].force).norm();
    const bool loaded =
        evidence.controlled && carries && evidence.weight - other > kMissingWeight * weight;
    const bool moved = evidence.controlled || evidence.joints || evidence.imus;
    const bool fresh = foot.info.sequence != last_.feet[side].info.sequence;
    if (!same(foot.force, last_.feet[side].force) || (zero ? !carries : !moved)) {
      h.unchanged = 0.0;
    } else if (fresh) {
      h.unchanged = std::max(0.0, h.unchanged + (zero && !loaded ? -dt : dt));
    }
    // A foot that bounces or hovers carries nothing for a while.
    const bool in_air = zero && h.unchanged < (rests ? kLongestHover : kLongestBounce);
    note(pass(dt, p[P::kSensorTimeout], side == GAITD_LEFT ? "left foot force" : "right foot force",
              h, credible, in_air ? 0.0 : frozen(p, h.unchanged), Suspicion::kFrozen,
              before.feet[side], d.sensors.feet[side]));
  }
}

}  // namespace gaitd::daemon

// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "cli/doctor/log_checks.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/sdk/imu_place.h"
#include "gaitd/sdk/views.h"

namespace gaitd::doctor {
namespace {

constexpr double kRate = 0.06;           // rad/s, gyro against legs, standing
constexpr double kWalkRate = 0.15;       // rad/s, the same in a walk, where feet roll and slip
constexpr double kTilt = 0.06;           // rad, estimate against gravity or truth
constexpr double kVelocity = 0.25;       // m/s, estimate against truth
constexpr double kAverage = 0.05;        // s, standing
constexpr double kWalkAverage = 0.8;     // s
constexpr double kLeastEstimate = 0.05;  // s
constexpr double kLoad = 0.4;            // of the weight, of a foot that does not move

// Mean over the last `duration` seconds (of samples one `period` apart).
class Average {
 public:
  Average(double period, double duration)
      : gain_(std::min(1.0, period / duration)), period_(period), duration_(duration) {}
  void add(const Eigen::Vector3d& sample) {
    value_ += gain_ * (sample - value_);
    seconds_ += period_;
  }
  void clear() {
    value_.setZero();
    seconds_ = 0.0;
  }
  bool settled() const { return seconds_ > 2.0 * duration_; }
  const Eigen::Vector3d& value() const { return value_; }

 private:
  double gain_;
  double period_;
  double duration_;
  double seconds_ = 0.0;
  Eigen::Vector3d value_ = Eigen::Vector3d::Zero();
};

// The rate of the pelvis by the joints of a leg whose foot stands still, pelvis axes.
class LegRate {
 public:
  explicit LegRate(const GaitdModel& model)
      : kinematics_(model), model_(model), q_(model.joint_count), qd_(model.joint_count) {}
  Eigen::Vector3d operator()(const GaitdSensors& sensors, int side) {
    for (int i = 0; i < model_.joint_count; ++i) {
      q_[i] = sensors.joints[i].position;
      qd_[i] = sensors.joints[i].velocity;
    }
    kinematics_.update(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity(),
                       dynamics::Vector6d::Zero(), q_, qd_);
    return -kinematics_.body_twist(model_.feet[side].body).head<3>();
  }

 private:
  dynamics::Kinematics kinematics_;
  const GaitdModel& model_;
  Eigen::VectorXd q_, qd_;
};

struct Disagreement {
  std::vector<bool> rate, gravity;
  std::vector<double> rate_size, gravity_size;
};

Disagreement compare_imu(const LogCase& log, const GaitdModel& model) {
  const std::size_t ticks = log.end();
  Disagreement d{std::vector<bool>(ticks), std::vector<bool>(ticks), std::vector<double>(ticks),
                 std::vector<double>(ticks)};
  const daemon::Column* force[] = {log.find("foot/left/force/z"), log.find("foot/right/force/z")};
  const daemon::Column* roll = log.find("pelvis/roll");
  const daemon::Column* pitch = log.find("pelvis/pitch");
  const daemon::Column* toe = log.find("toe_off/active");
  if (force[0] == nullptr || force[1] == nullptr || roll == nullptr || pitch == nullptr ||
      toe == nullptr || model.imu_count == 0) {
    return d;
  }
  const double weight = model.total_mass * model.gravity;
  LegRate leg_rate(model);
  Average rate(log.period(), kAverage);
  Average walk_rate(log.period(), kWalkAverage);
  Average up(log.period(), 4.0 * kAverage);
  auto cursor = log.log().sensors();
  GaitdSensors sensors{};
  std::array<double, GAITD_MAX_JOINTS> q{}, qd{};
  for (std::size_t i = 0; i < ticks && cursor.next(&sensors); ++i) {
    if (sensors.imu_count == 0) continue;
    for (int j = 0; j < model.joint_count; ++j) {
      q[static_cast<std::size_t>(j)] = sensors.joints[j].position;
      qd[static_cast<std::size_t>(j)] = sensors.joints[j].velocity;
    }
    const sdk::ImuPlace place = sdk::imu_place(model, 0, q.data(), qd.data());
    // Also before the controller has the joints.
    const daemon::Phase phase = log.run().phase()[i];
    const bool standing = phase == daemon::Phase::kStand || phase == daemon::Phase::kUnknown;
    const GaitdImuSensor& measured = sensors.imus[0];
    const int side = (*force[0])[i] > (*force[1])[i] ? 0 : 1;
    if ((*force[side])[i] > kLoad * weight && (*toe)[i] == 0.0) {
      const Eigen::Vector3d gyro =
          place.orientation * Eigen::Vector3d(sdk::view(measured.angular_rate)) - place.rate;
      Average& average = standing ? rate : walk_rate;
      average.add(gyro - leg_rate(sensors, side));
      d.rate_size[i] = average.value().norm();
      d.rate[i] = average.settled() && d.rate_size[i] > (standing ? kRate : kWalkRate);
    }
    if (!standing || !log.controlled(i)) {
      up.clear();
      if (!standing) rate.clear();
      continue;
    }
    const Eigen::Matrix3d R_WP = (Eigen::AngleAxisd((*pitch)[i], Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd((*roll)[i], Eigen::Vector3d::UnitX()))
                                     .toRotationMatrix();
    up.add(R_WP * (place.orientation * Eigen::Vector3d(sdk::view(measured.specific_force))));
    d.gravity_size[i] = std::atan2(up.value().head<2>().norm(), up.value().z());
    d.gravity[i] = up.settled() && d.gravity_size[i] > kTilt;
  }
  return d;
}

double largest(const std::vector<double>& values, const Episode& episode) {
  return *std::max_element(values.begin() + static_cast<long>(episode.begin),
                           values.begin() + static_cast<long>(episode.end));
}

}  // namespace

Findings check_estimate(const LogCase& log) {
  Findings findings;
  if (const GaitdModel* model = log.model()) {
    const Disagreement d = compare_imu(log, *model);
    if (const auto episode = last_episode(log, d.rate, kLeastEstimate)) {
      findings.push_back(log_finding(
          log, "estimate", episode->begin,
          format("gyro and leg joints disagree about the turning of the pelvis, by up to %.2f "
                 "rad/s on average",
                 largest(d.rate_size, *episode)),
          "bias and mounting of the IMU (imus in robot.yaml), signs of the leg joints; "
          "state_estimator.variant=invariant_ekf estimates the bias"));
    }
    if (const auto episode = last_episode(log, d.gravity, kLeastEstimate)) {
      findings.push_back(log_finding(
          log, "estimate", episode->begin,
          format("standing, the estimated vertical is %.2f rad off the one of the accelerometer",
                 largest(d.gravity_size, *episode)),
          "mounting of the IMU (imus: rpy in robot.yaml), its biases"));
    }
  }
  std::vector<bool> wrong(log.run().ticks());
  for (const auto& [name, bound] :
       {std::pair{"velocity", kVelocity}, {"roll", kTilt}, {"pitch", kTilt}}) {
    const daemon::Column* error = log.find(std::string("truth/estimate_error/") + name);
    for (std::size_t i = 0; error != nullptr && i < wrong.size(); ++i) {
      wrong[i] = wrong[i] || (log.controlled(i) && std::abs((*error)[i]) > bound);
    }
  }
  if (const auto episode = last_episode(log, wrong, kLeastEstimate)) {
    findings.push_back(log_finding(
        log, "estimate", episode->begin,
        format("the estimated pelvis was off the true one by more than %g rad or %g m/s", kTilt,
               kVelocity),
        "sensors of the scenario, state_estimator.*"));
  }
  return findings;
}

}  // namespace gaitd::doctor

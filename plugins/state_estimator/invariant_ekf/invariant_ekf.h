// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "foot_trust.h"
#include "gaitd/dynamics/foot_wrenches.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/sdk/imu_place.h"
#include "gaitd/sdk/layer.h"
#include "gaitd/sdk/sensors.h"
#include "gaitd/sdk/views.h"
#include "right_invariant_filter.h"

namespace gaitd::plugins {

// Contact-aided invariant EKF from IMU, encoders and foot forces.
//
// The filter follows the first usable IMU, so that no acceleration has to be moved to the pelvis by
// differentiating the gyroscope. A loaded foot gives it two points, the middles of the front and of
// the back edge of its sole: together they hold the heading too. They may move more freely up and
// down than sideways, so that a foot that gives way under its load does not pitch the robot. A foot
// that has just landed or is on its toe has the front point only.
//
// On average the contact forces pass through the CoM: the direction from the CoP to the CoM of the
// model is that of the specific force, without the bias of the accelerometer.
class InvariantEkf {
 public:
  enum class P {
    kContactOn,
    kForceFilter,
    kJointPole,
    kGyroNoise,
    kAccelerometerNoise,
    kGyroBiasNoise,
    kAccelerometerBiasNoise,
    kContactNoise,
    kCount
  };
  static constexpr std::array<GaitdParameter, 8> kParameters = {
      kContactOnParameter,
      kForceFilterParameter,
      sdk::porting(sdk::real_parameter(
          "joint_pole", "1/s", 50, 2000, 300,
          "low-passes of joint rates and pelvis twist; low: they lag, high: noise")),
      sdk::porting(sdk::real_parameter(
          "gyro_noise", "rad/s/sqrtHz", 0, 1, 3e-4,
          "density; low: feet that slip turn the robot less, high: they turn it")),
      sdk::porting(sdk::real_parameter(
          "accelerometer_noise", "m/s^2/sqrtHz", 0, 10, 0.01,
          "density; low: a wrong tilt stays, high: velocity follows the encoders")),
      sdk::porting(sdk::real_parameter(
          "gyro_bias_noise", "rad/s^2/sqrtHz", 0, 1, 2e-5,
          "random walk; low: a drifting bias stays, high: a walk is taken for one")),
      sdk::porting(sdk::real_parameter("accelerometer_bias_noise", "m/s^3/sqrtHz", 0, 1, 5e-4,
                                       "random walk, with foot sensors only; low: a drifting bias "
                                       "stays, high: a push is taken for one")),
      sdk::real_parameter(
          "contact_noise", "m/s/sqrtHz", 0, 4, 0.004,
          "random walk of a foot in contact; low: slips are motion, high: it drifts"),
  };

  explicit InvariantEkf(const GaitdModel& model);
  void set_parameter(int index, double value) { p_.set(index, value); }
  GaitdStatus process(const GaitdStateEstimatorInput& in, GaitdRobotState& out);
  void reset();
  void get_state(GaitdStateEstimatorState& s) const;
  // The filters of the joint rates go on: they belong to the sensors, not to the pose.
  void set_state(const GaitdStateEstimatorState& s);

 private:
  enum Point { kToe, kHeel };
  struct Foot : FootLoad {
    bool trusted = false;
    double time_above = 0.0;                           // s, load share above the threshold
    double time_trusted = 0.0;                         // s
    std::array<Eigen::Vector3d, 2> points;             // m, sole frame, by Point
    Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  // m, W: sole origin when last trusted
    double anchor_yaw = 0.0;
    Eigen::Quaterniond rest = Eigen::Quaterniond::Identity();  // of the sole, where it came to rest
    double time_turned = 0.0;                                  // s, for which it lies otherwise
  };
  // Two low-passes in a row, and what is known of the acceleration between them.
  struct LaggedRate {
    double first = 0.0, second = 0.0;
    void update(double rate, double acceleration, double share, double dt);
  };

  static constexpr int index(int side, Point point) { return 2 * side + point; }
  void hold_on_hoist(double dt);

  bool read_joints(const GaitdStateEstimatorInput& in, GaitdRobotState& out);
  void read_forces(const GaitdStateEstimatorInput& in, GaitdRobotState& out);
  void observe_ground(const GaitdStateEstimatorInput& in);
  void initialise(const GaitdStateEstimatorInput& in, const GaitdRobotState& joints);
  void place(const GaitdStateEstimatorInput& in, const GaitdRobotState& joints);
  void set_covariance(const Eigen::Vector3d& centre, bool levelled);
  void choose_imu(int imu, const GaitdRobotState& joints);
  void predict(const GaitdStateEstimatorInput& in, const GaitdRobotState& joints);
  void update_trust(const GaitdStateEstimatorInput& in);
  // Whether a foot lies otherwise than where it came to rest.
  bool has_turned(int side, double dt);
  void correct(const GaitdStateEstimatorInput& in, const GaitdRobotState& joints);
  void observe_balance(const GaitdStateEstimatorInput& in, const GaitdRobotState& robot);
  void write(const GaitdStateEstimatorInput& in, GaitdRobotState& out);
  void write_feet(GaitdRobotState& out);
  // The joints of a robot whose pelvis stands still at the origin.
  void update_joint_kinematics(const GaitdRobotState& joints);
  Eigen::Vector3d sole_point(int side, const Eigen::Vector3d& in_sole) const;
  Eigen::Quaterniond sole_orientation(int side) const;
  const Eigen::Vector3d& lever() const { return place_.position; }
  Eigen::Vector3d pelvis_position() const;
  Eigen::Vector3d pelvis_velocity() const;

  const GaitdModel model_;
  double weight_;  // N
  sdk::Parameters<P> p_{kParameters};
  dynamics::Kinematics kinematics_;
  double time_unsupported_ = 0.0;                 // s, for which no foot is trusted
  bool hangs_ = false;                            // on a hoist
  std::optional<dynamics::FootWrenches> ground_;  // for feet without force sensors
  RightInvariantFilter filter_;                   // axes of the pelvis, origin of the IMU in use
  int imu_ = 0;
  sdk::ImuPlace place_;  // of that IMU

  bool initialised_ = false;  // gravity has shown where up is
  sdk::Gravity gravity_;
  bool at_pelvis_ = false;         // the filter follows the pelvis origin: a state was handed over
  double time_since_start_ = 0.0;  // s
  // Of the legs, and between pelvis and IMU: nothing is expected of their commands.
  std::array<bool, GAITD_MAX_JOINTS> is_late_joint_{};
  bool joints_seen_ = false;
  std::array<double, GAITD_MAX_JOINTS> joint_{};  // rad
  std::array<LaggedRate, GAITD_MAX_JOINTS> joint_rate_{};
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();            // rad/s, measured, pelvis frame
  Eigen::Vector3d specific_force_ = Eigen::Vector3d::Zero();  // m/s^2, at the IMU, pelvis axes
  // The pelvis twist as late as the rates of the leg joints, for what is built from both.
  std::array<LaggedRate, 6> twist_{};
  bool twist_begun_ = false;
  std::array<Foot, GAITD_MAX_FEET> feet_;
  Eigen::Vector2d last_cop_ = Eigen::Vector2d::Zero();
};

}  // namespace gaitd::plugins

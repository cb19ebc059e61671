// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "foot_trust.h"
#include "gaitd/dynamics/foot_wrenches.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/sdk/layer.h"
#include "gaitd/sdk/sensors.h"
#include "gaitd/sdk/views.h"

namespace gaitd::plugins {

// Kinematic-inertial fusion from IMU, encoders and foot forces (theory section 7).
//
// Joints: an observer of second order on the encoders. Above the legs it is fed with the
// acceleration that the command expects, so that rates are smooth without being late. In the legs
// the contacts decide what a command does, and such a feed-forward would excite them.
//
// Attitude: the gyroscope is integrated. While the robot stands, the heading is held by that which
// each foot had when it came to a stand; how feet turn shows the gyroscope's bias. Position
// and velocity: a third-order observer that integrates the accelerometer and is corrected by where
// the anchored feet put the pelvis; its third state is the error of the accelerometer. The
// horizontal part of that error is what a wrong tilt makes of gravity, free of the accelerations of
// walking: it levels the attitude, slowly. Feet are trusted by the share of the load they carry.
//
// What an accelerometer shows that leans by itself looks like a tilt. But on average the contact
// forces pass through the CoM, so that the CoP and the CoM of the model tell the direction of the
// specific force too; the mean difference is the bias of the accelerometer.
class KinematicInertial {
 public:
  enum class P { kContactOn, kForceFilter, kJointPole, kPositionRate, kTiltRate, kCount };
  static constexpr std::array<GaitdParameter, 5> kParameters = {
      kContactOnParameter,
      kForceFilterParameter,
      sdk::porting(sdk::real_parameter(
          "joint_pole", "1/s", 0, 2000, 300,
          "observer of joint rates; 0: sensor rates, low: they lag, high: noise")),
      sdk::real_parameter(
          "position_rate", "1/s", 0.5, 200, 12,
          "observer of the pelvis; low: accelerometer errors, high: feet that ring"),
      sdk::real_parameter("tilt_rate", "1/s", 0, 3, 0.5,
                          "levelling; low: a wrong tilt stays, high: accelerations tilt the robot"),
  };

  explicit KinematicInertial(const GaitdModel& model);
  void set_parameter(int index, double value) { p_.set(index, value); }
  GaitdStatus process(const GaitdStateEstimatorInput& in, GaitdRobotState& out);
  void reset();
  void get_state(GaitdStateEstimatorState& s) const;
  void set_state(const GaitdStateEstimatorState& s);

 private:
  // The first attitude comes from one noisy sample. Until kAveragingTime (s) the mean over all
  // samples so far, carried along by the gyroscope, takes its place: what the robot does averages
  // out.
  static constexpr double kAveragingTime = 0.4;
  // s, for which the gyroscope is taken to have been watched before: what the feet of a robot that
  // has just been set on them tell of its bias is mostly that joints stick and bend.
  static constexpr double kBiasKnown = 4.0;
  // 1/s: what the drives shake the IMU by averages out.
  static constexpr double kShakingPole = 50.0;

  struct Foot : FootLoad {
    bool trusted = false;
    double time_above = 0.0;                           // s, load share above the threshold
    double time_trusted = 0.0;                         // s
    Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  // m, W: the anchored point of the sole
    Eigen::Vector3d anchored_point = Eigen::Vector3d::Zero();  // m, sole frame
    Eigen::Quaterniond anchor_orientation = Eigen::Quaterniond::Identity();
    bool orientation_anchored = false;
    double time_carrying = 0.0;  // s, in a walk, flat on the ground
    double heading_first = 0.0;  // rad, of the sole, over this time
    double heading_last = 0.0;

    bool rests() const { return trusted && time_trusted >= kRestDelay; }
  };

  const GaitdImuSensor* imu(const GaitdSensors& sensors, int& index) const;
  // An IMU and every joint have something to say.
  bool complete(const GaitdSensors& sensors) const;
  // Of one more sample, in the means of the start.
  double averaging_share(double dt) const;
  void read_joints(const GaitdStateEstimatorInput& in, GaitdRobotState& out);
  void initialise(const GaitdStateEstimatorInput& in, const GaitdRobotState& joints);
  void place(const GaitdStateEstimatorInput& in, const GaitdRobotState& joints);
  void update_attitude(const GaitdStateEstimatorInput& in, const GaitdRobotState& joints,
                       double dt);
  void read_feet(const GaitdStateEstimatorInput& in, GaitdRobotState& out);
  void observe_bias(const GaitdStateEstimatorInput& in, const GaitdRobotState& robot);
  void update_trust(const GaitdStateEstimatorInput& in, double dt);
  void observe_gyro_bias(double dt);
  // rad/s about the vertical, by which the feet seemed to turn for so long (s).
  void learn_turn_bias(double found, double time);
  void observe_turns(const GaitdStateEstimatorInput& in, double dt);
  // Over its toe: the rest of the sole is in the air.
  bool rolls(int side, const GaitdStateEstimatorInput& in) const;
  void update_anchors(const GaitdStateEstimatorInput& in, double dt);
  void update_position(const GaitdStateEstimatorInput& in, double dt);
  void level_attitude(double dt, bool standing);
  void update_lagged_twist(double dt);
  void write(const GaitdStateEstimatorInput& in, GaitdRobotState& out);
  void update_kinematics(const GaitdRobotState& joints);
  Eigen::Quaterniond sole_orientation(int side) const;
  Eigen::Vector3d sole_point(int side, const Eigen::Vector3d& in_sole) const;

  const GaitdModel model_;
  double weight_;  // N
  sdk::Parameters<P> p_{kParameters};
  dynamics::Kinematics kinematics_;
  std::optional<dynamics::FootWrenches> ground_;  // for feet without force sensors

  bool initialised_ = false;  // gravity has shown where up is
  sdk::Gravity gravity_;
  double time_since_start_ = 0.0;
  double time_quiet_ = 0.0;                            // s, for which the robot has been at rest
  Eigen::Vector3d shaking_ = Eigen::Vector3d::Zero();  // m/s^2, accelerometer beside the balance
  double time_still_ = 0.0;                            // s, of the window in which its feet
  double time_bias_ = 0.0;  // s, that the bias about the vertical is a mean over
  Eigen::Vector3d turned_ = Eigen::Vector3d::Zero();  // turned by this, rad, pelvis frame
  bool joints_seen_ = false;
  // Of the legs, and between pelvis and IMU: what is built from their rates and the gyroscope's has
  // to be equally late, so nothing is expected of their commands.
  std::array<bool, GAITD_MAX_JOINTS> late_joint_{};
  std::array<double, GAITD_MAX_JOINTS> joint_{};                     // rad, observed
  std::array<double, GAITD_MAX_JOINTS> joint_rate_{};                // rad/s, observed
  Eigen::Quaterniond orientation_ = Eigen::Quaterniond::Identity();  // pelvis in W
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();               // pelvis, W
  Eigen::Vector3d hung_at_ = Eigen::Vector3d::Zero();     // m, where no foot carried it any more
  double time_unsupported_ = 0.0;                         // s, since then
  Eigen::Vector3d velocity_W_ = Eigen::Vector3d::Zero();  // pelvis, W
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();        // rad/s, pelvis frame
  Eigen::Vector3d imu_rate_ = Eigen::Vector3d::Zero();    // rad/s, of the IMU against the pelvis
  Eigen::Vector3d turn_ = Eigen::Vector3d::Zero();        // rad/s, by which the attitude turned
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero();   // pelvis frame
  Eigen::Vector3d accelerometer_bias_ = Eigen::Vector3d::Zero();  // pelvis frame
  Eigen::Vector3d balance_bias_ = Eigen::Vector3d::Zero();        // likewise, by the balance
  Eigen::Vector3d specific_force_ = Eigen::Vector3d::Zero();      // at the IMU, pelvis axes
  Eigen::Vector3d about_ = Eigen::Vector3d::Zero();         // m/s, W: of the IMU about the pelvis
  Eigen::Vector3d about_slow_ = Eigen::Vector3d::Zero();    // m/s, W: low-passed
  Eigen::Vector3d about_change_ = Eigen::Vector3d::Zero();  // m/s, in this tick
  Eigen::Quaterniond last_mount_ = Eigen::Quaterniond::Identity();  // IMU axes in the pelvis
  int about_imu_ = -1;                                              // which one; -1: none yet
  // Pelvis twist as late as the observed rates of the leg joints: what is built from both, such as
  // the velocity of the CoM or of a foot, would otherwise see every quick turn of the pelvis twice.
  sdk::Vector6d half_lagged_ = sdk::Vector6d::Zero();
  sdk::Vector6d lagged_ = sdk::Vector6d::Zero();
  bool lag_begun_ = false;
  std::array<Foot, GAITD_MAX_FEET> feet_;
  Eigen::Vector2d last_cop_ = Eigen::Vector2d::Zero();
};

}  // namespace gaitd::plugins

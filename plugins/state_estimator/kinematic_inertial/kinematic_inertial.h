// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

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
// Attitude: the gyroscope is integrated, its heading corrected by the heading that each foot in
// contact had when it came to rest (which also shows the gyroscope's bias). Position
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
  enum class P {
    kTrustOn,
    kTrustOff,
    kTrustDelay,
    kContactOn,
    kContactOff,
    kContactLeast,
    kForceFilter,
    kLegPole,
    kUpperBodyPole,
    kPositionRate,
    kTiltRate,
    kTiltBiasRate,
    kAnchorRate,
    kBiasRate,
    kStillShare,
    kAnchorDelay,
    kBiasLimit,
    kBalanceRate,
    kBalanceLimit,
    kCount
  };
  static constexpr std::array<GaitdParameter, 19> kParameters = {
      sdk::real_parameter("trust_on", "load", 0, 1, 0.48,
                          "share that makes a foot an anchor: near half, as feet sink in under "
                          "their load, and rise as they lose it"),
      sdk::real_parameter("trust_off", "load", 0, 1, 0.30, "share below which it is none"),
      sdk::real_parameter("trust_delay", "s", 0, 0.5, 0.02, "that the share must last"),
      sdk::real_parameter("contact_on", "weight", 0.001, 1, 0.05, "normal force of a contact"),
      sdk::real_parameter("contact_off", "weight", 0, 1, 0.03, "normal force of no contact"),
      sdk::real_parameter("contact_least", "N", 0, 1000, 40,
                          "normal force of a contact of a light robot: above offset and noise of "
                          "its sensors"),
      sdk::real_parameter("force_filter", "Hz", 5, 500, 80, "low-pass of the normal force"),
      sdk::real_parameter("leg_pole", "1/s", 0, 2000, 300,
                          "observer of the rates of leg joints; 0: the rates of the sensors"),
      sdk::real_parameter("upper_body_pole", "1/s", 0, 2000, 300,
                          "the same for all other joints, which follow their commands closely"),
      sdk::real_parameter("position_rate", "1/s", 0.5, 200, 12,
                          "pole of the observer of position, velocity and bias"),
      sdk::real_parameter("tilt_rate", "1/s", 0, 3, 0.5,
                          "levelling in a walk; three times faster when standing"),
      sdk::real_parameter("tilt_bias_rate", "1/s^2", 0, 1, 0.05, "gyroscope bias from the same"),
      sdk::real_parameter("anchor_rate", "1/s", 0, 50, 2,
                          "correction of the heading by feet at rest"),
      sdk::real_parameter("bias_rate", "1/s^2", 0, 50, 0.5,
                          "gyroscope bias from the same while standing; a twentieth in a walk"),
      sdk::real_parameter("still_share", "", 0, 1, 0.8,
                          "of what the feet of a robot at rest tell of the gyroscope bias"),
      sdk::real_parameter("anchor_delay", "s", 0, 1, 0.1,
                          "after which an anchored foot is taken to be at rest"),
      sdk::real_parameter("bias_limit", "m/s^2", 0, 5, 0.4, "of the accelerometer's error"),
      sdk::real_parameter("balance_rate", "1/s", 0, 10, 0.08,
                          "accelerometer bias from CoP and CoM; six times faster standing"),
      sdk::real_parameter("balance_limit", "m/s^2", 0, 5, 0.2, "of that bias"),
  };

  explicit KinematicInertial(const GaitdModel& model);
  void set_parameter(int index, double value) { p_.set(index, value); }
  GaitdStatus process(const GaitdStateEstimatorInput& in, GaitdRobotState& out);
  void reset();
  void get_state(GaitdStateEstimatorState& s) const;
  void set_state(const GaitdStateEstimatorState& s);

 private:
  struct Foot {
    bool trusted = false;
    double time_above = 0.0;    // s, load share above the threshold
    double time_trusted = 0.0;  // s
    int contact = GAITD_CONTACT_NONE;
    double normal_force = 0.0;                         // N, filtered
    Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  // m, W: the anchored point of the sole
    Eigen::Vector3d anchored_point = Eigen::Vector3d::Zero();  // m, sole frame
    Eigen::Quaterniond anchor_orientation = Eigen::Quaterniond::Identity();
    bool orientation_anchored = false;
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
  Eigen::Vector3d turned_ = Eigen::Vector3d::Zero();   // turned by this, rad, pelvis frame
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

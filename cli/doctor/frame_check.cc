// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "cli/doctor/robot_doctor.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/leg_geometry.h"
#include "gaitd/walking/support.h"

namespace gaitd::doctor {
namespace {

constexpr double kBehindAnkle = 0.005;   // m
constexpr double kMirror = 0.01;         // m
constexpr double kMassShare = 0.05;      // of the mass of a leg link
constexpr double kUpright = 0.5;         // rad
constexpr double kWidestLineFoot = 0.1;  // heights of the CoM

using Eigen::Matrix3d;
using Eigen::Vector3d;

class Frames {
 public:
  explicit Frames(const GaitdModel& model) : model_(model), kinematics_(model) {
    const Eigen::VectorXd q =
        Eigen::Map<const Eigen::VectorXd>(model.nominal_position, model.joint_count);
    kinematics_.update(Vector3d::Zero(), Eigen::Quaterniond::Identity(), dynamics::Vector6d::Zero(),
                       q, Eigen::VectorXd::Zero(model.joint_count));
  }
  Findings check() {
    for (int side = 0; side < GAITD_MAX_FEET; ++side) check_foot(side);
    check_mirror();
    check_line_feet();
    for (int i = 0; i < model_.imu_count; ++i) {
      const double tilt = angle_to_up(model_.imus[i]);
      if (tilt < kUpright) continue;
      warn(format("imu %s: its z axis is %.2f rad off the vertical", model_.imus[i].name, tilt),
           "right only if it is mounted like that; a log tells: `gaitctl doctor LOG` compares it "
           "with gravity and with the legs");
    }
    if (findings_.empty()) {
      findings_.push_back({"frames", Severity::kOk,
                           "feet point forward, legs are mirror images, IMU and force sensors are "
                           "upright",
                           ""});
    }
    return findings_;
  }

 private:
  // Feet that their legs cannot roll stand on an edge: the wider they are, the further that is from
  // where it was planned.
  void check_line_feet() {
    if (walking::rolls_foot(model_, GAITD_LEFT)) return;
    double width = 0.0;
    for (int side = 0; side < GAITD_MAX_FEET; ++side) {
      const auto sole = walking::sole_extent(walking::whole_sole(model_, side, {}));
      width = std::max(width, sole.y_max - sole.y_min);
    }
    const double height = kinematics_.com().z() - lowest_sole();
    if (width <= kWidestLineFoot * height) return;
    warn(format("no joint rolls the feet, and their soles are %.0f mm wide: more than %.0f mm, a "
                "tenth of the height of the centre of mass, was seen to fall",
                1e3 * width, 1e3 * kWidestLineFoot * height),
         "round the soles off along their sides, or make them narrower, in the simulation too");
  }
  double lowest_sole() const {
    double lowest = origin(model_.feet[GAITD_LEFT].sole).z();
    return std::min(lowest, origin(model_.feet[GAITD_RIGHT].sole).z());
  }
  void warn(std::string what, const char* advice) {
    findings_.push_back({"frames", Severity::kWarning, std::move(what), advice});
  }
  Matrix3d axes(const GaitdFrame& frame) const {
    return kinematics_.R_WB(frame.body) * sdk::quaternion(frame.orientation).toRotationMatrix();
  }
  double angle_to_up(const GaitdFrame& frame) const {
    return std::acos(std::clamp(axes(frame)(2, 2), -1.0, 1.0));
  }
  Vector3d origin(const GaitdFrame& frame) const {
    return kinematics_.frame_position(frame.body, Eigen::Map<const Vector3d>(frame.origin));
  }

  void check_foot(int side) {
    const char* name = walking::side_name(side);
    const GaitdFoot& foot = model_.feet[side];
    const Matrix3d sole = axes(foot.sole);
    if (sole(0, 0) < std::cos(kUpright)) {
      warn(format("the %s sole: its x axis does not point forward", name),
           "rpy of sole in robot.yaml; x of the pelvis is forward");
    }
    const int pitch = model_.legs[side].ankle_pitch;
    const Vector3d ankle =
        kinematics_.p_WB(pitch < 0 ? foot.body : model_.joints[pitch].child_body);
    if ((origin(foot.sole) - ankle).dot(sole.col(0)) < -kBehindAnkle) {
      warn(format("the %s sole lies behind its ankle", name),
           "feet are longer in front: is the sole frame, or the robot, turned around?");
    }
    const double y = origin(foot.sole).y();
    if (side == GAITD_LEFT ? y < 0.0 : y > 0.0) {
      warn(format("the %s foot stands on the other side of the pelvis", name),
           "left is +y: feet and legs in robot.yaml may be exchanged");
    }
    const bool sensor = foot.force_sensor.body >= 0;
    if (const double tilt = sensor ? angle_to_up(foot.force_sensor) : 0.0; tilt > kUpright) {
      warn(format("force sensor of the %s foot: its z axis is %.2f rad off the vertical", name,
                  tilt),
           "right only if it is mounted like that: standing, it must measure force upwards");
    }
    const GaitdLeg& leg = model_.legs[side];
    const GaitdJoint& knee = model_.joints[leg.knee];
    const walking::LegGeometry geometry(model_, side);
    const double room_bent =
        std::max(geometry.bend(knee.position_min), geometry.bend(knee.position_max));
    if (room_bent < 0.5) {
      warn(format("%s can bend by only %.2f rad", knee.name, room_bent),
           "limits of the knee in the URDF, or its axis is flipped");
    }
  }

  void check_mirror() {
    const GaitdLeg& left = model_.legs[GAITD_LEFT];
    const GaitdLeg& right = model_.legs[GAITD_RIGHT];
    for (int k = 0; k < std::min(left.joint_count, right.joint_count); ++k) {
      const GaitdBody& a = model_.bodies[left.joints[k] + 1];
      const GaitdBody& b = model_.bodies[right.joints[k] + 1];
      Vector3d mirrored = kinematics_.p_WB(left.joints[k] + 1);
      mirrored.y() *= -1.0;
      const double distance = (mirrored - kinematics_.p_WB(right.joints[k] + 1)).norm();
      if (distance > kMirror) {
        warn(format("%s and %s are %.0f mm from being mirror images", a.name, b.name,
                    1e3 * distance),
             "origins of these joints in the URDF, signs in posture");
      }
      if (std::abs(a.mass - b.mass) > kMassShare * std::max(a.mass, b.mass)) {
        warn(format("%s weighs %.2f kg, %s %.2f kg", a.name, a.mass, b.name, b.mass),
             "masses of these links in the URDF");
      }
    }
  }

  const GaitdModel& model_;
  dynamics::Kinematics kinematics_;
  Findings findings_;
};

}  // namespace

Findings check_frames(const GaitdModel& model) { return Frames(model).check(); }

}  // namespace gaitd::doctor

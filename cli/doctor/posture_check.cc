// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "cli/doctor/reach.h"
#include "cli/doctor/robot_doctor.h"
#include "daemon/config/leg_kinematics.h"
#include "gaitd/dynamics/dynamics.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/polygon.h"

namespace gaitd::doctor {
namespace {

constexpr double kBeyondAnkle = 1.25;  // of what an ankle holds, from which a sole is too large
constexpr double kNearStop = 0.05;     // rad
constexpr double kLeastBend = 0.01;    // of the leg length
constexpr double kLowestPelvis = 0.4;  // of the leg length: it tells a fall by its height
constexpr double kIcpMargin = 0.02;    // m
constexpr double kLoaded = 0.4;        // of the effort limit, standing on both legs
constexpr double kOverloaded = 0.9;

using Eigen::Vector2d;
using Eigen::Vector3d;

Findings check_reach(const GaitdModel& model) {
  const double length = leg_length(model);
  const double height = model.nominal_pelvis_height;
  const double reserve = length - height;
  if (height < kLowestPelvis * length) {
    return {
        {"reach", Severity::kProblem,
         format("the origin of the pelvis is %.3f m above the soles, where legs are %.3f m long",
                height, length),
         "put the origin of the pelvis near the hips: `pelvis: {link, xyz}` in robot.yaml"}};
  }
  const bool bent = reserve > kLeastBend * length;
  return {{"reach", bent ? Severity::kOk : Severity::kWarning,
           format("the pelvis stands %.3f m above the soles, straight legs would lift it by %.3f "
                  "m; steps reach about %.2f m",
                  height, reserve, longest_step(length)),
           bent ? "" : "bend the knees of posture by 0.3 to 0.6 rad"}};
}

Findings check_stops(const GaitdModel& model) {
  Findings findings;
  for (const GaitdLeg& leg : model.legs) {
    for (int k = 0; k < leg.joint_count; ++k) {
      const GaitdJoint& joint = model.joints[leg.joints[k]];
      const double q = model.nominal_position[leg.joints[k]];
      const double room = std::min(q - joint.position_min, joint.position_max - q);
      if (room > kNearStop) continue;
      findings.push_back({"posture", Severity::kWarning,
                          format("%s stands %.3f rad from its stop", joint.name, room),
                          "its value in posture, its limits in the URDF"});
    }
  }
  return findings;
}

Findings check_icp(const GaitdModel& model) {
  const daemon::PostureFigures figures = daemon::compute_posture_figures(model);
  walking::ConvexPolygon soles;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const Eigen::Rotation2Dd turn(figures.sole_yaw[side]);
    const Vector2d at(figures.sole_position[side][0], figures.sole_position[side][1]);
    for (int p = 0; p < model.feet[side].point_count; ++p) {
      soles.add(at + turn * Eigen::Map<const Vector2d>(model.feet[side].points[p]));
    }
  }
  soles.make_hull();
  // Standing still, the ICP is the ground projection of the centre of mass.
  const Vector2d icp(figures.com[0], figures.com[1]);
  const Vector2d middle(0.5 * (figures.sole_position[0][0] + figures.sole_position[1][0]),
                        0.5 * (figures.sole_position[0][1] + figures.sole_position[1][1]));
  const double margin = soles.inside_distance(icp);
  const Vector2d off = icp - middle;
  const Severity severity = margin < 0.0          ? Severity::kProblem
                            : margin < kIcpMargin ? Severity::kWarning
                                                  : Severity::kOk;
  return {
      {"icp", severity,
       format("standing, the ICP is %.1f mm in front and %.1f mm to the left of the middle of "
              "the feet, %.0f mm inside their edge",
              1e3 * off.x(), 1e3 * off.y(), 1e3 * margin),
       severity == Severity::kOk
           ? ""
           : "shift the pelvis over the feet: hip and ankle pitch in posture; check the centres "
             "of mass"}};
}

// Statics: both feet push straight up under the centre of mass, each with what its distance gives.
Findings check_torques(const GaitdModel& model) {
  dynamics::Dynamics dynamics(model);
  const int joints = model.joint_count;
  const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(model.nominal_position, joints);
  dynamics.update(Vector3d::Zero(), Eigen::Quaterniond::Identity(), dynamics::Vector6d::Zero(), q,
                  Eigen::VectorXd::Zero(joints));
  const daemon::PostureFigures figures = daemon::compute_posture_figures(model);
  const double left = figures.sole_position[0][1];
  const double right = figures.sole_position[1][1];
  const double share = std::clamp((figures.com[1] - right) / (left - right), 0.0, 1.0);
  std::array<dynamics::ExternalWrench, 2> wrenches;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const int body = model.feet[side].body;
    const Vector3d point(figures.com[0], figures.sole_position[side][1],
                         figures.sole_position[side][2]);
    wrenches[side].body = body;
    wrenches[side].p_BF = dynamics.R_WB(body).transpose() * (point - dynamics.p_WB(body));
    wrenches[side].wrench[5] =
        (side == GAITD_LEFT ? share : 1.0 - share) * model.total_mass * model.gravity;
  }
  Eigen::VectorXd torque(dynamics.velocity_size());
  dynamics.inverse_dynamics(Eigen::VectorXd::Zero(dynamics.velocity_size()), wrenches, torque);
  int worst = 0;
  double load = 0.0;
  for (int i = 0; i < joints; ++i) {
    const double ratio = std::abs(torque[6 + i]) / model.joints[i].effort_limit;
    if (ratio <= load) continue;
    load = ratio;
    worst = i;
  }
  const Severity severity = load > kOverloaded ? Severity::kProblem
                            : load > kLoaded   ? Severity::kWarning
                                               : Severity::kOk;
  return {{"torques", severity,
           format("standing, %s carries most: %.1f N m, %.0f %% of its limit; %.0f %% are left",
                  model.joints[worst].name, std::abs(torque[6 + worst]), 100.0 * load,
                  100.0 * std::max(0.0, 1.0 - load)),
           severity == Severity::kOk
               ? ""
               : "on one leg it is about twice as much: straighter knees in posture; masses and "
                 "effort limits in the URDF"}};
}

// The CoP of a robot on one leg goes no further from an axis of the ankle than its effort holds.
Findings check_ankles(const GaitdModel& model) {
  dynamics::Kinematics kinematics(model);
  kinematics.update(Vector3d::Zero(), Eigen::Quaterniond::Identity(), dynamics::Vector6d::Zero(),
                    Eigen::Map<const Eigen::VectorXd>(model.nominal_position, model.joint_count),
                    Eigen::VectorXd::Zero(model.joint_count));
  double most = 0.0;
  double of_sole = 0.0;
  double of_ankle = 0.0;
  const char* joint = "";
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFrame& sole = model.feet[side].sole;
    const Eigen::Isometry3d X_WS = kinematics.X_WB(sole.body) *
                                   Eigen::Translation3d(sdk::view(sole.origin)) *
                                   sdk::quaternion(sole.orientation);
    const int axes[] = {model.legs[side].ankle_pitch, model.legs[side].ankle_roll};
    for (int axis = 0; axis < 2; ++axis) {
      if (axes[axis] < 0) continue;
      const GaitdJoint& ankle = model.joints[axes[axis]];
      const double at = (X_WS.inverse() * kinematics.p_WB(ankle.child_body))[axis];
      const double reach = ankle.effort_limit / (model.total_mass * model.gravity);
      for (int p = 0; p < model.feet[side].point_count; ++p) {
        const double far = std::abs(model.feet[side].points[p][axis] - at);
        if (far <= kBeyondAnkle * reach || far - reach <= most) continue;
        most = far - reach;
        of_sole = far;
        of_ankle = reach;
        joint = ankle.name;
      }
    }
  }
  if (most <= 0.0) return {};
  return {{"ankles", Severity::kWarning,
           format("on one leg, %s holds the centre of pressure %.0f mm from its axis with all its "
                  "effort; the sole goes on to %.0f mm",
                  joint, 1e3 * of_ankle, 1e3 * of_sole),
           "the gait counts on the whole sole: cut its outline in robot.yaml to 0.9 of what the "
           "ankle holds, with the frame in the middle"}};
}

}  // namespace

Findings check_posture(const GaitdModel& model) {
  Findings all;
  for (const Findings& some : {check_reach(model), check_stops(model), check_icp(model),
                               check_torques(model), check_ankles(model)}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

}  // namespace gaitd::doctor

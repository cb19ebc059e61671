// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/posture.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "cli/robot/arms.h"
#include "daemon/config/leg_kinematics.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/leg_geometry.h"

namespace gaitd::porting {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using Task = Eigen::Matrix<double, 6, 1>;

constexpr double kBends[] = {0.5, 0.35, 0.25, 0.7};  // rad, of the knees: what is tried
constexpr double kStopMargins[] = {0.03, 0.005};     // rad, from the stops
constexpr double kClose = 5e-4;                      // rad and m
constexpr double kGap = 0.35;                        // of the width of a sole, between the soles

class Solver {
 public:
  Solver(const GaitdModel& model, double knee_bend, double stop_margin)
      : model_(model), kinematics_(model), knee_bend_(knee_bend), stop_margin_(stop_margin) {}

  void pose(const VectorXd& q) {
    kinematics_.update(Vector3d::Zero(), Eigen::Quaterniond::Identity(), dynamics::Vector6d::Zero(),
                       q, VectorXd::Zero(q.size()));
  }

  Vector3d sole(int side) const {
    const GaitdFrame& frame = model_.feet[side].sole;
    return kinematics_.frame_position(frame.body, sdk::view(frame.origin));
  }
  const Vector3d& com() const { return kinematics_.com(); }

  // Brings the sole of a leg, level and looking forward, to x and y; and to the height `z`, or the
  // knee to its bend if that is not a number. What is left of the error.
  double solve(int side, double x, double y, double z, VectorXd* q) {
    const GaitdLeg& leg = model_.legs[side];
    dynamics::Matrix6X jacobian(6, kinematics_.velocity_size());
    Eigen::MatrixXd J(6, leg.joint_count);
    Task error;
    for (int k = 0; k < 200; ++k) {
      pose(*q);
      const GaitdFoot& foot = model_.feet[side];
      const Eigen::Quaterniond now =
          Eigen::Quaterniond(kinematics_.R_WB(foot.body)) * sdk::quaternion(foot.sole.orientation);
      error.head<3>() = sdk::log_so3(now.conjugate());
      error.tail<3>() = Vector3d(x, y, z) - sole(side);
      kinematics_.frame_jacobian(foot.body, sdk::view(foot.sole.origin), jacobian);
      int knee = 0;
      for (int i = 0; i < leg.joint_count; ++i) {
        J.col(i) = jacobian.col(6 + leg.joints[i]);
        if (leg.joints[i] == leg.knee) knee = i;
      }
      // The error of the orientation is that of the foot in its own axes; near zero both agree.
      error.head<3>() = now * error.head<3>();
      if (std::isnan(z)) {
        error[5] = knee_target(side) - (*q)[leg.knee];
        J.row(5).setZero();
        J(5, knee) = 1.0;
      }
      if (error.norm() < 1e-9) break;
      const Eigen::Matrix<double, 6, 6> normal =
          J * J.transpose() + 1e-6 * Eigen::Matrix<double, 6, 6>::Identity();
      VectorXd step = J.transpose() * normal.ldlt().solve(error);
      const double most = step.cwiseAbs().maxCoeff();
      if (most > 0.2) step *= 0.2 / most;
      for (int i = 0; i < leg.joint_count; ++i) {
        const GaitdJoint& joint = model_.joints[leg.joints[i]];
        double& position = (*q)[leg.joints[i]];
        position = std::clamp(position + step[i], joint.position_min + margin(joint),
                              joint.position_max - margin(joint));
      }
    }
    return error.norm();
  }

  // The joints of a leg that are as near to a stop as they may be.
  std::string at_stops(int side, const VectorXd& q) const {
    std::string names;
    for (int i = 0; i < model_.legs[side].joint_count; ++i) {
      const GaitdJoint& joint = model_.joints[model_.legs[side].joints[i]];
      const double at = q[model_.legs[side].joints[i]];
      const double room = std::min(at - joint.position_min, joint.position_max - at);
      if (room > margin(joint) + 1e-9) continue;
      names += (names.empty() ? "" : ", ") + std::string(joint.name);
    }
    return names;
  }

 private:
  double margin(const GaitdJoint& joint) const {
    return std::min(stop_margin_, 0.05 * (joint.position_max - joint.position_min));
  }

  double knee_target(int side) const {
    const GaitdLeg& leg = model_.legs[side];
    const GaitdJoint& knee = model_.joints[leg.knee];
    const double straight = walking::LegGeometry(model_, side).straight();
    const double target = straight + leg.knee_bend_sign * knee_bend_;
    return std::clamp(target, knee.position_min + margin(knee), knee.position_max - margin(knee));
  }

  const GaitdModel& model_;
  dynamics::Kinematics kinematics_;
  double knee_bend_;    // rad
  double stop_margin_;  // rad
};

struct Stance {
  double bend = 0.0;  // rad, of the knees
  double half = 0.0;  // m, half the distance of the soles
  double margin = 0.0;
  VectorXd q;
  std::array<double, 2> off = {};  // rad and m, what is left of the error
  std::string at_stops;
  bool found() const { return std::max(off[0], off[1]) <= kClose; }
};

// Both soles level, side by side about `middle` (m, y) and below the centre of mass; from `q`.
void stand(const GaitdModel& model, double middle, Stance* stance) {
  Solver solver(model, stance->bend, stance->margin);
  VectorXd& q = stance->q;
  double x = 0.0;
  for (int k = 0; k < 30; ++k) {
    stance->off[0] = solver.solve(GAITD_LEFT, x, middle + stance->half, NAN, &q);
    solver.pose(q);
    const double z = solver.sole(GAITD_LEFT).z();
    stance->off[1] = solver.solve(GAITD_RIGHT, x, middle - stance->half, z, &q);
    solver.pose(q);
    const double ahead = solver.com().x() - x;
    if (std::abs(ahead) < 1e-4) break;
    x += ahead;
  }
  for (int side = 0; side < 2; ++side) {
    const std::string names = solver.at_stops(side, q);
    if (!names.empty()) stance->at_stops += (stance->at_stops.empty() ? "" : ", ") + names;
  }
}

// The first that the legs reach with room to their stops, or next to them; the most usual one if
// they reach none. Half the distance of the soles is `half`, somewhat more, or as the legs hang,
// `hang` (m).
Stance find_stance(const GaitdModel& model, double middle, double half, double hang,
                   const VectorXd& q) {
  Stance first;
  std::optional<Stance> next_to_stops;
  for (const double margin : kStopMargins) {
    for (const double bend : kBends) {
      for (const double width : {half, 1.1 * half, 1.2 * half, std::max(half, hang)}) {
        Stance stance{bend, width, margin, q, {}, ""};
        stand(model, middle, &stance);
        if (stance.found() && stance.at_stops.empty() && margin == kStopMargins[0]) return stance;
        if (stance.found() && !next_to_stops) next_to_stops = stance;
        if (first.q.size() == 0) first = stance;
      }
    }
  }
  return next_to_stops.value_or(first);
}

// Half the distance of the soles in y, m: as the legs hang, but not closer than feet can stand,
// unless no joint rolls them.
double half_stance(const Guess& guess, const std::array<Vector3d, 2>& hanging,
                   const std::array<Vector3d, 2>& hips) {
  double width = 0.0;
  for (const SoleGuess& sole : guess.soles) {
    double inner = 0.0;
    double outer = 0.0;
    for (const Eigen::Vector2d& p : sole.outline) {
      inner = std::min(inner, p.y());
      outer = std::max(outer, p.y());
    }
    width = std::max(width, outer - inner);
  }
  const double hip = 0.5 * (hips[0].y() - hips[1].y());
  double half = 0.5 * (hanging[0].y() - hanging[1].y());
  // Without a joint that rolls it a sole is level at this width only.
  if (guess.legs[0].ankle_roll < 0) return half;
  if (half < 0.6 * hip || half > 1.6 * hip) half = hip;
  return std::max(half, 0.5 * (1.0 + kGap) * width);
}

}  // namespace

bool solve_posture(Guess* guess, std::string* error) {
  GaitdModel& model = guess->model;
  Eigen::Map<VectorXd> nominal(model.nominal_position, model.joint_count);
  nominal = zero_position(model);
  const auto poses = body_poses(model, nominal);
  std::array<Vector3d, 2> hips;
  for (int side = 0; side < 2; ++side) {
    // At zero a straight leg shows no sign of the hip and the ankle: in the posture it does.
    (void)daemon::compute_bend_signs(model, &model.legs[side]);
    const int hip = model.legs[side].hip_pitch + 1;
    hips[static_cast<std::size_t>(side)] = poses[static_cast<std::size_t>(hip)].translation();
  }
  VectorXd q = nominal;
  hang_arms(*guess, &q);
  Solver hanging(model, kBends[0], kStopMargins[0]);
  hanging.pose(q);
  const double hang = 0.5 * (hanging.sole(0).y() - hanging.sole(1).y());
  const double half = half_stance(*guess, {hanging.sole(0), hanging.sole(1)}, hips);
  for (int side = 0; side < 2; ++side) {
    const GaitdLeg& leg = model.legs[side];
    const double signs[] = {leg.hip_pitch_bend_sign, leg.knee_bend_sign, leg.ankle_pitch_bend_sign};
    const int joints[] = {leg.hip_pitch, leg.knee, leg.ankle_pitch};
    const double bends[] = {0.25, 0.5, 0.25};
    for (int i = 0; i < 3; ++i) {
      const GaitdJoint& joint = model.joints[joints[i]];
      q[joints[i]] =
          std::clamp(q[joints[i]] + signs[i] * bends[i], joint.position_min, joint.position_max);
    }
  }
  const Stance stance = find_stance(model, middle_of(*guess), half, hang, q);
  if (!stance.found()) {
    *error = format(
        "no standing posture: with the soles flat, side by side, %.3f m apart and below the centre "
        "of mass, the left leg is off by %.3f, the right one by %.3f (rad and m)%s",
        2.0 * stance.half, stance.off[0], stance.off[1],
        stance.at_stops.empty() ? "" : ("; at their stops: " + stance.at_stops).c_str());
    return false;
  }
  nominal = stance.q;
  for (int side = 0; side < 2; ++side) {
    const std::string expected = daemon::compute_bend_signs(model, &model.legs[side]);
    if (expected.empty()) continue;
    *error = "the " + std::string(side == 0 ? "left" : "right") + " leg: expected " + expected;
    return false;
  }
  const daemon::PostureFigures figures = daemon::compute_posture_figures(model);
  guess->posture_why.push_back(format(
      "Solved: soles level, parallel and %.4f m apart, %s; knees bent by %.2f rad; "
      "pelvis %.4f and centre of mass %.4f m above the soles, %.1f mm in front of their middle and "
      "%.1f mm to the left of it.",
      figures.foot_separation(),
      stance.half > 1.01 * hang   ? "wider than the legs hang"
      : stance.half < 0.99 * hang ? "narrower than the legs hang"
                                  : "as the legs hang",
      stance.bend, figures.pelvis_height(), figures.com_height(),
      1e3 * (figures.com[0] - figures.sole_position[0][0]),
      1e3 * (figures.com[1] - 0.5 * (figures.sole_position[0][1] + figures.sole_position[1][1]))));
  guess->posture_why.push_back(stance.at_stops.empty()
                                   ? "Arms hang at rest, no joint is at a stop."
                                   : "Arms hang at rest; next to a stop: " + stance.at_stops + ".");
  model.nominal_pelvis_height = figures.pelvis_height();
  model.nominal_com_height = figures.com_height();
  model.nominal_foot_separation = figures.foot_separation();
  return true;
}

}  // namespace gaitd::porting

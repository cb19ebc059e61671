// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/truth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace gaitd::sim {
namespace {

constexpr double kLoaded = 0.0291;   // of the weight: 50 N of Atlas
constexpr double kSideNormal = 0.7;  // vertical part of a normal, below which its face is a side

void store(const Eigen::Quaterniond& q, double* xyzw) {
  Eigen::Map<Eigen::Vector4d>(xyzw, 4) = q.coeffs();
}

}  // namespace

Truth::Truth(const GaitdModel& model) : model_(model) {}

void Truth::reset() {
  for (Foot& foot : feet_) foot = Foot{};
  body_contact_ = false;
}

void Truth::update(std::span<const Touch> touches) {
  body_contact_ = false;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    Foot& foot = feet_[side];
    foot.force.setZero();
    foot.penetration = 0;
    foot.side_force = 0;
    double weight = 0;
    Eigen::Vector2d slipped = Eigen::Vector2d::Zero();
    for (const Touch& touch : touches) {
      if (touch.foot < 0) body_contact_ = true;
      if (touch.foot != side) continue;
      const double normal_force = touch.force.dot(touch.normal);
      foot.force += touch.force;
      foot.penetration = std::max(foot.penetration, touch.depth);
      if (std::abs(touch.normal.z()) < kSideNormal) foot.side_force += normal_force;
      weight += normal_force;
      slipped += normal_force * touch.slip.head<2>();
    }
    const bool loaded = foot.force.z() > kLoaded * model_.total_mass * model_.gravity;
    if (loaded && !foot.loaded) foot.slip = 0;
    if (loaded) foot.slip += slipped.norm() / weight;
    foot.loaded = loaded;
  }
}

void Truth::read(double time, const State& state, Bodies bodies, const Eigen::VectorXd& torque,
                 GaitdTruth* truth) const {
  *truth = GaitdTruth{};
  truth->size = sizeof(GaitdTruth);
  truth->body_contact = body_contact_ ? 1 : 0;
  truth->time = time;
  Eigen::Map<Eigen::Vector3d>(truth->pelvis_position) = state.p_WB;
  store(state.R_WB, truth->pelvis_orientation);
  const Eigen::Matrix3d R_BW = state.R_WB.toRotationMatrix().transpose();
  Eigen::Map<Eigen::Vector3d>(truth->pelvis_twist) = R_BW * state.u.head<3>();
  Eigen::Map<Eigen::Vector3d>(truth->pelvis_twist + 3) = R_BW * state.u.segment<3>(3);
  Eigen::Map<Eigen::Vector3d> com(truth->com), com_velocity(truth->com_velocity);
  for (int i = 0; i < model_.body_count; ++i) {
    const BodyMotion& motion = bodies[i];
    const Eigen::Vector3d c = motion.point(Eigen::Vector3d(model_.bodies[i].com));
    com += model_.bodies[i].mass / model_.total_mass * c;
    com_velocity += model_.bodies[i].mass / model_.total_mass * motion.velocity(c);
  }
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFrame& sole = model_.feet[side].sole;
    const BodyMotion& motion = bodies[sole.body];
    GaitdFootTruth& foot = truth->feet[side];
    Eigen::Map<Eigen::Vector3d>(foot.force) = feet_[side].force;
    foot.slip = feet_[side].slip;
    foot.penetration = feet_[side].penetration;
    foot.side_force = feet_[side].side_force;
    Eigen::Map<Eigen::Vector3d>(foot.position) = motion.point(Eigen::Vector3d(sole.origin));
    Eigen::Quaterniond q(motion.R_WB);
    q = q * Eigen::Quaterniond(sole.orientation);
    q.normalize();
    store(q, foot.orientation);
  }
  const Eigen::Index n = model_.joint_count;
  Eigen::Map<Eigen::VectorXd>(truth->joint_position, n) = state.q;
  Eigen::Map<Eigen::VectorXd>(truth->joint_velocity, n) = state.u.tail(n);
  Eigen::Map<Eigen::VectorXd>(truth->joint_torque, n) = torque;
}

}  // namespace gaitd::sim

// SPDX-License-Identifier: Apache-2.0
#include "random_model.h"

#include <cstdio>
#include <stdexcept>

#include "gaitd/dynamics/urdf.h"

namespace gaitd::dynamics {

Eigen::VectorXd Random::vector(int size, double bound) {
  Eigen::VectorXd v(size);
  for (double& x : v) x = uniform(-bound, bound);
  return v;
}

Eigen::Vector3d Random::direction() {
  Eigen::Vector3d v;
  do {
    v = vector(3, 1);
  } while (v.norm() < 0.1 || v.norm() > 1);
  return v.normalized();
}

Eigen::Quaterniond Random::rotation() {
  return Eigen::Quaterniond(Eigen::AngleAxisd(uniform(-3.1, 3.1), direction()));
}

RandomState::RandomState(int joint_count, Random* random)
    : p_WP(random->vector(3, 1)),
      R_WP(random->rotation()),
      V_P(random->vector(6, 2)),
      q(random->vector(joint_count, 2)),
      qd(random->vector(joint_count, 4)) {}

Eigen::VectorXd RandomState::v() const {
  Eigen::VectorXd result(kBaseSize + qd.size());
  result << V_P, qd;
  return result;
}

GaitdModel make_random_model(int joint_count, Random* random) {
  GaitdModel model{};
  model.size = sizeof model;
  model.joint_count = joint_count;
  model.body_count = joint_count + 1;
  model.gravity = random->uniform(1, 12);
  for (int i = 0; i <= joint_count; ++i) {
    GaitdBody& body = model.bodies[i];
    std::snprintf(body.name, sizeof body.name, "body%d", i);
    body.joint = i - 1;
    body.parent = i == 0 ? -1 : random->integer(0, i - 1);
    body.mass = random->uniform(0.1, 10);
    Eigen::Vector3d::Map(body.com) = random->vector(3, 0.2);
    // Of a solid ellipsoid.
    const Eigen::Array3d a = Eigen::Array3d(0.05, 0.1, 0.15) * random->uniform(0.5, 2);
    const Eigen::Vector3d moments = body.mass / 5 * (a.square().sum() - a.square());
    const Eigen::Matrix3d R = random->rotation().toRotationMatrix();
    const Eigen::Matrix3d m = R * moments.asDiagonal() * R.transpose();
    const double inertia[6] = {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)};
    std::copy_n(inertia, 6, body.inertia);
    model.total_mass += body.mass;
  }
  for (int i = 0; i < joint_count; ++i) {
    GaitdJoint& joint = model.joints[i];
    std::snprintf(joint.name, sizeof joint.name, "joint%d", i);
    joint.type = random->uniform(0, 1) < 0.7 ? GAITD_JOINT_REVOLUTE : GAITD_JOINT_PRISMATIC;
    joint.parent_body = model.bodies[i + 1].parent;
    joint.child_body = i + 1;
    Eigen::Vector3d::Map(joint.origin) = random->vector(3, 0.4);
    Eigen::Vector4d::Map(joint.orientation) = random->rotation().coeffs();
    Eigen::Vector3d::Map(joint.axis) = random->direction();
    joint.position_min = -3;
    joint.position_max = 3;
    joint.velocity_limit = 10;
    joint.effort_limit = 100;
  }
  return model;
}

GaitdModel load_atlas() {
  const UrdfResult result = load_urdf(GAITD_ATLAS_URDF);
  if (!result.ok()) throw std::runtime_error(result.errors[0]);
  return result.model;
}

}  // namespace gaitd::dynamics

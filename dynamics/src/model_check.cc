// SPDX-License-Identifier: Apache-2.0
#include "gaitd/dynamics/model_check.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace gaitd::dynamics {
namespace {

// Published inertias are rounded to a few digits, so the inequalities hold to about this fraction
// of the largest moment.
constexpr double kInertiaTolerance = 1e-6;
// An inertia printed with two digits may be off by this fraction of its largest moment.
constexpr double kRounding = 0.05;
constexpr double kUnitTolerance = 1e-9;

template <typename... Args>
std::string format(const char* pattern, Args... args) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, args...);
  return text;
}

class Checker {
 public:
  explicit Checker(const GaitdModel& model) : model_(model) {}

  std::vector<std::string> run() {
    if (check_counts()) {
      for (int i = 0; i < model_.body_count; ++i) check_body(i);
      for (int i = 0; i < model_.joint_count; ++i) check_joint(i);
    }
    return std::move(errors_);
  }

 private:
  bool check_counts() {
    const int bodies = model_.body_count;
    const int joints = model_.joint_count;
    if (joints < 0 || joints > GAITD_MAX_JOINTS || bodies != joints + 1) {
      errors_.push_back(
          format("model: %d joints and %d bodies, expected 0 to %d joints and one body more",
                 joints, bodies, static_cast<int>(GAITD_MAX_JOINTS)));
      return false;
    }
    if (!(model_.gravity > 0) || !std::isfinite(model_.gravity)) {
      errors_.push_back(format("model: gravity is %g m/s^2, expected above 0", model_.gravity));
    }
    return true;
  }

  static bool is_finite(const double* values, int count) {
    for (int i = 0; i < count; ++i) {
      if (!std::isfinite(values[i])) return false;
    }
    return true;
  }

  static std::string label(const char* kind, int index, const char* name) {
    const int length = static_cast<int>(::strnlen(name, GAITD_NAME_SIZE));
    return format("%s %d '%.*s'", kind, index, length, name);
  }

  void add(const std::string& where, const std::string& what) {
    errors_.push_back(where + ": " + what);
  }

  void check_body(int i) {
    const GaitdBody& body = model_.bodies[i];
    const std::string where = label("body", i, body.name);
    if (body.joint != i - 1) {
      add(where, format("moved by joint %d, expected %d", body.joint, i - 1));
    }
    const bool parent_ok = i == 0 ? body.parent == -1 : body.parent >= 0 && body.parent < i;
    if (!parent_ok) add(where, format("parent %d, expected a body before it", body.parent));
    if (!(body.mass > 0) || !std::isfinite(body.mass)) {
      add(where, format("mass is %g kg, expected above 0", body.mass));
    }
    if (!is_finite(body.com, 3)) add(where, "the centre of mass is not finite");
    const double* v = body.inertia;
    Eigen::Matrix3d inertia;
    inertia << v[0], v[1], v[2], v[1], v[3], v[4], v[2], v[4], v[5];
    const std::string reason = check_inertia(inertia, false);
    if (!reason.empty()) add(where, reason);
  }

  void check_joint(int i) {
    const GaitdJoint& joint = model_.joints[i];
    const std::string where = label("joint", i, joint.name);
    if (joint.type != GAITD_JOINT_REVOLUTE && joint.type != GAITD_JOINT_PRISMATIC) {
      add(where, format("type %d, expected revolute or prismatic", joint.type));
    }
    if (joint.child_body != i + 1) {
      add(where, format("moves body %d, expected %d", joint.child_body, i + 1));
    }
    if (joint.parent_body != model_.bodies[i + 1].parent) {
      add(where, format("parent body %d, but body %d names %d", joint.parent_body, i + 1,
                        model_.bodies[i + 1].parent));
    }
    if (!is_finite(joint.origin, 3)) add(where, "the origin is not finite");
    check_unit(where, "orientation", joint.orientation, 4);
    check_unit(where, "axis", joint.axis, 3);
    if (!(joint.position_min <= joint.position_max)) {
      add(where, format("position limits %g to %g, expected lower below upper", joint.position_min,
                        joint.position_max));
    }
    check_positive(where, "velocity limit", joint.velocity_limit);
    check_positive(where, "effort limit", joint.effort_limit);
    check_not_negative(where, "rotor inertia", joint.rotor_inertia);
    check_not_negative(where, "damping", joint.damping);
  }

  void check_unit(const std::string& where, const char* what, const double* values, int count) {
    const double norm = Eigen::Map<const Eigen::VectorXd>(values, count).norm();
    if (!(std::abs(norm - 1) < kUnitTolerance)) {
      add(where, format("length of the %s is %.12g, expected 1", what, norm));
    }
  }

  void check_positive(const std::string& where, const char* what, double value) {
    if (!(value > 0)) add(where, format("%s is %g, expected above 0", what, value));
  }

  void check_not_negative(const std::string& where, const char* what, double value) {
    if (!(value >= 0) || !std::isfinite(value)) {
      add(where, format("%s is %g, expected 0 or above", what, value));
    }
  }

  const GaitdModel& model_;
  std::vector<std::string> errors_;
};

}  // namespace

std::string check_inertia(const Eigen::Matrix3d& inertia, bool allow_zero) {
  if (!inertia.allFinite()) return "the inertia is not finite";
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  const double smallest = moments[0];
  const double largest = moments[2];
  const double slack = kInertiaTolerance * std::abs(largest);
  const bool positive = allow_zero ? smallest >= -slack : smallest > 0;
  if (!positive) {
    return format("the inertia is not positive definite: principal moments %g, %g, %g kg m^2",
                  moments[0], moments[1], moments[2]);
  }
  if (largest > moments[0] + moments[1] + slack) {
    return format(
        "no rigid body has this inertia: principal moments %g, %g, %g kg m^2, expected none above "
        "the sum of the two others",
        moments[0], moments[1], moments[2]);
  }
  return {};
}

bool make_physical(Eigen::Matrix3d* inertia, bool far) {
  if (!inertia->allFinite()) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(*inertia);
  // A body with moments a, b, c has the second moments of mass (b + c - a) / 2 and so on, none of
  // which may be negative.
  const Eigen::Vector3d& moments = solver.eigenvalues();
  if (!(moments[2] > 0)) return false;
  const Eigen::Vector3d extents = Eigen::Vector3d::Constant(0.5 * moments.sum()) - moments;
  const bool rounded = extents.minCoeff() >= -kRounding * moments[2];
  if (!rounded && !(far && moments[0] > 0)) return false;
  const Eigen::Vector3d possible = extents.cwiseMax(1e-6 * moments[2]);
  const Eigen::Vector3d nearest = Eigen::Vector3d::Constant(possible.sum()) - possible;
  *inertia = solver.eigenvectors() * nearest.asDiagonal() * solver.eigenvectors().transpose();
  return true;
}

std::vector<std::string> check_model(const GaitdModel& model) { return Checker(model).run(); }

}  // namespace gaitd::dynamics

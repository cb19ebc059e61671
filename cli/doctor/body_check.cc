// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/doctor/robot_doctor.h"

namespace gaitd::doctor {
namespace {

constexpr double kHeavy = 0.6;      // of the total mass, one body
constexpr double kLight = 0.001;    // kg
constexpr double kWide = 0.5;       // m, radius of gyration
constexpr double kNarrow = 0.003;   // m
constexpr double kFar = 0.6;        // m, centre of mass from the joint of the body
constexpr double kStrong = 5000.0;  // N m, no drive of a walking robot
constexpr double kFast = 60.0;      // rad/s

Eigen::Vector3d principal_moments(const GaitdBody& body) {
  const double* i = body.inertia;
  Eigen::Matrix3d inertia;
  inertia << i[0], i[1], i[2], i[1], i[3], i[4], i[2], i[4], i[5];
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

void check_body(const GaitdModel& model, const GaitdBody& body, Findings* findings) {
  const auto warn = [&](const std::string& what, const char* advice) {
    findings->push_back({"masses", Severity::kWarning, body.name + (": " + what), advice});
  };
  if (body.mass > kHeavy * model.total_mass) {
    warn(format("%.1f kg of %.1f kg in one link", body.mass, model.total_mass),
         "is the mass of the whole robot in it?");
  }
  if (body.mass < kLight) {
    warn(format("only %.2g kg", body.mass), "fix the link to its neighbour, or give its mass");
  }
  const Eigen::Vector3d moments = principal_moments(body);
  // The moments of a solid body are m r^2 with r of its own size.
  const double widest = std::sqrt(moments.maxCoeff() / body.mass);
  const double narrowest = std::sqrt(std::max(0.0, moments.minCoeff()) / body.mass);
  if (widest > kWide || narrowest < kNarrow) {
    warn(format("inertia of a body between %.3f m and %.3f m in size (radius of gyration)",
                narrowest, widest),
         "units (kg m^2, not g mm^2) and point (centre of mass, not the joint) of the inertia");
  }
  const double distance = Eigen::Map<const Eigen::Vector3d>(body.com).norm();
  if (distance > kFar) {
    warn(format("centre of mass %.2f m from its joint", distance), "units (m) and frame of it");
  }
}

}  // namespace

Findings check_bodies(const GaitdModel& model) {
  Findings findings;
  for (int i = 0; i < model.body_count; ++i) check_body(model, model.bodies[i], &findings);
  // Joints with the same figures are one finding: a URDF that has them has them everywhere.
  std::map<std::pair<double, double>, std::vector<const char*>> placeholders;
  for (const GaitdJoint& joint : std::span(model.joints).first(model.joint_count)) {
    if (joint.effort_limit <= kStrong && joint.velocity_limit <= kFast) continue;
    placeholders[{joint.effort_limit, joint.velocity_limit}].push_back(joint.name);
  }
  for (const auto& [limits, joints] : placeholders) {
    const std::string others =
        joints.size() > 1 ? format(" and %zu other joints", joints.size() - 1) : std::string();
    findings.push_back({"limits", Severity::kWarning,
                        format("%s%s: %.4g N m and %.4g rad/s", joints.front(), others.c_str(),
                               limits.first, limits.second),
                        "looks like a placeholder: give effort and velocity of the drive"});
  }
  if (findings.empty()) {
    findings.push_back({"masses", Severity::kOk,
                        format("%d bodies, %.1f kg, inertias of bodies of their size",
                               model.body_count, model.total_mass),
                        ""});
  }
  return findings;
}

}  // namespace gaitd::doctor

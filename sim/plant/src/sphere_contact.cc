// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/sphere_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace gaitd::sim {
namespace {

// Is `body` on the way from the pelvis to a foot?
bool is_leg(const GaitdModel& model, int body) {
  for (const GaitdFoot& foot : model.feet) {
    for (int i = foot.body; i >= 0; i = model.bodies[i].parent) {
      if (i == body) return true;
    }
  }
  return false;
}

bool is_leaf(const GaitdModel& model, int body) {
  for (int i = 1; i < model.body_count; ++i) {
    if (model.bodies[i].parent == body) return false;
  }
  return true;
}

}  // namespace

std::vector<Sphere> make_spheres(const GaitdModel& model) {
  std::vector<Sphere> spheres;
  const auto at_com = [&](int body, double radius) {
    spheres.push_back({body, Eigen::Vector3d(model.bodies[body].com), radius});
  };
  at_com(0, 0.10);
  if (model.chest_body > 0) at_com(model.chest_body, 0.12);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdLeg& leg = model.legs[side];
    if (leg.knee >= 0 && leg.knee < model.joint_count) {
      spheres.push_back({model.joints[leg.knee].child_body, Eigen::Vector3d::Zero(), 0.06});
    }
    // The ankle: smaller than its height, so that it never touches what the sole stands on.
    const GaitdFoot& foot = model.feet[side];
    const Eigen::Matrix3d R_BS = Eigen::Quaterniond(foot.sole.orientation).toRotationMatrix();
    const double height = -R_BS.col(2).dot(Eigen::Vector3d(foot.sole.origin));
    if (height > 0.02) {
      spheres.push_back({foot.body, Eigen::Vector3d::Zero(), std::min(0.04, 0.5 * height)});
    }
  }
  for (int body = 1; body < model.body_count; ++body) {
    if (is_leg(model, body)) continue;
    spheres.push_back({body, Eigen::Vector3d::Zero(), 0.05});
    if (is_leaf(model, body) && body != model.chest_body) at_com(body, 0.05);
  }
  return spheres;
}

SphereContact::SphereContact(std::vector<Sphere> spheres) : spheres_(std::move(spheres)) {
  law_.stiffness = 2e5;
}

void SphereContact::detect(const Multibody& multibody, const Terrain& terrain,
                           ContactMemory* memory, std::vector<Contact>* contacts) {
  const Eigen::Vector3d pelvis = multibody.body(0).p_WB;
  double reach = 0;
  for (const Sphere& sphere : spheres_) {
    const Eigen::Vector3d center = multibody.body(sphere.body).point(sphere.center);
    reach = std::max(reach, (center - pelvis).norm() + sphere.radius);
  }
  terrain.find_near(pelvis, reach, &near_);
  for (size_t i = 0; i < spheres_.size(); ++i) {
    const Sphere& sphere = spheres_[i];
    const BodyMotion& motion = multibody.body(sphere.body);
    const Eigen::Vector3d center = motion.point(sphere.center);
    const auto add = [&](int solid, const Eigen::Vector3d& normal, double depth, double friction) {
      Contact contact;
      contact.body = sphere.body;
      contact.law = law_;
      contact.normal = normal;
      contact.depth = depth;
      contact.friction = friction;
      contact.p_W = center - (sphere.radius - depth) * normal;
      contact.p_B = motion.R_WB.transpose() * (contact.p_W - motion.p_WB);
      contact.memory =
          memory->touch(contact_key(ContactKind::kSphere, static_cast<int>(i), solid, 0));
      contacts->push_back(contact);
    };
    if (terrain.has_ground() && center.z() - sphere.radius < terrain.ground_z()) {
      add(Terrain::kGround, Eigen::Vector3d::UnitZ(),
          terrain.ground_z() - center.z() + sphere.radius, terrain.ground_friction());
    }
    for (const int index : near_) {
      const Box& box = terrain.boxes()[static_cast<size_t>(index)];
      const Eigen::Vector3d local = box.R_WB.transpose() * (center - box.center);
      const Eigen::Vector3d closest = local.cwiseMax(-box.half).cwiseMin(box.half);
      const double distance = (local - closest).norm();
      if (distance >= sphere.radius) continue;
      if (distance > 1e-9) {
        add(index, box.R_WB * ((local - closest) / distance), sphere.radius - distance,
            box.friction);
      } else {
        const auto depth = box.depths(center);
        const auto nearest = std::min_element(depth.begin(), depth.end());
        add(index, box.normal(static_cast<int>(nearest - depth.begin())), sphere.radius + *nearest,
            box.friction);
      }
    }
  }
}

}  // namespace gaitd::sim

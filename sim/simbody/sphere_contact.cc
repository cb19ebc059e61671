// SPDX-License-Identifier: Apache-2.0
#include "sphere_contact.h"

#include <algorithm>
#include <utility>

namespace gaitd::sim {
namespace {

constexpr double kStiffness = 2e5;  // N/m of a robot's shell on hard ground

}  // namespace

SphereContact::SphereContact(std::vector<BodySphere> spheres, std::optional<double> stiffness)
    : spheres_(std::move(spheres)) {
  law_.stiffness = std::min(kStiffness, stiffness.value_or(kStiffness));
}

void SphereContact::detect(const Multibody& multibody, const Terrain& terrain,
                           ContactMemory* memory, std::vector<Contact>* contacts) {
  const Eigen::Vector3d pelvis = multibody.body(0).p_WB;
  double reach = 0;
  for (const BodySphere& sphere : spheres_) {
    const Eigen::Vector3d center = multibody.body(sphere.body).point(sphere.center);
    reach = std::max(reach, (center - pelvis).norm() + sphere.radius);
  }
  terrain.find_near(pelvis, reach, &near_);
  for (size_t i = 0; i < spheres_.size(); ++i) {
    const BodySphere& sphere = spheres_[i];
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
    if (const HeightField* field = terrain.height_field()) {
      const HeightField::Depth below = field->depth(center);
      const HeightField::Depth lowest = field->depth(center - sphere.radius * below.normal);
      if (lowest.depth > 0)
        add(Terrain::kHeightField, below.normal, lowest.depth, field->friction());
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

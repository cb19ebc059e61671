// SPDX-License-Identifier: Apache-2.0
#include "contact_model.h"

#include <utility>

namespace gaitd::sim {

ContactModel::ContactModel(const GaitdModel& model, Terrain terrain)
    : terrain_(std::move(terrain)), spheres_(make_body_spheres(model), terrain_.stiffness()) {
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    feet_.emplace_back(model.feet[side], side, terrain_.stiffness());
    foot_bodies_.push_back(model.feet[side].body);
  }
}

void ContactModel::reset() {
  memory_.clear();
  contacts_.clear();
  slip_.clear();
}

void ContactModel::detect(const Multibody& multibody) {
  contacts_.clear();
  memory_.begin_step();
  for (size_t side = 0; side < feet_.size(); ++side) {
    feet_[side].detect(multibody.body(foot_bodies_[side]), terrain_, &memory_, &contacts_);
  }
  spheres_.detect(multibody, terrain_, &memory_, &contacts_);
  for (Contact& contact : contacts_) {
    const Eigen::Vector3d& kept = memory_.entry(contact.memory).deflection;
    contact.deflection = kept - kept.dot(contact.normal) * contact.normal;
  }
}

void ContactModel::finish(const Multibody& multibody) {
  slip_.assign(contacts_.size(), Eigen::Vector3d::Zero());
  for (size_t i = 0; i < contacts_.size(); ++i) {
    Contact& contact = contacts_[i];
    const Eigen::Vector3d travel = multibody.body(contact.body).point(contact.p_B) - contact.p_W;
    Eigen::Vector3d& kept = memory_.entry(contact.memory).deflection;
    if (contact.mode == ContactMode::kStick) {
      kept = contact.deflection + travel;
    } else if (contact.mode == ContactMode::kSlide) {
      kept = contact.slide_direction *
             (-contact.friction * contact.normal_force() / contact.law.stiffness);
      slip_[i] = travel - (kept - contact.deflection);
    } else {
      kept.setZero();
    }
  }
  memory_.end_step();
}

}  // namespace gaitd::sim

// SPDX-License-Identifier: Apache-2.0
// All contacts of the robot with the terrain, and what they remember.
#ifndef GAITD_SIM_CONTACT_MODEL_H_
#define GAITD_SIM_CONTACT_MODEL_H_

#include <vector>

#include "contact.h"
#include "contact_memory.h"
#include "foot_contact.h"
#include "gaitd/abi/types.h"
#include "gaitd/sim/terrain.h"
#include "multibody.h"
#include "sphere_contact.h"

namespace gaitd::sim {

class ContactModel {
 public:
  ContactModel(const GaitdModel& model, Terrain terrain);

  // Forgets every contact.
  void reset();

  // Finds the contacts in the state of `multibody`, each with its tangential deflection.
  void detect(const Multibody& multibody);

  // After the step: moves each anchor along, `multibody` being in the new state.
  void finish(const Multibody& multibody);

  std::vector<Contact>& contacts() { return contacts_; }
  const std::vector<Contact>& contacts() const { return contacts_; }
  // m, W: how far contact i slid over the terrain in the step that finish() closed: the motion of
  // its material point less what its tangential spring took up. Zero while it sticks.
  const Eigen::Vector3d& slip(size_t i) const { return slip_[i]; }

  const Terrain& terrain() const { return terrain_; }
  const std::vector<FootContact>& feet() const { return feet_; }

 private:
  Terrain terrain_;
  std::vector<FootContact> feet_;
  std::vector<int> foot_bodies_;
  SphereContact spheres_;
  ContactMemory memory_;
  std::vector<Contact> contacts_;
  std::vector<Eigen::Vector3d> slip_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_CONTACT_MODEL_H_

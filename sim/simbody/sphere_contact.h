// SPDX-License-Identifier: Apache-2.0
// Coarse contact of everything but the soles.
#ifndef GAITD_SIM_SPHERE_CONTACT_H_
#define GAITD_SIM_SPHERE_CONTACT_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "contact.h"
#include "contact_memory.h"
#include "gaitd/sim/body_spheres.h"
#include "gaitd/sim/terrain.h"
#include "multibody.h"

namespace gaitd::sim {

class SphereContact {
 public:
  // `stiffness` (N/m) of the ground under a foot; none: it is hard.
  SphereContact(std::vector<BodySphere> spheres, std::optional<double> stiffness);

  // Appends every contact of the spheres.
  void detect(const Multibody& multibody, const Terrain& terrain, ContactMemory* memory,
              std::vector<Contact>* contacts);

 private:
  std::vector<BodySphere> spheres_;
  ContactLaw law_;
  std::vector<int> near_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_SPHERE_CONTACT_H_

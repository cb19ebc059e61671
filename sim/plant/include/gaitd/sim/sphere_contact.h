// SPDX-License-Identifier: Apache-2.0
// Coarse contact of everything but the soles: spheres on the trunk, the knees, the ankles and along
// the arms, so that a robot that has fallen lies on the terrain. The robot never touches itself.
#ifndef GAITD_SIM_SPHERE_CONTACT_H_
#define GAITD_SIM_SPHERE_CONTACT_H_

#include <Eigen/Core>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/sim/contact.h"
#include "gaitd/sim/contact_memory.h"
#include "gaitd/sim/multibody.h"
#include "gaitd/sim/terrain.h"

namespace gaitd::sim {

struct Sphere {
  int body;
  Eigen::Vector3d center;  // m, body frame
  double radius;           // m
};

// The spheres of a robot, found from its structure.
std::vector<Sphere> make_spheres(const GaitdModel& model);

class SphereContact {
 public:
  explicit SphereContact(std::vector<Sphere> spheres);

  // Appends every contact of the spheres.
  void detect(const Multibody& multibody, const Terrain& terrain, ContactMemory* memory,
              std::vector<Contact>* contacts);

 private:
  std::vector<Sphere> spheres_;
  ContactLaw law_;
  std::vector<int> near_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_SPHERE_CONTACT_H_

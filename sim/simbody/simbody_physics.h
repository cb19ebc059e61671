// SPDX-License-Identifier: Apache-2.0
// Simbody's multibody dynamics with our contacts and our linearly implicit step.
#ifndef GAITD_SIM_SIMBODY_PHYSICS_H_
#define GAITD_SIM_SIMBODY_PHYSICS_H_

#include <memory>
#include <span>
#include <vector>

#include "contact_model.h"
#include "dynamics_terms.h"
#include "gaitd/sim/physics.h"
#include "integrator.h"
#include "multibody.h"

namespace gaitd::sim {

class SimbodyPhysics : public Physics {
 public:
  SimbodyPhysics(const GaitdModel& model, const Terrain& terrain, double time_step);
  static std::unique_ptr<Physics> make(const GaitdModel& model, const Terrain& terrain,
                                       double time_step);

  void place(const State& state) override;
  bool step(std::span<const BodyForce> forces, Drives* drives) override;
  bool can_change_masses() const override { return true; }
  void change_masses(const GaitdModel& model) override;
  const State& state() const override { return state_; }
  Bodies bodies() const override { return multibody_.bodies(); }
  std::span<const Touch> touches() const override { return touches_; }
  Eigen::VectorXd joint_inertia() const override;
  double resting_depth() const override;

  // J, relative to the height of W's origin; rotors included. Contacts and stops are not.
  double energy() const;
  const Multibody& multibody() const { return multibody_; }
  const ContactModel& contacts() const { return contacts_; }
  const Integrator& integrator() const { return integrator_; }

 private:
  void move_to(const State& state);
  void keep_touches();

  GaitdModel model_;
  Multibody multibody_;
  DynamicsTerms terms_;
  ContactModel contacts_;
  Integrator integrator_;
  State state_;
  Eigen::VectorXd external_;
  std::vector<Touch> touches_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_SIMBODY_PHYSICS_H_

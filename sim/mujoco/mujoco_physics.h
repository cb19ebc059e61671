// SPDX-License-Identifier: Apache-2.0
// MuJoCo as the physics of the simulated robot: a second opinion on everything that the first one
// (our contacts on Simbody's multibody dynamics) says.
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <span>
#include <vector>

#include "gaitd/sim/body_spheres.h"
#include "gaitd/sim/joint_law.h"
#include "gaitd/sim/physics.h"

namespace gaitd::sim {

class MujocoPhysics : public Physics {
 public:
  // Throws std::invalid_argument with MuJoCo's own words.
  MujocoPhysics(const GaitdModel& model, const Terrain& terrain, double time_step);
  static std::unique_ptr<Physics> make(const GaitdModel& model, const Terrain& terrain,
                                       double time_step);

  void place(const State& state) override;
  bool step(std::span<const BodyForce> forces, Drives* drives) override;
  bool can_change_masses() const override { return true; }
  void change_masses(const GaitdModel& model) override;
  const State& state() const override { return state_; }
  Bodies bodies() const override { return motions_; }
  std::span<const Touch> touches() const override { return touches_; }
  Eigen::VectorXd joint_inertia() const override;
  double resting_depth() const override;

 private:
  struct DeleteModel {
    void operator()(mjModel* m) const { mj_deleteModel(m); }
  };
  struct DeleteData {
    void operator()(mjData* d) const { mj_deleteData(d); }
  };

  void load_model();
  void soften_ground(double stiffness);
  void apply(std::span<const BodyForce> forces);
  bool solve();
  void update_positions();
  void keep_touches();
  void rest_on_touches();
  void find_slips();
  void update_state();

  static constexpr int kMaxSolves = 5;

  GaitdModel model_;
  std::vector<BodySphere> spheres_;  // of the model without loads
  const Terrain terrain_;
  double h_;  // s
  std::unique_ptr<mjModel, DeleteModel> m_;
  std::unique_ptr<mjData, DeleteData> d_;
  JointLaw joints_;
  std::vector<int> body_;   // MuJoCo's index of each body,
  std::vector<int> place_;  // of each joint's position
  std::vector<int> rate_;   // and of its rate
  std::vector<int> owner_;  // of each of MuJoCo's bodies: ours, -1: the ground
  std::vector<int> foot_;   // of each geom: GAITD_LEFT, GAITD_RIGHT or -1
  State state_;
  Eigen::VectorXd joint_rate_;  // n, after the step
  std::vector<BodyMotion> motions_;
  std::vector<Touch> touches_;
  std::vector<char> slides_;  // each of touches_: its friction is all that it can be
};

}  // namespace gaitd::sim

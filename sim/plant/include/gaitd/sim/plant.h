// SPDX-License-Identifier: Apache-2.0
// The simulated robot in its world, advanced one control period at a time.
#ifndef GAITD_SIM_PLANT_H_
#define GAITD_SIM_PLANT_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gaitd/abi/backend.h"
#include "gaitd/sim/config.h"
#include "gaitd/sim/drives.h"
#include "gaitd/sim/hoist.h"
#include "gaitd/sim/physics.h"
#include "gaitd/sim/sensors.h"
#include "gaitd/sim/truth.h"

namespace gaitd::sim {

// Not thread-safe; one thread at a time. The same configuration and commands give the same bits.
class Plant {
 public:
  // `period`: control period (s), a whole multiple of config.time_step. `model` is the
  // controller's; the errors of `config` are applied here. Throws std::invalid_argument if it
  // cannot be simulated.
  Plant(const GaitdModel& model, const Config& config, double period, const PhysicsFactory& make);

  // Back to the start state, time 0 and the first random number. Disturbances end, loads are gone.
  void reset();

  // One control period under `commands`. False: the simulation diverged; only reset() helps.
  bool advance(const GaitdJointCommands& commands);

  // A force from the next plant step on; any number at once. False: it is not valid().
  bool disturb(const GaitdDisturbance& disturbance);

  // Is there such a body, are the figures finite and the duration positive?
  static bool valid(const GaitdDisturbance& disturbance, int body_count);

  // What a body carries from the next period on, in place of what it carried; mass 0: nothing.
  // False: it is not valid(), or too many bodies carry something. Only where can_carry().
  bool can_carry() const { return physics_->can_change_masses(); }
  bool carry(const GaitdLoad& load);
  static bool valid(const GaitdLoad& load, int body_count);

  int64_t tick() const { return tick_; }
  double time() const;  // s since the start
  const State& state() const { return physics_->state(); }
  const GaitdModel& model() const { return model_; }  // as simulated, with what it carries
  const Physics& physics() const { return *physics_; }

  void read(GaitdSensors* sensors) const;
  void read(GaitdTruth* truth) const;

  // Puts the robot into `state` at rest of all else (contacts, drives, sensors start over there);
  // reset() returns to the configured start. For tests.
  void place(const State& state);

 private:
  struct Push {
    BodyForce force;
    double remaining;  // s
  };

  bool step();
  void update_forces();
  void take_loads();

  GaitdModel own_;    // as simulated
  GaitdModel model_;  // with loads_
  GaitdLoads loads_{};
  bool loads_changed_ = false;
  Config config_;
  double period_;
  int steps_per_period_;
  std::unique_ptr<Physics> physics_;
  std::unique_ptr<Drives> drives_;
  std::optional<Hoist> hoist_;
  Sensors sensors_;
  Truth truth_;
  State start_;
  std::vector<Push> pushes_;
  std::vector<BodyForce> forces_;  // of the present step
  FootWrench wrench_[GAITD_MAX_FEET];
  Eigen::VectorXd joint_rate_;
  int64_t step_ = 0;
  int64_t tick_ = 0;
  bool diverged_ = false;
};

// Commands that a plant cannot take: "" if it can, else what is wrong (wrong joint count, unknown
// mode, figures that are not finite, negative gains). Returns constant text; does not allocate.
const char* check_commands(const GaitdJointCommands& commands, int joint_count);

}  // namespace gaitd::sim

#endif  // GAITD_SIM_PLANT_H_

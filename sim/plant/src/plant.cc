// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/plant.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "gaitd/sdk/loads.h"
#include "gaitd/sim/model_error.h"
#include "gaitd/sim/start_state.h"
#include "gaitd/sim/terrain.h"

namespace gaitd::sim {
namespace {

GaitdModel simulated_model(const GaitdModel& model, const Config& config) {
  std::string text;
  for (const std::string& error : check_simulated_model(model)) text += error + "\n";
  if (!text.empty()) {
    text.pop_back();
    throw std::invalid_argument(text);
  }
  const GaitdModel other = apply_model_error(model, config.body_errors);
  return config.drives ? with_armature(other, *config.drives, config.seed) : other;
}

constexpr double kDeepestStart = 0.02;  // m

}  // namespace

Plant::Plant(const GaitdModel& model, const Config& config, double period,
             const PhysicsFactory& make)
    : own_(simulated_model(model, config)),
      model_(own_),
      config_(config),
      period_(period),
      steps_per_period_(static_cast<int>(std::lround(period / config.time_step))),
      physics_(make(model_, Terrain(config.terrain, config.friction_scale), config.time_step)),
      sensors_(model_, config.sensors, config.time_step, steps_per_period_,
               {config.seed, config.episode}),
      truth_(model_) {
  start_ = make_start_state(model_, config, physics_.get());
  physics_->place(start_);
  drives_ = make_drives(model, config, physics_->joint_inertia());
  if (config.start.hoist) hoist_.emplace(model_, *config.start.hoist);
  reset();
  for (const Touch& touch : physics_->touches()) {
    if (touch.depth < kDeepestStart) continue;
    throw std::invalid_argument("start: expected the robot to stand on the terrain, got " +
                                std::string(model_.bodies[touch.body].name) + " " +
                                std::to_string(touch.depth) + " m inside it");
  }
}

void Plant::reset() { place(start_); }

void Plant::place(const State& state) {
  step_ = 0;
  tick_ = 0;
  diverged_ = false;
  pushes_.clear();
  loads_changed_ = loads_changed_ || loads_.count > 0;
  loads_ = {};
  take_loads();
  drives_->reset();
  truth_.reset();
  physics_->place(state);
  if (hoist_) hoist_->reset(physics_->bodies());
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const int body = sensor_body(model_.feet[side]);
    wrench_[side] = sum_foot_wrench(model_, side, physics_->bodies()[body], physics_->touches());
  }
  truth_.update(physics_->touches());
  sensors_.reset(physics_->state(), physics_->bodies(), drives_->readings(), wrench_);
}

double Plant::time() const { return static_cast<double>(tick_) * period_; }

bool Plant::advance(const GaitdJointCommands& commands) {
  if (diverged_) return false;
  take_loads();
  drives_->command(commands, step_);
  if (hoist_) hoist_->command(commands, period_);
  for (int i = 0; i < steps_per_period_; ++i) {
    if (!step()) {
      diverged_ = true;
      return false;
    }
  }
  ++tick_;
  return true;
}

bool Plant::step() {
  const State& state = physics_->state();
  joint_rate_ = state.u.tail(model_.joint_count);
  drives_->begin_step(
      step_, {state.q, joint_rate_, sensors_.measured_position(), sensors_.measured_velocity()});
  update_forces();
  // The forces act where the feet were before the step.
  BodyMotion moved[GAITD_MAX_FEET];
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    moved[side] = physics_->bodies()[sensor_body(model_.feet[side])];
  }
  if (!physics_->step(forces_, drives_.get())) return false;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    wrench_[side] = sum_foot_wrench(model_, side, moved[side], physics_->touches());
  }
  truth_.update(physics_->touches());
  sensors_.sample(state, physics_->bodies(), drives_->readings(), wrench_);
  ++step_;
  return true;
}

void Plant::update_forces() {
  forces_.clear();
  if (hoist_) hoist_->add_forces(physics_->bodies(), &forces_);
  for (Push& push : pushes_) {
    // A push that ends within the step leaves its share of the impulse.
    push.force.share = std::min(1.0, push.remaining / config_.time_step);
    forces_.push_back(push.force);
    push.remaining -= config_.time_step;
  }
  std::erase_if(pushes_,
                [&](const Push& push) { return push.remaining < 1e-9 * config_.time_step; });
}

bool Plant::valid(const GaitdDisturbance& disturbance, int body_count) {
  bool good = disturbance.body >= 0 && disturbance.body < body_count &&
              std::isfinite(disturbance.duration) && disturbance.duration > 0;
  for (int k = 0; k < 3; ++k) {
    good = good && std::isfinite(disturbance.point[k]) && std::isfinite(disturbance.force[k]);
  }
  return good;
}

bool Plant::disturb(const GaitdDisturbance& disturbance) {
  if (!valid(disturbance, model_.body_count)) return false;
  pushes_.push_back({{disturbance.body, Eigen::Vector3d(disturbance.point),
                      Eigen::Vector3d(disturbance.force), 1},
                     disturbance.duration});
  return true;
}

bool Plant::valid(const GaitdLoad& load, int body_count) {
  bool good =
      load.body >= 0 && load.body < body_count && std::isfinite(load.mass) && load.mass >= 0;
  for (const double x : load.com) good = good && std::isfinite(x);
  return good;
}

bool Plant::carry(const GaitdLoad& load) {
  if (!valid(load, model_.body_count) || !sdk::put_load(load, loads_)) return false;
  loads_changed_ = true;
  return true;
}

void Plant::take_loads() {
  if (!std::exchange(loads_changed_, false)) return;
  model_ = sdk::loaded(own_, loads_);
  truth_.change_masses(model_);
  physics_->change_masses(model_);
}

void Plant::read(GaitdSensors* sensors) const { sensors_.read(tick_, time(), sensors); }

void Plant::read(GaitdTruth* truth) const {
  truth_.read(time(), physics_->state(), physics_->bodies(), drives_->torque(), truth);
}

const char* check_commands(const GaitdJointCommands& commands, int joint_count) {
  if (commands.joint_count != joint_count) return "the joint count is not that of the robot";
  for (int j = 0; j < joint_count; ++j) {
    const GaitdJointCommand& c = commands.joints[j];
    if (c.mode < GAITD_JOINT_MODE_OFF || c.mode > GAITD_JOINT_MODE_TORQUE) {
      return "a joint mode is unknown";
    }
    for (const double x : {c.torque, c.position, c.velocity, c.stiffness, c.damping}) {
      if (!std::isfinite(x)) return "a figure is not finite";
    }
    if (c.stiffness < 0 || c.damping < 0) return "a gain is negative";
  }
  return "";
}

}  // namespace gaitd::sim

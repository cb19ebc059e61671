// SPDX-License-Identifier: Apache-2.0
// The gait machine in a loop with a robot that does what the plan says: feet stand where they
// should, the swing foot meets the ground when `landing_delay` says, the ICP is where the plan has
// it.
#pragma once

#include <functional>

#include "gaitd/walking/gait_machine.h"
#include "gaitd/walking/icp_reference.h"
#include "gaitd/walking/support.h"
#include "walking/test/atlas.h"

namespace gaitd::testing {

class SyntheticWalk {
 public:
  using Planner = std::function<void(const GaitdRobotState&, const GaitdGaitState&, GaitdIcpPlan&)>;

  explicit SyntheticWalk(double period = 0.001)
      : dt(period), machine(atlas()), robot(standing_state(atlas())), reference_(atlas()) {
    machine.reset(robot);
    planner = [this](const GaitdRobotState& r, const GaitdGaitState& g, GaitdIcpPlan& p) {
      reference_.update(dt, r, g, offsets, p);
    };
  }

  const GaitdGaitState& gait() const { return machine.state(); }

  void tick() {
    move_feet();
    robot.icp[0] = plan.icp[0] + icp_error;
    robot.icp[1] = plan.icp[1] + icp_error_left;
    robot.com[0] = plan.icp[0];
    robot.com[1] = plan.icp[1];
    machine.update(dt, robot, plan, toe_off, adjustment);
    if (on_update) on_update();
    planner(robot, machine.state(), plan);
    ++ticks;
  }

  // At most `limit` seconds until `done`; false when it never was.
  bool run_until(const std::function<bool()>& done, double limit = 60.0) {
    const int last = ticks + static_cast<int>(limit / dt);
    while (ticks < last) {
      tick();
      if (done()) return true;
    }
    return false;
  }
  bool run_until_stand(double limit = 60.0) {
    return run_until([this] { return gait().phase == GAITD_PHASE_STAND; }, limit);
  }
  bool run_until_phase(int phase, int step, double limit = 60.0) {
    return run_until([=, this] { return gait().phase == phase && gait().step_index == step; },
                     limit);
  }
  void run_for(double seconds) {
    const int last = ticks + static_cast<int>(seconds / dt + 0.5);
    while (ticks < last) tick();
  }
  bool run_until_fraction(int step, double fraction) {
    return run_until([=, this] {
      return gait().phase == GAITD_PHASE_SWING && gait().step_index == step &&
             gait().time_in_phase >= fraction * gait().phase_duration;
    });
  }

  double dt;
  walking::GaitMachine machine;
  GaitdRobotState robot;
  GaitdIcpPlan plan{};
  GaitdToeOff toe_off{};
  GaitdStepAdjustment adjustment{};
  Planner planner;
  walking::CmpOffsets offsets{atlas().nominal_com_height};  // of the planner
  std::function<void()> on_update;                          // after the machine, before the planner
  double landing_delay = 0.0;   // s after the planned end of the swing; negative: early
  double landing_load = 2.0;    // of the weight, on a foot that is down
  double ground_error = 0.0;    // m, of the ground under the swing foot
  double landing_error = 0.0;   // m, forwards, of a foot that comes down
  double icp_error = 0.0;       // m, forwards
  double icp_error_left = 0.0;  // m
  int ticks = 0;

 private:
  void move_feet() {
    const GaitdGaitState& g = machine.state();
    const double weight = atlas().total_mass * atlas().gravity;
    for (int side = 0; side < GAITD_MAX_FEET; ++side) {
      GaitdFootState& foot = robot.feet[side];
      const bool swinging = g.phase == GAITD_PHASE_SWING && g.next_side == side;
      const GaitdPose& pose = swinging ? g.adjusted[0].pose : g.footholds[side].pose;
      const bool down =
          !swinging || g.time_in_phase + dt >= g.phase_duration + landing_delay - 0.5 * dt;
      foot.normal_force = down ? landing_load * weight : 0.0;
      foot.contact = down ? GAITD_CONTACT_FULL : GAITD_CONTACT_NONE;
      if (!down) continue;
      for (int k = 0; k < 3; ++k) foot.position[k] = pose.position[k];
      if (swinging) foot.position[2] += ground_error;
      if (swinging) foot.position[0] += landing_error;
      for (int k = 0; k < 4; ++k) foot.orientation[k] = pose.orientation[k];
    }
  }

  walking::IcpReference reference_;
};

// A footstep with the parameters' durations, in W.
inline GaitdFootstep footstep(int side, double x, double y, double z = 0.0, double yaw = 0.0) {
  GaitdFootstep step{};
  step.side = side;
  step.pose.position[0] = x;
  step.pose.position[1] = y;
  step.pose.position[2] = z;
  sdk::store(sdk::from_yaw(yaw), step.pose.orientation);
  return step;
}

}  // namespace gaitd::testing

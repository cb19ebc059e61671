// SPDX-License-Identifier: Apache-2.0
// Random commands and mishaps for a walk, from one seed.
#pragma once

#include <cmath>
#include <random>

#include "walking/test/synthetic_walk.h"

namespace gaitd::testing {

class CommandStorm {
 public:
  explicit CommandStorm(unsigned seed) : random_(seed) {}

  int accepted() const { return accepted_; }
  int refused() const { return refused_; }

  // Before a tick: every third of a second or so something happens.
  void disturb(SyntheticWalk& walk) {
    walk.adjustment = {};
    if (uniform(0, 1) > 0.003) return;
    walk.landing_delay = uniform(-0.15, 0.06);
    walk.ground_error = uniform(-0.02, 0.02);
    walk.icp_error = uniform(0, 1) < 0.2 ? 0.08 : 0.0;
    walking::GaitMachine& m = walk.machine;
    switch (std::uniform_int_distribution<int>(0, 11)(random_)) {
      case 0:
      case 1:
      case 2:
        return count(m.walk({.steps = 1 + static_cast<int>(uniform(0, 6)),
                             .length = uniform(-0.3, 0.5),
                             .lateral = uniform(-0.15, 0.15),
                             .turn = uniform(-0.3, 0.3),
                             .swing_duration = uniform(0.4, 0.9),
                             .transfer_duration = uniform(0.1, 0.4)}));
      case 3:
        return count(footsteps(walk, false));
      case 4:
        return count(footsteps(walk, true));
      case 5:
        return count(m.pause());
      case 6:
      case 7:
        return count(m.resume());
      case 8:
        return count(uniform(0, 1) < 0.5 ? m.stop() : m.abort());
      case 9:
        return count(
            m.set_mode(uniform(0, 1) < 0.5 ? GAITD_MODE_WALK_BENT : GAITD_MODE_WALK_STRAIGHT));
      case 10:
        walk.adjustment.active = 1;
        walk.adjustment.shift[0] = uniform(-0.08, 0.08);
        walk.adjustment.shift[1] = uniform(-0.02, 0.02);
        return;
      default:
        walk.adjustment.active = 1;
        walk.adjustment.time_shift = uniform(-0.05, 0.1);
        return;
    }
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  // A few footsteps after the last one ahead; now and then some that cannot be taken.
  walking::Refusal footsteps(SyntheticWalk& walk, bool replace) {
    const GaitdGaitState& g = walk.gait();
    GaitdPose stance = walking::middle_pose(g.footholds[0].pose, g.footholds[1].pose);
    int side = GAITD_LEFT;
    const int kept = replace ? (g.phase == GAITD_PHASE_SWING ? 1 : 0) : g.footstep_count;
    if (kept > 0) {
      stance = g.commanded[kept - 1].pose;
      side = walking::other_side(g.commanded[kept - 1].side);
    } else if (g.phase == GAITD_PHASE_TRANSFER && g.next_side != GAITD_BOTH) {
      side = g.next_side;
      stance = g.footholds[walking::other_side(side)].pose;
    } else {
      stance = g.footholds[walking::other_side(side)].pose;
    }
    const int number = 1 + static_cast<int>(uniform(0, 3));
    GaitdFootstep steps[4] = {};
    for (int i = 0; i < number; ++i) {
      const double yaw = sdk::yaw_of(sdk::quaternion(stance.orientation)) + uniform(-0.2, 0.2);
      const Eigen::Vector3d at = sdk::transform(
          stance, {uniform(-0.2, 0.4), walking::side_sign(side) * uniform(0.17, 0.4), 0.0});
      steps[i] = footstep(side, at.x(), at.y(), at.z(), yaw);
      stance = steps[i].pose;
      side = walking::other_side(side);
    }
    return walk.machine.footsteps(steps, number, replace);
  }
  void count(const walking::Refusal& r) { ++(r.refused() ? refused_ : accepted_); }

  std::mt19937 random_;
  int accepted_ = 0;
  int refused_ = 0;
};

}  // namespace gaitd::testing

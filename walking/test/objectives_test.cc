// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/objectives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "walking/test/allocation_counter.h"
#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::SyntheticWalk;

// A walk with its objectives, made after every tick of the gait machine.
class WalkWithObjectives : public SyntheticWalk {
 public:
  explicit WalkWithObjectives(int mode = GAITD_MODE_WALK_BENT) : builder(atlas()) {
    EXPECT_FALSE(machine.set_mode(mode).refused());
    tick();
    builder.reset(robot, gait());
    on_update = [this] { update(); };
    objectives = std::make_unique<GaitdObjectives>();
  }
  void update() {
    // The trailing foot rolls over its toe in the second half of each transfer.
    toe = {};
    const GaitdGaitState& g = gait();
    if (with_toe_off && g.phase == GAITD_PHASE_TRANSFER && g.trailing_side != GAITD_BOTH &&
        g.transfer_final == 0 && g.time_in_phase > 0.5 * g.phase_duration) {
      toe.active = 1;
      toe.side = g.trailing_side;
      std::copy_n(atlas().feet[toe.side].toe_point, 3, toe.toe_point);
    }
    toe_off = toe;
    time_on_toe = toe.active != 0 ? time_on_toe + dt : 0.0;
    GaitdStepAdjustment wanted{};
    wanted.linear_momentum_rate[0] = 12.0;
    wanted.linear_momentum_rate[1] = -7.0;
    wanted.angular_momentum_mask = angular_mask;
    wanted.angular_momentum_rate[1] = angular_rate;
    std::copy_n(robot.com, 2, robot.pelvis_position);
    const int before = testing::allocation_count();
    builder.update(dt, robot, g, machine.lift_off(), wanted, toe, *objectives);
    allocations += testing::allocation_count() - before;
    if (check) check(*objectives);
  }
  void walk(int steps = 3, double length = 0.3) {
    ASSERT_FALSE(machine.walk({.steps = steps, .length = length}).refused());
    tick();
    ASSERT_TRUE(run_until_stand());
    ASSERT_GT(gait().step_index, 1);
  }

  ObjectiveBuilder builder;
  std::unique_ptr<GaitdObjectives> objectives;
  // Whether the sole is unloaded but for its toe.
  bool on_toe(int side) const {
    return toe.active != 0 && toe.side == side && time_on_toe > ObjectiveBuilder::kToeRamp;
  }

  GaitdToeOff toe{};
  double time_on_toe = 0.0;  // s
  bool with_toe_off = false;
  int angular_mask = 0;
  double angular_rate = 0.0;  // N m, pitch
  int allocations = 0;
  std::function<void(const GaitdObjectives&)> check;
};

int contacts_of(const GaitdObjectives& o, int side) {
  int count = 0;
  for (int i = 0; i < o.contact_count; ++i) count += o.contacts[i].side == side ? 1 : 0;
  return count;
}

TEST(ObjectiveBuilder, ContactsAreThoseThatTheGaitCommands) {
  for (bool toe_off : {false, true}) {
    WalkWithObjectives w;
    w.with_toe_off = toe_off;
    int toe_ticks = 0;
    w.check = [&](const GaitdObjectives& o) {
      for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
        const bool in_air = w.gait().footholds[side].contact == GAITD_CONTACT_NONE;
        const bool on_toe = w.on_toe(side);
        const int expected = in_air ? 0 : on_toe ? 1 : atlas().feet[side].point_count;
        ASSERT_EQ(contacts_of(o, side), expected);
        toe_ticks += on_toe ? 1 : 0;
      }
    };
    w.walk();
    EXPECT_EQ(toe_ticks > 100, toe_off);
  }
}

TEST(ObjectiveBuilder, ContactsAreSoundAndBelongToTheirFoot) {
  WalkWithObjectives w;
  w.with_toe_off = true;
  w.check = [&](const GaitdObjectives& o) {
    for (int i = 0; i < o.contact_count; ++i) {
      const GaitdContactPoint& c = o.contacts[i];
      ASSERT_EQ(c.body, atlas().feet[c.side].body);
      ASSERT_LE(0.0, c.rho_min);
      ASSERT_LE(c.rho_min, c.rho_max);
      ASSERT_GT(c.friction, 0.0);
      ASSERT_NEAR(Eigen::Vector3d(sdk::view(c.normal)).norm(), 1.0, 1e-9);
      ASSERT_NEAR(Eigen::Vector3d(sdk::view(c.tangent)).norm(), 1.0, 1e-9);
      ASSERT_NEAR(Eigen::Vector3d(sdk::view(c.normal)).dot(Eigen::Vector3d(sdk::view(c.tangent))),
                  0.0, 1e-9);
      // Points lie on the sole.
      const GaitdFoot& foot = atlas().feet[c.side];
      const Eigen::Vector3d in_sole = sdk::quaternion(foot.sole.orientation).conjugate() *
                                      (sdk::view(c.point) - sdk::view(foot.sole.origin));
      ASSERT_NEAR(in_sole.z(), 0.0, 1e-6);
      ASSERT_LE(std::abs(in_sole.x()), 0.3);
    }
  };
  w.walk();
}

TEST(ObjectiveBuilder, EveryContactCountsOnTheFrictionOfTheParameterAndNoMore) {
  for (const double friction : {0.7, 0.3}) {
    WalkWithObjectives w;
    w.builder.set_objective_parameter(static_cast<int>(Objective::kFriction), friction);
    w.with_toe_off = true;
    int contacts = 0;
    w.check = [&](const GaitdObjectives& o) {
      for (int i = 0; i < o.contact_count; ++i) ASSERT_EQ(o.contacts[i].friction, friction);
      contacts += o.contact_count;
    };
    w.walk();
    EXPECT_GT(contacts, 1000);
  }
}

TEST(ObjectiveBuilder, LoadLimitsHaveNoSteps) {
  WalkWithObjectives w;
  double last[2] = {-1.0, -1.0};
  double largest[2] = {0.0, 0.0};
  double full = 0.0;
  w.check = [&](const GaitdObjectives& o) {
    for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
      double now = 0.0;  // a foot in the air carries nothing
      for (int i = 0; i < o.contact_count; ++i) {
        if (o.contacts[i].side == side) now = o.contacts[i].rho_max;
      }
      full = std::max(full, now);
      if (last[side] >= 0.0) largest[side] = std::max(largest[side], std::abs(now - last[side]));
      last[side] = now;
    }
  };
  w.walk(4);
  const double ticks = ObjectiveBuilder::kContactRamp / w.dt;
  ASSERT_GT(ticks, 5.0);
  EXPECT_GT(full, 100.0);
  // A square ramp is steepest at its upper end: twice the mean slope.
  for (double step : largest) EXPECT_LE(step, 2.1 * full / ticks);
}

TEST(ObjectiveBuilder, AStandingRobotHasTheFullLoadLimitOnBothFeet) {
  WalkWithObjectives w;
  w.run_for(0.2);
  ASSERT_EQ(w.objectives->contact_count, atlas().feet[0].point_count + atlas().feet[1].point_count);
  for (int i = 0; i < w.objectives->contact_count; ++i) {
    EXPECT_GT(w.objectives->contacts[i].rho_max, 0.1 * atlas().total_mass * atlas().gravity);
  }
}

TEST(ObjectiveBuilder, TasksAreFewFiniteAndOneSetPerFoot) {
  for (int mode : {GAITD_MODE_WALK_BENT, GAITD_MODE_WALK_STRAIGHT}) {
    WalkWithObjectives w(mode);
    w.with_toe_off = true;
    w.check = [&](const GaitdObjectives& o) {
      ASSERT_GE(o.task_count, 3);
      ASSERT_LE(o.task_count, 6);  // pelvis, chest, and one or two for each foot
      int feet[2] = {};
      for (int t = 0; t < o.task_count; ++t) {
        const GaitdTask& task = o.tasks[t];
        ASSERT_EQ(task.type, GAITD_TASK_FRAME);
        ASSERT_GE(task.index, 0);
        ASSERT_LT(task.index, atlas().body_count);
        ASSERT_NE(task.row_mask, 0u);
        for (int row = 0; row < 6; ++row) {
          if ((task.row_mask >> row & 1u) == 0) continue;
          ASSERT_TRUE(std::isfinite(task.acceleration[row]));
          ASSERT_GT(task.weight[row], 0.0);
        }
        for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
          feet[side] += task.index == atlas().feet[side].body ? 1 : 0;
        }
      }
      for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
        const bool on_toe = w.on_toe(side);
        ASSERT_EQ(feet[side], on_toe ? 2 : 1);
      }
    };
    w.walk();
  }
}

TEST(ObjectiveBuilder, ThePitchOfAFootOnItsToeIsLeftFree) {
  WalkWithObjectives w;
  w.with_toe_off = true;
  int seen = 0;
  w.check = [&](const GaitdObjectives& o) {
    if (!w.on_toe(w.toe.side)) return;
    std::uint32_t rows = 0;
    int count = 0;
    for (int t = 0; t < o.task_count; ++t) {
      if (o.tasks[t].index != atlas().feet[w.toe.side].body) continue;
      rows |= o.tasks[t].row_mask;
      count += __builtin_popcount(o.tasks[t].row_mask);
    }
    ++seen;
    ASSERT_EQ(rows, 0b111101u);
    ASSERT_EQ(count, 5);
  };
  w.walk();
  EXPECT_GT(seen, 100);
}

TEST(ObjectiveBuilder, TheHeightRowIsFilledInEveryModeAndMaskedInStraightWalking) {
  for (int mode : {GAITD_MODE_STAND, GAITD_MODE_WALK_BENT, GAITD_MODE_WALK_STRAIGHT}) {
    WalkWithObjectives w(mode);
    w.robot.com[2] -= 0.05;  // too low: the height feedback wants up
    w.run_for(0.05);
    const GaitdObjectives& o = *w.objectives;
    const bool straight = mode == GAITD_MODE_WALK_STRAIGHT;
    EXPECT_EQ(o.momentum_mask, straight ? 0b011000u : 0b111000u);
    EXPECT_GT(o.momentum_rate[5], 10.0) << mode;
    EXPECT_GT(o.momentum_weight[5], 0.0) << mode;
    EXPECT_TRUE(std::isfinite(o.height_target));
    EXPECT_EQ(o.momentum_rate[3], 12.0);
    EXPECT_EQ(o.momentum_rate[4], -7.0);
  }
}

TEST(ObjectiveBuilder, TheHeightFeedbackIsBounded) {
  WalkWithObjectives w;
  w.robot.com[2] -= 3.0;
  w.run_for(0.01);
  const double weight = atlas().total_mass * atlas().gravity;
  EXPECT_GT(w.objectives->momentum_rate[5], 0.0);
  EXPECT_LE(w.objectives->momentum_rate[5], weight);
}

TEST(ObjectiveBuilder, AngularMomentumIsCommandedOnlyWhenTheAdjusterAsksForIt) {
  WalkWithObjectives w;
  w.run_for(0.01);
  EXPECT_EQ(w.objectives->momentum_mask & 0b111u, 0u);
  w.angular_mask = 0b11;
  w.run_for(0.01);
  EXPECT_EQ(w.objectives->momentum_mask & 0b111u, 0b11u);
  w.angular_mask = 0b11 | 0b100000;  // no way to switch the height on
  EXPECT_FALSE(w.machine.set_mode(GAITD_MODE_WALK_STRAIGHT).refused());
  w.run_for(0.01);
  EXPECT_EQ(w.objectives->momentum_mask, 0b011011u);
}

TEST(ObjectiveBuilder, AngularMomentumWeighsMoreTheMoreOfItIsWanted) {
  WalkWithObjectives w;
  w.angular_mask = 0b11;
  double last = -1.0;
  for (const double rate : {0.0, 10.0, 30.0, 60.0, 200.0}) {
    w.angular_rate = rate;
    w.run_for(0.01);
    const GaitdObjectives& o = *w.objectives;
    EXPECT_EQ(o.momentum_rate[1], rate);
    EXPECT_GE(o.momentum_weight[1], last) << rate;
    last = o.momentum_weight[1];
    EXPECT_EQ(last == 0.0, rate == 0.0);
  }
  EXPECT_GT(last, 0.5 * w.objectives->momentum_weight[3]);
}

TEST(ObjectiveBuilder, APoseLowersARobotThatStandsLowNoFurther) {
  WalkWithObjectives w(GAITD_MODE_STAND);
  w.builder.set_objective_parameter(static_cast<int>(Objective::kComHeight), 0.8);
  w.run_for(0.01);
  const double low = w.objectives->height_target;
  GaitdTaskReferences references{};
  std::copy_n(atlas().nominal_position, GAITD_MAX_JOINTS, references.joint_position);
  for (const auto& [asked, got] : {std::pair(0.03, 0.03), std::pair(0.1, 0.05)}) {
    references.com_shift[2] = -asked * atlas().nominal_com_height;
    w.builder.set_references(references);
    w.run_for(0.01);
    EXPECT_NEAR(w.objectives->height_target, low - got * atlas().nominal_com_height, 1e-9);
  }
}

TEST(ObjectiveBuilder, TheHeightTargetHasNoLargeStepsOverAWalkOnFlatGround) {
  for (double length : {0.3, 0.6}) {
    WalkWithObjectives w;
    double last = 0.0;
    double worst = 0.0;
    double lowest = 1e9;
    double highest = 0.0;
    w.check = [&](const GaitdObjectives& o) {
      if (last > 0.0) worst = std::max(worst, std::abs(o.height_target - last));
      last = o.height_target;
      lowest = std::min(lowest, last);
      highest = std::max(highest, last);
    };
    w.walk(5, length);
    // In small steps only, where the hip begins to come down with the foot; a filter follows.
    EXPECT_LT(worst, 0.01) << length;
    EXPECT_GT(lowest, 0.7 * atlas().nominal_com_height);
    EXPECT_LE(highest, 1.05 * atlas().nominal_com_height);
  }
}

TEST(ObjectiveBuilder, TheHeightTargetGoesUpAndDownWithTheFootholds) {
  for (double rise : {0.15, -0.15}) {
    WalkWithObjectives w;
    const double y = 0.5 * atlas().nominal_foot_separation;
    const GaitdFootstep steps[] = {testing::footstep(GAITD_LEFT, 0.3, y, rise),
                                   testing::footstep(GAITD_RIGHT, 0.6, -y, 2 * rise),
                                   testing::footstep(GAITD_LEFT, 0.6, y, 2 * rise)};
    w.run_for(0.01);
    const double start = w.objectives->height_target;
    double last = start;
    double worst = 0.0;
    w.check = [&](const GaitdObjectives& o) {
      worst = std::max(worst, std::abs(o.height_target - last));
      last = o.height_target;
    };
    ASSERT_FALSE(w.machine.footsteps(steps, 3, false).refused());
    w.tick();
    ASSERT_TRUE(w.run_until_stand());
    EXPECT_NEAR(last - start, 2 * rise, 1e-6);
    // Where the hip begins to come down with the foot; a filter follows.
    EXPECT_LT(worst, 0.06) << rise;
  }
}

TEST(ObjectiveBuilder, TheSwingFootIsSentAlongItsTrajectory) {
  WalkWithObjectives w;
  ASSERT_FALSE(w.machine.walk({.steps = 3, .length = 0.3}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 1));
  ASSERT_TRUE(w.run_until_fraction(1, 0.25));
  // The synthetic foot still stands where it lifted off: the task wants it up and forwards.
  const int body = atlas().feet[w.gait().next_side].body;
  bool found = false;
  for (int t = 0; t < w.objectives->task_count; ++t) {
    const GaitdTask& task = w.objectives->tasks[t];
    if (task.index != body) continue;
    found = true;
    EXPECT_EQ(task.row_mask, 0b111111u);
    EXPECT_GT(task.acceleration[3], 0.0);
    EXPECT_GT(task.acceleration[5], 0.0);
  }
  EXPECT_TRUE(found);
}

TEST(ObjectiveBuilder, AFootInContactIsOnlyDamped) {
  WalkWithObjectives w;
  w.run_for(0.5);
  const int body = atlas().feet[GAITD_LEFT].body;
  w.robot.feet[GAITD_LEFT].twist[3] = 0.2;
  w.tick();
  for (int t = 0; t < w.objectives->task_count; ++t) {
    const GaitdTask& task = w.objectives->tasks[t];
    if (task.index != body) continue;
    EXPECT_LT(task.acceleration[3], 0.0);
    EXPECT_EQ(task.acceleration[4], 0.0);
  }
}

TEST(ObjectiveBuilder, AFootThatComesDownHardIsNotStoppedHarderThanItMayBe) {
  WalkWithObjectives w;
  w.run_for(0.5);
  const int body = atlas().feet[GAITD_LEFT].body;
  const double hardest = ObjectiveBuilder::kTouchdownStop;
  for (double speed : {1.0, 100.0}) {
    w.robot.feet[GAITD_LEFT].twist[5] = -speed;
    w.tick();
    for (int t = 0; t < w.objectives->task_count; ++t) {
      const GaitdTask& task = w.objectives->tasks[t];
      if (task.index == body) EXPECT_LE(task.acceleration[5], hardest * (1.0 + 1e-9)) << speed;
      if (task.index == body) EXPECT_GT(task.acceleration[5], 0.0) << speed;
    }
  }
}

TEST(ObjectiveBuilder, ThePelvisLetsGoForALateFootAndComesBackWithoutAStep) {
  WalkWithObjectives w;
  w.landing_delay = 0.3;
  const ObjectiveParameters p(kObjectiveParameters);
  const double full = p[Objective::kPelvisWeight];
  double least = full, before = full, fastest = 0.0;
  w.check = [&](const GaitdObjectives& o) {
    const double now = o.tasks[0].weight[0];
    least = std::min(least, now);
    fastest = std::max(fastest, now - before);
    before = now;
  };
  ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.3, .swing_duration = 0.6}).refused());
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_LT(least, 0.2 * full);
  EXPECT_LE(fastest, full * w.dt / ObjectiveBuilder::kPelvisFade * (1.0 + 1e-6));
  EXPECT_EQ(before, full);
}

TEST(ObjectiveBuilder, OrientationFeedbackPullsThePelvisBack) {
  WalkWithObjectives w;
  const Eigen::Vector3d tilt(0.1, -0.05, 0.0);
  sdk::store(sdk::exp_so3(tilt), w.robot.pelvis_orientation);
  w.run_for(0.01);
  const GaitdTask& pelvis = w.objectives->tasks[0];
  ASSERT_EQ(pelvis.index, 0);
  EXPECT_EQ(pelvis.row_mask, 0b111u);
  EXPECT_LT(pelvis.acceleration[0], -0.1);
  EXPECT_GT(pelvis.acceleration[1], 0.1);
}

TEST(ObjectiveBuilder, HeadingFollowsTheFeetWithoutASpin) {
  WalkWithObjectives w;
  ASSERT_FALSE(w.machine.walk({.steps = 24, .turn = 0.3}).refused());  // more than a full turn
  double worst = 0.0;
  w.check = [&](const GaitdObjectives& o) {
    // The synthetic pelvis turns with the feet.
    const GaitdGaitState& g = w.gait();
    const GaitdPose middle = middle_pose(g.footholds[0].pose, g.footholds[1].pose);
    sdk::store(sdk::quaternion(middle.orientation), w.robot.pelvis_orientation);
    worst = std::max(worst, std::abs(o.tasks[0].acceleration[2]));
  };
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
  const ObjectiveParameters p(kObjectiveParameters);
  EXPECT_LT(worst, p[Objective::kPelvisStiffness] * 1.0);  // error always far below a radian
}

TEST(ObjectiveBuilder, TheLegBendsAsAUnit) {
  for (int mode : {GAITD_MODE_WALK_BENT, GAITD_MODE_WALK_STRAIGHT}) {
    WalkWithObjectives w(mode);
    w.check = [&](const GaitdObjectives& o) {
      for (const GaitdLeg& leg : atlas().legs) {
        const double knee = leg.knee_bend_sign * o.privileged_acceleration[leg.knee];
        ASSERT_NEAR(leg.hip_pitch_bend_sign * o.privileged_acceleration[leg.hip_pitch], 0.5 * knee,
                    1e-9);
        ASSERT_NEAR(leg.ankle_pitch_bend_sign * o.privileged_acceleration[leg.ankle_pitch],
                    0.5 * knee, 1e-9);
        ASSERT_EQ(o.privileged_weight[leg.hip_pitch], o.privileged_weight[leg.knee]);
        ASSERT_EQ(o.privileged_weight[leg.ankle_pitch], o.privileged_weight[leg.knee]);
      }
    };
    w.walk();
  }
}

TEST(ObjectiveBuilder, LegsAndSpineHaveNoPostureTaskAndAllOthersHave) {
  WalkWithObjectives w;
  w.run_for(0.01);
  int posture = 0;
  for (int i = 0; i < atlas().joint_count; ++i) {
    const std::string name = atlas().joints[i].name;
    const bool wanted = name.find("_leg_") == std::string::npos && name.rfind("back_", 0) != 0;
    EXPECT_EQ(w.objectives->posture_weight[i] > 0.0, wanted) << name;
    posture += wanted ? 1 : 0;
  }
  EXPECT_GE(posture, 10);
}

TEST(ObjectiveBuilder, NeverAllocates) {
  for (int mode : {GAITD_MODE_WALK_BENT, GAITD_MODE_WALK_STRAIGHT}) {
    WalkWithObjectives w(mode);
    w.with_toe_off = true;
    w.walk();
    EXPECT_EQ(w.allocations, 0);
  }
  const int before = testing::allocation_count();
  const Eigen::VectorXd v = Eigen::VectorXd::Ones(100);
  const std::unique_ptr<GaitdObjectives> o = std::make_unique<GaitdObjectives>();
  EXPECT_EQ(v.sum() + o->contact_count, 100.0);
  EXPECT_GE(testing::allocation_count(), before + 2);  // the counter counts
}

TEST(Objectives, FeetTakeNothingFromHandsThatHeldOnBefore) {
  WalkWithObjectives w;
  for (GaitdContactPoint& contact : w.objectives->contacts) contact.weight = 5.0;
  w.update();
  ASSERT_GT(w.objectives->contact_count, 0);
  for (int i = 0; i < w.objectives->contact_count; ++i) {
    EXPECT_EQ(w.objectives->contacts[i].weight, 0.0);
  }
}

}  // namespace
}  // namespace gaitd::walking

// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>

#include "com_height_qp.h"
#include "gaitd/dynamics/dynamics.h"
#include "gaitd/walking/objectives.h"
#include "layer_inputs.h"
#include "nullspace_qp.h"
#include "walking/test/allocation_counter.h"

namespace gaitd::plugins {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::atlas;
using testing::SyntheticWalk;

using Output = GaitdWholeBodyControllerOutput;

double weight() { return atlas().total_mass * atlas().gravity; }

// Atlas in its nominal posture (with a little motion if wanted), with the objectives of a gait.
class ControllerBench {
 public:
  explicit ControllerBench(double period = 0.001)
      : walk(period),
        builder(atlas()),
        objectives(std::make_unique<GaitdObjectives>()),
        out(std::make_unique<Output>()) {
    walk.run_for(5 * period);
    builder.reset(walk.robot, walk.gait());
    walk.on_update = [this] { make_objectives(); };
    walk.run_for(0.1);
  }
  void make_objectives() {
    builder.update(walk.dt, walk.robot, walk.gait(), walk.machine.lift_off(), adjustment, {},
                   *objectives);
  }
  GaitdWholeBodyControllerInput input() const {
    return {sizeof(GaitdWholeBodyControllerInput),
            0,
            testing::layer_time(walk.dt),
            &walk.robot,
            &walk.gait(),
            &toe_off,
            objectives.get()};
  }
  template <class Controller>
  GaitdStatus process(Controller& layer) {
    return layer.process(input(), *out);
  }
  // Stands with straight legs from now on.
  void straighten(double knee) {
    ASSERT_FALSE(walk.machine.set_mode(GAITD_MODE_WALK_STRAIGHT).refused());
    for (const GaitdLeg& leg : atlas().legs) {
      walk.robot.joint_position[leg.knee] = leg.knee_bend_sign * knee;
      walk.robot.joint_position[leg.hip_pitch] = 0.5 * leg.hip_pitch_bend_sign * knee;
      walk.robot.joint_position[leg.ankle_pitch] = 0.5 * leg.ankle_pitch_bend_sign * knee;
    }
    testing::fill_kinematics(atlas(), walk.gait().omega, walk.robot);
    walk.run_for(3 * walk.dt);
  }
  // Small random velocities and joint offsets.
  void stir(unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    for (int i = 0; i < atlas().joint_count; ++i) {
      walk.robot.joint_position[i] += 0.02 * normal(random);
      walk.robot.joint_velocity[i] = 0.2 * normal(random);
    }
    for (double& v : walk.robot.pelvis_twist) v = 0.1 * normal(random);
    testing::fill_kinematics(atlas(), walk.gait().omega, walk.robot);
    make_objectives();
  }

  SyntheticWalk walk;
  walking::ObjectiveBuilder builder;
  GaitdStepAdjustment adjustment{};
  GaitdToeOff toe_off{};
  std::unique_ptr<GaitdObjectives> objectives;
  std::unique_ptr<Output> out;
};

class Recomputed {
 public:
  explicit Recomputed(const ControllerBench& b) : dynamics(atlas()) {
    const GaitdRobotState& r = b.walk.robot;
    const int n = atlas().joint_count;
    dynamics.update(sdk::view(r.pelvis_position), sdk::quaternion(r.pelvis_orientation),
                    sdk::view(r.pelvis_twist), sdk::head(r.joint_position, n),
                    sdk::head(r.joint_velocity, n));
    acceleration.resize(6 + n);
    acceleration << sdk::view(b.out->info.pelvis_acceleration),
        sdk::head(b.out->info.joint_acceleration, n);
    force = dynamics.mass_matrix() * acceleration + dynamics.bias();
    for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
      const GaitdFoot& foot = atlas().feet[side];
      VectorXd applied = VectorXd::Zero(6 + n);
      dynamics.kinematics().add_wrench(foot.body, sdk::view(foot.sole.origin),
                                       sdk::view(b.out->info.foot_wrench[side]), applied);
      force -= applied;
    }
    for (int hand : {GAITD_LEFT, GAITD_RIGHT}) {
      const GaitdFrame& frame = atlas().hands[hand];
      VectorXd applied = VectorXd::Zero(6 + n);
      dynamics::Vector6d wrench = dynamics::Vector6d::Zero();
      wrench.tail<3>() = sdk::view(b.out->info.hand_force[hand]);
      dynamics.kinematics().add_wrench(frame.body, sdk::view(frame.origin), wrench, applied);
      force -= applied;
    }
    momentum_rate =
        dynamics.centroidal_momentum_matrix() * acceleration + dynamics.centroidal_bias();
  }
  dynamics::Dynamics dynamics;
  VectorXd acceleration;
  VectorXd force;  // what the joints have to give; nothing can act on the pelvis
  dynamics::Vector6d momentum_rate;
};

void expect_physical(const ControllerBench& b) {
  const Recomputed r(b);
  EXPECT_LT(r.force.head<6>().cwiseAbs().maxCoeff(), 1e-6 * weight());
  for (int i = 0; i < atlas().joint_count; ++i) {
    const GaitdJoint& joint = atlas().joints[i];
    const GaitdJointCommand& c = b.out->commands.joints[i];
    EXPECT_EQ(c.mode, GAITD_JOINT_MODE_TORQUE);
    EXPECT_NEAR(c.torque, r.force[6 + i] + joint.damping * b.walk.robot.joint_velocity[i],
                1e-6 * weight())
        << joint.name;
    EXPECT_LE(std::abs(c.torque), joint.effort_limit + 1e-6) << joint.name;
    EXPECT_EQ(c.acceleration, b.out->info.joint_acceleration[i]);
  }
}

void expect_sound_contacts(const ControllerBench& b) {
  const GaitdObjectives& o = *b.objectives;
  for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
    const GaitdFoothold& foothold = b.walk.gait().footholds[side];
    const Vector3d moment = sdk::view(b.out->info.foot_wrench[side]).head<3>();
    const Vector3d force = sdk::view(b.out->info.foot_wrench[side]).tail<3>();
    if (foothold.contact == GAITD_CONTACT_NONE) {
      EXPECT_EQ(force.norm(), 0.0);
      continue;
    }
    double most = 0.0;
    double friction = 0.0;
    for (int i = 0; i < o.contact_count; ++i) {
      if (o.contacts[i].side != side) continue;
      most += 4.0 * o.contacts[i].rho_max;
      friction = o.contacts[i].friction;
    }
    EXPECT_GT(force.z(), 0.0);
    EXPECT_LE(force.z(), most + 1e-6);
    EXPECT_LE(std::abs(force.x()) + std::abs(force.y()), friction * force.z() + 1e-6);
    // The centre of pressure, in the sole.
    if (force.z() < 1.0) continue;
    const Vector3d cop = sdk::quaternion(b.walk.robot.feet[side].orientation).conjugate() *
                         Vector3d(-moment.y() / force.z(), moment.x() / force.z(), 0.0);
    walking::ConvexPolygon sole;
    for (int i = 0; i < atlas().feet[side].point_count; ++i) {
      sole.add({atlas().feet[side].points[i][0], atlas().feet[side].points[i][1]});
    }
    sole.make_hull();
    EXPECT_GT(sole.inside_distance(cop.head<2>()), -2e-3) << "side " << side;
  }
}

TEST(ComHeightQp, StandingAtlasIsHeldUpByBothFeet) {
  ControllerBench b;
  ComHeightQp layer(atlas());
  ASSERT_EQ(b.process(layer), GAITD_OK);
  ASSERT_EQ(b.out->info.status, GAITD_WBC_SOLVED);
  EXPECT_GE(b.out->info.iterations, 0);
  EXPECT_LT(b.out->info.kkt_residual, 1e-6);
  expect_physical(b);
  expect_sound_contacts(b);
  const double left = b.out->info.foot_wrench[GAITD_LEFT][5];
  const double right = b.out->info.foot_wrench[GAITD_RIGHT][5];
  EXPECT_NEAR(left + right, weight(), 0.05 * weight());
  EXPECT_NEAR(left, right, 0.1 * weight());
  EXPECT_LT(Recomputed(b).acceleration.cwiseAbs().maxCoeff(), 20.0);
}

TEST(ComHeightQp, SolutionsArePhysicalInStirredStates) {
  ComHeightQp layer(atlas());
  for (unsigned seed = 1; seed <= 20; ++seed) {
    ControllerBench b;
    b.stir(seed);
    ASSERT_EQ(b.process(layer), GAITD_OK);
    ASSERT_EQ(b.out->info.status, GAITD_WBC_SOLVED) << seed;
    EXPECT_LT(b.out->info.kkt_residual, 1e-6);
    expect_physical(b);
    expect_sound_contacts(b);
  }
}

// Both hands at walls beside the robot.
void hold_on(ControllerBench& b, double force) {
  dynamics::Kinematics kinematics(atlas());
  kinematics.update(b.walk.robot);
  for (int hand : {GAITD_LEFT, GAITD_RIGHT}) {
    GaitdHandhold& handhold = b.walk.robot.handholds[hand];
    const GaitdFrame& frame = atlas().hands[hand];
    handhold.state = GAITD_HANDHOLD_HELD;
    sdk::view(handhold.position) = kinematics.frame_position(frame.body, sdk::view(frame.origin));
    sdk::view(handhold.anchor) = sdk::view(handhold.position);
    handhold.normal[1] = hand == GAITD_LEFT ? -1.0 : 1.0;
    handhold.friction = 0.5;
    handhold.force_min = 20.0;
    handhold.force_max = force;
  }
  b.make_objectives();
}

TEST(ComHeightQp, HandsCarryWhatFeetCannot) {
  // To the left, more than feet can push a robot that keeps upright.
  double missed[2];
  for (int held : {0, 1}) {
    ControllerBench b;
    ComHeightQp layer(atlas());
    b.adjustment.linear_momentum_rate[1] = 0.25 * weight();
    b.make_objectives();
    if (held != 0) hold_on(b, 400.0);
    ASSERT_EQ(b.process(layer), GAITD_OK);
    ASSERT_EQ(b.out->info.status, GAITD_WBC_SOLVED);
    expect_physical(b);
    expect_sound_contacts(b);
    const Recomputed r(b);
    // What is missed of the momentum, and how fast the trunk would have to turn for the rest.
    missed[held] = b.out->info.momentum_residual + std::abs(r.momentum_rate[0]);
    const Vector3d right = sdk::view(b.out->info.hand_force[GAITD_RIGHT]);
    const Vector3d left = sdk::view(b.out->info.hand_force[GAITD_LEFT]);
    if (held == 0) {
      EXPECT_EQ(right.norm() + left.norm(), 0.0);
      continue;
    }
    EXPECT_GT(right.y(), 100.0);       // pushes off the wall on the right
    EXPECT_LT(left.y(), -19.0 * 0.8);  // presses still
    EXPECT_GT(left.y(), -100.0);
    for (const Vector3d& force : {right, left}) {
      EXPECT_LE(std::abs(force.x()) + std::abs(force.z()), 0.5 * std::abs(force.y()) + 1e-6);
      EXPECT_LE(std::abs(force.y()), 400.0 + 1e-6);
    }
  }
  EXPECT_LT(missed[1], 0.7 * missed[0]);
}

TEST(ComHeightQp, AHandThatHoldsStaysWhereItIs) {
  ControllerBench b;
  ComHeightQp layer(atlas());
  hold_on(b, 200.0);
  ASSERT_EQ(b.process(layer), GAITD_OK);
  Recomputed r(b);
  const GaitdFrame& frame = atlas().hands[GAITD_RIGHT];
  dynamics::Matrix6X jacobian(6, 6 + atlas().joint_count);
  r.dynamics.frame_jacobian(frame.body, sdk::view(frame.origin), jacobian);
  const Vector3d acceleration =
      (jacobian * r.acceleration).tail<3>() +
      r.dynamics.frame_bias_acceleration(frame.body, sdk::view(frame.origin)).tail<3>();
  EXPECT_LT(acceleration.norm(), 0.2);
}

TEST(ComHeightQp, TheMomentumObjectiveIsMetInAllThreeDirections) {
  ControllerBench b;
  ComHeightQp layer(atlas());
  b.adjustment.linear_momentum_rate[0] = 60.0;
  b.adjustment.linear_momentum_rate[1] = -40.0;
  b.make_objectives();
  b.objectives->momentum_rate[5] = 80.0;
  ASSERT_EQ(b.process(layer), GAITD_OK);
  ASSERT_EQ(b.out->info.status, GAITD_WBC_SOLVED);
  const Vector3d rate = Recomputed(b).momentum_rate.tail<3>();
  const Vector3d wanted(60.0, -40.0, 80.0);
  EXPECT_LT((rate - wanted).norm(), 0.15 * wanted.norm()) << rate.transpose();
  EXPECT_NEAR(b.out->info.momentum_residual, (rate - wanted).norm(), 1e-6 * weight());
}

TEST(ComHeightQp, TheHeightIsTakenWhateverTheMaskSays) {
  ControllerBench b;
  ComHeightQp layer(atlas());
  b.objectives->momentum_mask = 0b011000;
  b.objectives->momentum_rate[5] = 150.0;
  ASSERT_EQ(b.process(layer), GAITD_OK);
  EXPECT_NEAR(Recomputed(b).momentum_rate[5], 150.0, 30.0);
}

// Of a leg that stands the mode says how straight it is, unless the height does.
TEST(ComHeightQp, TheHeightAndNotTheModeBendsALegThatStands) {
  auto knee_torque = [](std::uint32_t mask, double bend) {
    ControllerBench b;
    ComHeightQp layer(atlas());
    b.objectives->momentum_mask = mask;
    const int knee = atlas().legs[GAITD_LEFT].knee;
    b.objectives->privileged_weight[knee] = 150.0;
    b.objectives->privileged_acceleration[knee] = bend;
    EXPECT_EQ(b.process(layer), GAITD_OK);
    return b.out->commands.joints[knee].torque;
  };
  EXPECT_EQ(knee_torque(0b011000, 50.0), knee_torque(0b011000, 0.0));
  EXPECT_GT(std::abs(knee_torque(0b111000, 50.0) - knee_torque(0b111000, 0.0)), 1.0);
}

TEST(ComHeightQp, WalksThroughEveryPhaseWithPhysicalSolutions) {
  ControllerBench b(0.004);
  ComHeightQp layer(atlas());
  ASSERT_FALSE(b.walk.machine.walk({.steps = 2, .length = 0.1}).refused());
  int swings = 0;
  for (int i = 0; i < 1000; ++i) {
    b.walk.tick();
    ASSERT_EQ(b.process(layer), GAITD_OK);
    ASSERT_EQ(b.out->info.status, GAITD_WBC_SOLVED) << i;
    if (i % 10 == 0) expect_physical(b);
    if (b.walk.gait().phase != GAITD_PHASE_SWING) continue;
    ++swings;
    const double* wrench = b.out->info.foot_wrench[b.walk.gait().next_side];
    for (int k = 0; k < 6; ++k) ASSERT_EQ(wrench[k], 0.0);
  }
  EXPECT_GT(swings, 200);
}

// Largest torque as a share of its limit.
double largest_share(const Output& out) {
  double share = 0.0;
  for (int i = 0; i < atlas().joint_count; ++i) {
    share =
        std::max(share, std::abs(out.commands.joints[i].torque) / atlas().joints[i].effort_limit);
  }
  return share;
}

TEST(ComHeightQp, TorqueLimitsAreKeptWhenTheyBind) {
  ControllerBench b;
  ComHeightQp layer(atlas());
  b.objectives->momentum_rate[5] = 500.0;
  ASSERT_EQ(b.process(layer), GAITD_OK);
  ASSERT_EQ(b.out->info.status, GAITD_WBC_SOLVED);
  const double scale = 0.9 * largest_share(*b.out);
  layer.reset();
  testing::set_parameter(layer, "torque_scale", scale);
  ASSERT_EQ(b.process(layer), GAITD_OK);
  ASSERT_EQ(b.out->info.status, GAITD_WBC_SOLVED);
  EXPECT_NEAR(largest_share(*b.out), scale, 1e-6);
  expect_physical(b);
}

TEST(ComHeightQp, JointsAtAStopAreNotPushedFurther) {
  ControllerBench b;
  ComHeightQp layer(atlas());
  const int knee = atlas().legs[GAITD_LEFT].knee;
  b.walk.robot.joint_position[knee] = atlas().joints[knee].position_max;
  b.walk.robot.joint_velocity[knee] = 0.0;
  testing::fill_kinematics(atlas(), 3.0, b.walk.robot);
  b.objectives->privileged_acceleration[knee] = 500.0;
  b.objectives->privileged_weight[knee] = 1e6;
  ASSERT_EQ(b.process(layer), GAITD_OK);
  ASSERT_EQ(b.out->info.status, GAITD_WBC_SOLVED);
  EXPECT_LE(b.out->info.joint_acceleration[knee], 1e-6);
}

TEST(ComHeightQp, InputThatIsNoNumberGivesAStatusAndIsForgotten) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ControllerBench b;
  ComHeightQp layer(atlas());
  ASSERT_EQ(b.process(layer), GAITD_OK);
  const Output good = *b.out;
  double* const poisoned[] = {&b.walk.robot.joint_position[3],
                              &b.walk.robot.joint_velocity[7],
                              &b.walk.robot.pelvis_orientation[1],
                              &b.objectives->momentum_rate[3],
                              &b.objectives->tasks[0].acceleration[0],
                              &b.objectives->contacts[0].point[0],
                              &b.objectives->rho_weight,
                              &b.objectives->external_wrench[2]};
  for (double* value : poisoned) {
    for (double bad : {nan, std::numeric_limits<double>::infinity()}) {
      const double before = *value;
      *value = bad;
      const GaitdStatus status = b.process(layer);
      EXPECT_TRUE(status != GAITD_OK || b.out->info.status != GAITD_WBC_SOLVED);
      *value = before;
      ASSERT_EQ(b.process(layer), GAITD_OK);
      ASSERT_EQ(b.out->info.status, GAITD_WBC_SOLVED);
      for (int i = 0; i < atlas().joint_count; ++i) {
        ASSERT_NEAR(b.out->commands.joints[i].torque, good.commands.joints[i].torque,
                    0.02 * atlas().joints[i].effort_limit);
      }
    }
  }
}

TEST(ComHeightQp, GivesTheSameBitsTwice) {
  Output outputs[2];
  for (Output& out : outputs) {
    ControllerBench b(0.004);
    ComHeightQp layer(atlas());
    ASSERT_FALSE(b.walk.machine.walk({.steps = 1, .length = 0.1}).refused());
    for (int i = 0; i < 300; ++i) {
      b.walk.tick();
      ASSERT_EQ(b.process(layer), GAITD_OK);
    }
    out = *b.out;
  }
  EXPECT_EQ(std::memcmp(&outputs[0].commands.joints, &outputs[1].commands.joints,
                        sizeof(outputs[0].commands.joints)),
            0);
  EXPECT_EQ(std::memcmp(outputs[0].info.joint_acceleration, outputs[1].info.joint_acceleration,
                        sizeof(outputs[0].info.joint_acceleration)),
            0);
}

TEST(ComHeightQp, AnotherInstanceContinuesFromItsState) {
  ControllerBench b;
  ComHeightQp first(atlas());
  for (int i = 0; i < 20; ++i) {
    b.walk.tick();
    ASSERT_EQ(b.process(first), GAITD_OK);
  }
  auto state = std::make_unique<GaitdWholeBodyControllerState>();
  first.get_state(*state);
  EXPECT_EQ(state->size, sizeof(*state));
  ComHeightQp second(atlas());
  second.set_state(*state);
  b.walk.tick();
  ASSERT_EQ(b.process(first), GAITD_OK);
  const Output expected = *b.out;
  ASSERT_EQ(b.process(second), GAITD_OK);
  for (int i = 0; i < atlas().joint_count; ++i) {
    EXPECT_NEAR(b.out->commands.joints[i].torque, expected.commands.joints[i].torque, 1e-5);
    EXPECT_NEAR(b.out->commands.joints[i].position, expected.commands.joints[i].position, 1e-9);
  }
}

TEST(ComHeightQp, NeverAllocatesAfterTheFirstTicks) {
  ControllerBench b(0.004);
  ComHeightQp layer(atlas());
  for (int i = 0; i < 3; ++i) b.process(layer);
  ASSERT_FALSE(b.walk.machine.walk({.steps = 1, .length = 0.1}).refused());
  int allocations = 0;
  for (int i = 0; i < 400; ++i) {
    b.walk.tick();
    const GaitdWholeBodyControllerInput in = b.input();
    const int before = testing::allocation_count();
    layer.process(in, *b.out);
    allocations += testing::allocation_count() - before;
  }
  EXPECT_EQ(allocations, 0);
}

TEST(NullspaceQp, StraightLegsLeaveOneFreedomBentOnesNone) {
  ControllerBench bent;
  NullspaceQp controller(atlas());
  ASSERT_EQ(bent.process(controller), GAITD_OK);
  EXPECT_EQ(bent.out->info.status, GAITD_WBC_SOLVED);
  EXPECT_LT(bent.out->info.null_trace, 0.5);

  ControllerBench straight;
  straight.straighten(0.3);
  controller.reset();
  ASSERT_EQ(straight.process(controller), GAITD_OK);
  EXPECT_EQ(straight.out->info.status, GAITD_WBC_SOLVED);
  EXPECT_NEAR(straight.out->info.null_trace, 1.0, 0.3);
}

TEST(NullspaceQp, KneesAtTheSingularityGetNoTorqueSpike) {
  NullspaceQp controller(atlas());
  std::array<double, 4> torque{};
  const std::array<double, 4> knees = {0.0, 0.001, 0.01, 0.05};
  for (std::size_t i = 0; i < knees.size(); ++i) {
    ControllerBench b;
    b.straighten(knees[i]);
    controller.reset();
    for (int k = 0; k < 5; ++k) {
      ASSERT_EQ(b.process(controller), GAITD_OK);
      ASSERT_EQ(b.out->info.status, GAITD_WBC_SOLVED) << knees[i];
    }
    const int knee = atlas().legs[GAITD_LEFT].knee;
    torque[i] = b.out->commands.joints[knee].torque;
    EXPECT_LT(std::abs(torque[i]), 0.3 * atlas().joints[knee].effort_limit) << knees[i];
    if (i > 0) EXPECT_NEAR(torque[i], torque[i - 1], 0.1 * atlas().joints[knee].effort_limit);
  }
}

// The problem that all variants have in common, with limits of its own.
struct Plain {
  InverseDynamicsQp qp{atlas()};
  InverseDynamicsQp::Limits limits{};
  GaitdStatus process(const GaitdWholeBodyControllerInput& in, Output& out) {
    qp.begin(*in.robot, *in.objectives, in.objectives->momentum_mask, limits);
    qp.solve(in.time.period, 300);
    qp.write(in.time.period, {}, *in.robot, *in.objectives, out);
    return GAITD_OK;
  }
};

// More force to the side than friction gives at the weight of the robot: without the limit the free
// height is spent on it.
TEST(InverseDynamicsQp, AFreeHeightIsNotSpentOnAJump) {
  auto vertical_force = [](double rise_speed, double velocity) {
    ControllerBench b;
    b.straighten(0.6);
    b.walk.robot.com_velocity[2] = velocity;
    b.objectives->momentum_rate[4] = 14.0 * atlas().total_mass;
    Plain controller{.limits = {.rise_speed = rise_speed}};
    EXPECT_EQ(b.process(controller), GAITD_OK);
    EXPECT_EQ(b.out->info.status, GAITD_WBC_SOLVED);
    double sum = 0.0;
    for (const auto& wrench : b.out->info.foot_wrench) sum += wrench[5];
    return sum / weight();
  };
  const double free = vertical_force(100.0, 0.3);
  EXPECT_GT(free, 1.4);
  const double time = InverseDynamicsQp::Limits{}.rise_time;
  EXPECT_LE(vertical_force(0.7, 0.3), 1.0 + 0.4 / (time * atlas().gravity) + 1e-6);
  EXPECT_LE(vertical_force(0.7, 0.7), 1.0 + 1e-6);
  // Who falls may brake, within 50 ms.
  const double braked = 1.0 + (0.7 / time + 1.0 / 0.05) / atlas().gravity;
  EXPECT_GT(vertical_force(0.7, -1.0), 0.99 * std::min(0.9 * free, braked));
}

// A chest that is suddenly told to turn hard: what the torques gain in a tick is worth less the
// more it is, and contacts and limits hold all the same.
TEST(InverseDynamicsQp, TorquesDoNotJump) {
  auto largest_change = [](double weight) {
    ControllerBench b;
    b.straighten(0.3);
    Plain controller{.limits = {.torque_rate_weight = weight}};
    EXPECT_EQ(b.process(controller), GAITD_OK);
    const auto before = b.out->commands;
    for (int i = 0; i < b.objectives->task_count; ++i) {
      GaitdTask& task = b.objectives->tasks[i];
      if (task.index == atlas().chest_body) task.acceleration[0] = 60.0;
    }
    EXPECT_EQ(b.process(controller), GAITD_OK);
    EXPECT_EQ(b.out->info.status, GAITD_WBC_SOLVED);
    EXPECT_LT(b.out->info.kkt_residual, 1e-8);
    double change = 0.0;
    for (int i = 0; i < atlas().joint_count; ++i) {
      const double step = b.out->commands.joints[i].torque - before.joints[i].torque;
      change = std::max(change, std::abs(step) / atlas().joints[i].effort_limit);
      EXPECT_LE(std::abs(b.out->commands.joints[i].torque), atlas().joints[i].effort_limit + 1e-6);
    }
    return change;
  };
  const double rate = InverseDynamicsQp::Limits{}.torque_rate;
  const double free = largest_change(0.0);
  EXPECT_GT(free, 2.0 * rate * 0.001);
  EXPECT_LT(largest_change(1e6), 0.15);
}

// m/s^2, of the distance of a separation, in the solution.
double parting(const ControllerBench& b, const GaitdSeparation& s) {
  const Recomputed r(b);
  dynamics::Matrix6X jacobian(6, r.acceleration.size());
  Vector3d apart = Vector3d::Zero();
  for (int end = 0; end < 2; ++end) {
    const Vector3d point = sdk::view(s.point[end]);
    r.dynamics.frame_jacobian(s.body[end], point, jacobian);
    const Vector3d linear = jacobian.bottomRows<3>() * r.acceleration +
                            r.dynamics.frame_bias_acceleration(s.body[end], point).tail<3>();
    apart += end == 0 ? linear : Vector3d(-linear);
  }
  return sdk::view(s.normal).dot(apart);
}

TEST(InverseDynamicsQp, ASeparationIsKeptAndOneThatIsKeptAnywayChangesNothing) {
  ControllerBench b;
  b.stir(5);
  GaitdSeparation s{};
  s.body[0] = atlas().hands[GAITD_LEFT].body;
  s.body[1] = atlas().chest_body;
  s.normal[1] = 1.0;
  s.weight = 300.0;
  b.objectives->separation_count = 1;
  const auto solve = [&](double acceleration) {
    ComHeightQp layer(atlas());
    s.acceleration = acceleration;
    b.objectives->separations[0] = s;
    EXPECT_EQ(b.process(layer), GAITD_OK);
    return parting(b, s);
  };
  const double by_itself = solve(-1e3);
  const Output before = *b.out;
  EXPECT_EQ(solve(by_itself - 1.0), by_itself);
  EXPECT_EQ(std::memcmp(&before.commands, &b.out->commands, sizeof(before.commands)), 0);
  EXPECT_NEAR(solve(by_itself + 2.0), by_itself + 2.0, 0.2);
  expect_physical(b);
}

TEST(NullspaceQp, ThePrivilegedKneeDecidesWhichWayTheBodyMoves) {
  for (double goal : {-50.0, 50.0}) {
    ControllerBench b;
    b.straighten(0.4);
    for (const GaitdLeg& leg : atlas().legs) {
      b.objectives->privileged_acceleration[leg.knee] = leg.knee_bend_sign * goal;
      b.objectives->privileged_acceleration[leg.hip_pitch] = 0.5 * leg.hip_pitch_bend_sign * goal;
      b.objectives->privileged_acceleration[leg.ankle_pitch] =
          0.5 * leg.ankle_pitch_bend_sign * goal;
    }
    NullspaceQp controller(atlas());
    ASSERT_EQ(b.process(controller), GAITD_OK);
    const GaitdLeg& leg = atlas().legs[GAITD_LEFT];
    const double knee = leg.knee_bend_sign * b.out->info.joint_acceleration[leg.knee];
    EXPECT_GT(knee * goal, 0.0) << "a knee told to bend by " << goal << " got " << knee;
  }
}

// One freedom, two legs that want opposite things of it: the heavier one has its way.
TEST(NullspaceQp, WeightsSayWhichLegCounts) {
  double knee[2];
  for (int heavier : {GAITD_LEFT, GAITD_RIGHT}) {
    ControllerBench b;
    b.straighten(0.4);
    for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
      const GaitdLeg& leg = atlas().legs[side];
      const double bend = side == GAITD_LEFT ? 20.0 : -60.0;
      b.objectives->privileged_acceleration[leg.knee] = leg.knee_bend_sign * bend;
      b.objectives->privileged_acceleration[leg.hip_pitch] = 0.5 * leg.hip_pitch_bend_sign * bend;
      b.objectives->privileged_acceleration[leg.ankle_pitch] =
          0.5 * leg.ankle_pitch_bend_sign * bend;
      for (int joint : {leg.knee, leg.hip_pitch, leg.ankle_pitch}) {
        b.objectives->privileged_weight[joint] = side == heavier ? 150.0 : 5.0;
      }
    }
    NullspaceQp controller(atlas());
    ASSERT_EQ(b.process(controller), GAITD_OK);
    const GaitdLeg& left = atlas().legs[GAITD_LEFT];
    knee[heavier] = left.knee_bend_sign * b.out->info.joint_acceleration[left.knee];
  }
  EXPECT_GT(knee[GAITD_LEFT], 5.0);
  EXPECT_LT(knee[GAITD_RIGHT], -5.0);
}

}  // namespace
}  // namespace gaitd::plugins

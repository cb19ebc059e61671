// SPDX-License-Identifier: Apache-2.0
// MuJoCo as an engine: what the contract of gaitd::sim::Physics asks for, and that it agrees with
// ours where physics leaves no choice.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include "atlas_model.h"
#include "block_model.h"
#include "gaitd/sim/plant.h"
#include "mujoco_physics.h"
#include "simbody_physics.h"

namespace gaitd::sim {
namespace {

using test::atlas_model;
using test::block_config;
using test::block_model;
using test::block_state;
using test::kBlockMass;
using test::truth_of;

constexpr double kWeight = kBlockMass * 9.81;

class MujocoPlant : public Plant {
 public:
  MujocoPlant(const GaitdModel& model, const Config& config)
      : Plant(model, config, 0.001, MujocoPhysics::make) {}
};

// At the height of the soles, so that the block does not tip.
GaitdDisturbance push(double force, double duration) {
  GaitdDisturbance disturbance{};
  disturbance.point[2] = -test::kBlockHeight;
  disturbance.force[0] = force;
  disturbance.duration = duration;
  return disturbance;
}

TEST(Mujoco, TheGroundCarriesTheWeightFromTheFirstReadingOn) {
  MujocoPlant plant(block_model(), block_config());
  GaitdSensors sensors;
  plant.read(&sensors);
  EXPECT_NEAR(sensors.feet[0].force[2] + sensors.feet[1].force[2], kWeight, 1e-6);
  ASSERT_TRUE(test::run(&plant, 1));
  plant.read(&sensors);
  EXPECT_NEAR(sensors.feet[0].force[2] + sensors.feet[1].force[2], kWeight, 0.01 * kWeight);
  EXPECT_NEAR(sensors.imus[0].specific_force[2], 9.81, 0.01);
  EXPECT_LT(truth_of(plant).feet[0].penetration, 1e-4);
}

// In both engines: at rest each sole is in by half of the weight over the stiffness.
TEST(Mujoco, SinksIntoSoftGroundLikeSimbody) {
  for (const double stiffness : {2e5, 1e6}) {
    Config config = block_config();
    config.terrain.stiffness = stiffness;
    for (const PhysicsFactory& make :
         {PhysicsFactory(MujocoPhysics::make), PhysicsFactory(SimbodyPhysics::make)}) {
      Plant plant(block_model(), config, 0.001, make);
      ASSERT_TRUE(test::run(&plant, 3.0));
      const double sink = 0.5 * kWeight / stiffness;
      for (const auto& foot : truth_of(plant).feet) {
        EXPECT_NEAR(foot.penetration, sink, 0.1 * sink) << stiffness;
      }
    }
  }
}

// Under way, in both engines: the robot keeps its motion, and the ground gets the load.
TEST(Mujoco, CarriesALoadLikeSimbody) {
  Config config = block_config();
  for (const PhysicsFactory& make :
       {PhysicsFactory(MujocoPhysics::make), PhysicsFactory(SimbodyPhysics::make)}) {
    Plant plant(block_model(), config, 0.001, make);
    ASSERT_TRUE(plant.can_carry());
    ASSERT_TRUE(test::run(&plant, 0.2));
    const State before = plant.state();
    ASSERT_TRUE(plant.carry({0, 0, 0.5 * kBlockMass, {0.0, 0.0, 0.0}}));
    ASSERT_TRUE(test::run(&plant, 0.001));
    EXPECT_LT((plant.state().p_WB - before.p_WB).norm(), 1e-5);
    EXPECT_LT((plant.state().R_WB.coeffs() - before.R_WB.coeffs()).norm(), 1e-6);
    EXPECT_NEAR(plant.model().total_mass, 1.5 * kBlockMass, 1e-9);
    ASSERT_TRUE(test::run(&plant, 1.0));
    GaitdSensors sensors;
    plant.read(&sensors);
    EXPECT_NEAR(sensors.feet[0].force[2] + sensors.feet[1].force[2], 1.5 * kWeight,
                0.005 * kWeight);
    plant.reset();
    plant.read(&sensors);
    EXPECT_NEAR(sensors.feet[0].force[2] + sensors.feet[1].force[2], kWeight, 0.01 * kWeight);
    EXPECT_NEAR(plant.model().total_mass, kBlockMass, 1e-9);
  }
}

TEST(Mujoco, SticksBelowTheFrictionConeWithoutCreepingAndSlidesAboveIt) {
  MujocoPlant plant(block_model(), block_config());  // friction 0.8
  ASSERT_TRUE(test::run(&plant, 0.2));
  const double before = truth_of(plant).pelvis_position[0];
  ASSERT_TRUE(plant.disturb(push(0.5 * kWeight, 2)));
  ASSERT_TRUE(test::run(&plant, 2));
  EXPECT_NEAR(truth_of(plant).pelvis_position[0], before, 1.5e-3);
  ASSERT_TRUE(plant.disturb(push(1.0 * kWeight, 0.5)));
  ASSERT_TRUE(test::run(&plant, 0.5));
  // (1.0 - 0.8) g for 0.5 s, less than exact: the convex friction of MuJoCo lifts what slides.
  EXPECT_NEAR(truth_of(plant).com_velocity[0], 0.5 * 0.2 * 9.81, 0.2);
  EXPECT_GT(truth_of(plant).pelvis_position[0] - before, 0.15);
}

// Friction that gives way and comes back is no slip, however often.
TEST(Mujoco, OnlyWhatSlidesHasSlipped) {
  MujocoPlant plant(block_model(), block_config());  // friction 0.8
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(plant.disturb(push((i % 2 == 0 ? 0.4 : -0.4) * kWeight, 0.02)));
    ASSERT_TRUE(test::run(&plant, 0.02));
  }
  const GaitdTruth shaken = truth_of(plant);
  for (const GaitdFootTruth& foot : shaken.feet) EXPECT_EQ(foot.slip, 0);
  ASSERT_TRUE(plant.disturb(push(1.0 * kWeight, 0.2)));
  double slip = 0;
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(test::run(&plant, 0.001));
    slip = std::max(slip, truth_of(plant).feet[0].slip);
  }
  EXPECT_GT(slip, 1e-4);
}

TEST(Mujoco, APushLeavesItsImpulseAlsoWhereItEndsWithinAStep) {
  Config config = block_config();
  MujocoPlant plant(block_model(), config);
  plant.place(block_state(0, 0, 2.0));
  ASSERT_TRUE(plant.disturb(push(100, 0.0103)));
  ASSERT_TRUE(test::run(&plant, 0.05));
  EXPECT_NEAR(truth_of(plant).com_velocity[0], 100 * 0.0103 / kBlockMass, 2e-4);
}

TEST(Mujoco, AHeightMapIsRefusedAndNotLeftOut) {
  Config config = block_config();
  config.terrain.height_map =
      std::make_shared<const terrain::HeightMap>(terrain::Grid{10, 10, 0.1, {0, 0}});
  try {
    MujocoPlant plant(block_model(), config);
    ADD_FAILURE() << "it was taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("terrain.height_map"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("--backend simbody"), std::string::npos);
  }
}

TEST(Mujoco, JointInertiaIsThatOfSimbody) {
  const GaitdModel model = atlas_model();
  const Terrain flat(test::flat_config(model).terrain, 1);
  MujocoPhysics mujoco(model, flat, 0.0005);
  SimbodyPhysics simbody(model, flat, 0.0005);
  State state;
  state.p_WB.z() = 3;
  state.q = Eigen::Map<const Eigen::VectorXd>(model.nominal_position, model.joint_count);
  state.u = Eigen::VectorXd::Zero(6 + model.joint_count);
  mujoco.place(state);
  simbody.place(state);
  EXPECT_TRUE(mujoco.joint_inertia().isApprox(simbody.joint_inertia(), 1e-6));
}

// In the air there is no contact to disagree about: the same falling, swinging robot.
void expect_to_fly_alike(const GaitdModel& model, const Config& config) {
  MujocoPlant mujoco(model, config);
  Plant simbody(model, config, 0.001, SimbodyPhysics::make);
  State state;
  state.p_WB.z() = 5;
  state.R_WB = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized());
  state.q = Eigen::Map<const Eigen::VectorXd>(model.nominal_position, model.joint_count);
  state.u = Eigen::VectorXd::Constant(6 + model.joint_count, 0.4);
  GaitdJointCommands commands = test::hold_posture(model, 0.5);
  for (Plant* plant : {static_cast<Plant*>(&mujoco), &simbody}) {
    plant->place(state);
    for (int i = 0; i < 300; ++i) ASSERT_TRUE(plant->advance(commands));
  }
  EXPECT_LT((mujoco.state().p_WB - simbody.state().p_WB).norm(), 2e-3);
  EXPECT_LT(mujoco.state().R_WB.angularDistance(simbody.state().R_WB), 5e-3);
  EXPECT_LT((mujoco.state().q - simbody.state().q).cwiseAbs().maxCoeff(), 1e-2);
}

TEST(Mujoco, AFreeRobotMovesAsInSimbody) {
  const GaitdModel model = atlas_model();
  expect_to_fly_alike(model, test::flat_config(model));
}

TEST(Mujoco, WithPlayAndSpringsInItsJointsToo) {
  const GaitdModel model = atlas_model();
  for (const char* name : kDriveClasses) {
    SCOPED_TRACE(name);
    Config config = test::flat_config(model);
    config.drives.emplace();
    ASSERT_TRUE(find_drive_class(name, &*config.drives));
    expect_to_fly_alike(model, config);
  }
}

TEST(Mujoco, GainsFarBeyondWhatAnExplicitStepTakesAreStable) {
  const GaitdModel model = atlas_model();
  MujocoPlant plant(model, test::flat_config(model));
  const GaitdJointCommands commands = test::hold_posture(model, 200);
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(plant.advance(commands));
  const GaitdTruth truth = truth_of(plant);
  EXPECT_EQ(truth.body_contact, 0);
  for (int j = 0; j < model.joint_count; ++j) {
    EXPECT_NEAR(truth.joint_position[j], model.nominal_position[j], 0.01) << model.joints[j].name;
  }
}

TEST(Mujoco, StopsHoldALimpRobotAndItLiesOnTheGround) {
  const GaitdModel model = atlas_model();
  MujocoPlant plant(model, test::flat_config(model));
  const GaitdJointCommands commands = test::limp(model);
  double overshoot = 0;
  for (int i = 0; i < 4000; ++i) {
    ASSERT_TRUE(plant.advance(commands));
    for (int j = 0; j < model.joint_count; ++j) {
      const double q = plant.state().q[j];
      overshoot =
          std::max({overshoot, q - model.joints[j].position_max, model.joints[j].position_min - q});
    }
  }
  EXPECT_LT(overshoot, 0.1);
  EXPECT_EQ(truth_of(plant).body_contact, 1);
  EXPECT_LT(truth_of(plant).com[2], 0.6);
  EXPECT_GT(truth_of(plant).com[2], 0.05);
}

TEST(Mujoco, StartsOverWithTheSameBits) {
  const GaitdModel model = atlas_model();
  MujocoPlant plant(model, test::flat_config(model));
  const GaitdJointCommands commands = test::hold_posture(model);
  GaitdTruth truth[2];
  for (GaitdTruth& result : truth) {
    plant.reset();
    for (int i = 0; i < 200; ++i) ASSERT_TRUE(plant.advance(commands));
    result = truth_of(plant);
  }
  EXPECT_EQ(std::memcmp(&truth[0], &truth[1], sizeof(GaitdTruth)), 0);
}

TEST(Mujoco, AModelThatItDoesNotTakeIsRefusedInWords) {
  GaitdModel model = block_model();
  model.bodies[0].inertia[0] = 100;  // larger than the sum of the others
  try {
    const MujocoPlant plant(model, block_config());
    FAIL() << "taken";
  } catch (const std::invalid_argument& problem) {
    EXPECT_NE(std::string(problem.what()).find("MuJoCo refuses the model: "), std::string::npos)
        << problem.what();
  }
}

// A scenario's heights are rounded: a hair above the ground is on it.
TEST(Start, AHairAboveTheGroundIsOnIt) {
  for (const double height : {0.0, 4e-5, 9e-4}) {
    Config config = block_config();
    config.start.z = height;
    const MujocoPlant plant(block_model(), config);
    GaitdSensors sensors;
    plant.read(&sensors);
    EXPECT_NEAR(sensors.feet[0].force[2] + sensors.feet[1].force[2], kWeight, 1e-6) << height;
  }
  Config config = block_config();
  config.start.z = 0.05;
  const MujocoPlant plant(block_model(), config);
  EXPECT_NEAR(truth_of(plant).feet[0].position[2], 0.05, 1e-4);
}

}  // namespace
}  // namespace gaitd::sim

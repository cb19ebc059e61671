// SPDX-License-Identifier: Apache-2.0
#include "gaitd/dynamics/model_check.h"

#include <gtest/gtest.h>

#include <limits>

#include "random_model.h"

namespace gaitd::dynamics {
namespace {

// One error, and it holds `text`.
void expect_error(const GaitdModel& model, const std::string& text) {
  const std::vector<std::string> errors = check_model(model);
  ASSERT_EQ(errors.size(), 1u) << "for " << text;
  EXPECT_NE(errors[0].find(text), std::string::npos) << errors[0];
}

class ModelCheck : public testing::Test {
 protected:
  Random random{1};
  GaitdModel model = make_random_model(8, &random);
};

TEST_F(ModelCheck, AcceptsRobots) {
  EXPECT_TRUE(check_model(model).empty());
  EXPECT_TRUE(check_model(load_atlas()).empty());
}

TEST_F(ModelCheck, RefusesCountsOutOfRange) {
  model.joint_count = GAITD_MAX_JOINTS + 1;
  model.body_count = GAITD_MAX_JOINTS + 2;
  expect_error(model, "65 joints and 66 bodies");
  model.joint_count = -1;
  model.body_count = 0;
  expect_error(model, "-1 joints");
  model.joint_count = 8;
  model.body_count = 8;
  expect_error(model, "one body more");
}

TEST_F(ModelCheck, RefusesAParentAfterItsChild) {
  model.bodies[2].parent = model.joints[1].parent_body = 5;
  expect_error(model, "body 2 'body2': parent 5");
}

TEST_F(ModelCheck, RefusesJointAndBodyThatDisagree) {
  model.joints[3].parent_body = model.bodies[4].parent + 1;
  expect_error(model, "joint 3 'joint3': parent body");
}

TEST_F(ModelCheck, RefusesWrongFigures) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [this](auto change, const std::string& text) {
    GaitdModel changed = model;
    change(&changed);
    expect_error(changed, text);
  };
  refused([](GaitdModel* m) { m->gravity = 0; }, "gravity is 0");
  refused([](GaitdModel* m) { m->bodies[1].mass = -1; }, "mass is -1 kg");
  refused([=](GaitdModel* m) { m->bodies[1].mass = nan; }, "mass is nan kg");
  refused([=](GaitdModel* m) { m->bodies[1].com[2] = nan; }, "centre of mass is not finite");
  refused([=](GaitdModel* m) { m->bodies[1].inertia[2] = nan; }, "inertia is not finite");
  refused([](GaitdModel* m) { m->bodies[1].inertia[0] = -1; }, "not positive definite");
  refused([](GaitdModel* m) { m->joints[1].type = 7; }, "type 7");
  refused([=](GaitdModel* m) { m->joints[1].origin[0] = nan; }, "origin is not finite");
  refused([](GaitdModel* m) { m->joints[1].axis[0] += 0.1; }, "length of the axis");
  refused([](GaitdModel* m) { m->joints[1].orientation[3] += 0.5; }, "length of the orientation");
  refused([](GaitdModel* m) { m->joints[1].position_min = 9; }, "position limits 9 to 3");
  refused([](GaitdModel* m) { m->joints[1].velocity_limit = 0; }, "velocity limit is 0");
  refused([](GaitdModel* m) { m->joints[1].effort_limit = 0; }, "effort limit is 0");
  refused([](GaitdModel* m) { m->joints[1].rotor_inertia = -1; }, "rotor inertia is -1");
  refused([=](GaitdModel* m) { m->joints[1].damping = nan; }, "damping is nan");
}

TEST_F(ModelCheck, ReportsEverythingAtOnce) {
  model.bodies[1].mass = 0;
  model.joints[2].effort_limit = 0;
  model.gravity = -1;
  EXPECT_EQ(check_model(model).size(), 3u);
}

TEST(CheckInertia, KnowsThePhysicalOnes) {
  const auto diagonal = [](double x, double y, double z) {
    return Eigen::Matrix3d(Eigen::Vector3d(x, y, z).asDiagonal());
  };
  EXPECT_EQ(check_inertia(diagonal(1, 2, 2.9), false), "");
  EXPECT_EQ(check_inertia(diagonal(1, 2, 3), false), "");  // a flat plate
  EXPECT_NE(check_inertia(diagonal(1, 2, 3.1), false), "");
  EXPECT_NE(check_inertia(diagonal(0, 1, 1), false), "");
  EXPECT_EQ(check_inertia(diagonal(0, 1, 1), true), "");  // a thin rod
  EXPECT_EQ(check_inertia(diagonal(0, 0, 0), true), "");  // a point
  EXPECT_NE(check_inertia(diagonal(-1, 1, 1), true), "");
}

}  // namespace
}  // namespace gaitd::dynamics

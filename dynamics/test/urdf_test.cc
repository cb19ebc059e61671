// SPDX-License-Identifier: Apache-2.0
// What a good file becomes.
#include "gaitd/dynamics/urdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "gaitd/dynamics/dynamics.h"

namespace gaitd::dynamics {
namespace {

std::string link(const std::string& name, const std::string& mass = "2") {
  return "<link name='" + name + "'><inertial><origin xyz='0.1 0.2 0.3' rpy='0.1 0.2 0.3'/><mass " +
         "value='" + mass + "'/><inertia ixx='1' iyy='1.2' izz='0.9' ixy='0.1' ixz='0' " +
         "iyz='-0.05'/></inertial></link>\n";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& inside = "",
                  const std::string& xyz = "0 0.1 -0.4") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + xyz + "' rpy='0.5 -0.2 0.7'/>" + inside +
         "</joint>\n";
}

const char kLimit[] = "<axis xyz='0 2 0'/><limit lower='-1' upper='2' velocity='3' effort='4'/>";

std::string robot(const std::string& inside) {
  return "<robot name='test'>\n" + inside + "</robot>\n";
}

std::string all(const std::vector<std::string>& errors) {
  std::string text;
  for (const std::string& error : errors) text += error + "\n";
  return text;
}

TEST(Urdf, AtlasHasItsPublishedFigures) {
  const UrdfResult result = load_urdf(GAITD_ATLAS_URDF);
  ASSERT_TRUE(result.ok()) << all(result.errors);
  const GaitdModel& model = result.model;
  EXPECT_EQ(model.size, sizeof(GaitdModel));
  EXPECT_STREQ(model.name, "atlas");
  EXPECT_EQ(model.body_count, 31);
  EXPECT_EQ(model.joint_count, 30);
  EXPECT_EQ(result.links.size(), 31u);
  EXPECT_NEAR(model.total_mass, 175.118, 0.0005);
  EXPECT_STREQ(model.bodies[0].name, "pelvis");

  const UrdfLink* foot = result.find_link("l_foot");
  ASSERT_NE(foot, nullptr);
  const GaitdJoint& ankle = model.joints[foot->body - 1];
  EXPECT_STREQ(ankle.name, "l_leg_akx");
  EXPECT_EQ(ankle.effort_limit, 360);
  EXPECT_EQ(ankle.velocity_limit, 12);
  EXPECT_EQ(ankle.position_min, -0.8);
  EXPECT_EQ(model.bodies[foot->body].mass, 2.41);
  EXPECT_EQ(result.find_link("no_such_link"), nullptr);
}

TEST(Urdf, AtlasIsSymmetricAndStandsOnItsSoles) {
  const UrdfResult result = load_urdf(GAITD_ATLAS_URDF);
  ASSERT_TRUE(result.ok()) << all(result.errors);
  Kinematics kinematics(result.model);  // at zero: upright, legs straight
  const Eigen::Vector3d left = kinematics.p_WB(result.find_link("l_foot")->body);
  const Eigen::Vector3d right = kinematics.p_WB(result.find_link("r_foot")->body);
  EXPECT_NEAR(left.y(), 0.089 + 0.0225, 1e-12);
  EXPECT_NEAR(left.z(), -0.066 - 0.374 - 0.422, 1e-12);
  EXPECT_NEAR((left - right.cwiseProduct(Eigen::Vector3d(1, -1, 1))).norm(), 0, 1e-12);
  const Eigen::Vector3d hand = kinematics.p_WB(result.find_link("l_hand")->body);
  EXPECT_GT(hand.y(), 0.5);  // arms to the side
  EXPECT_NEAR(kinematics.com().y(), 0, 0.01);
}

TEST(Urdf, JointsAreNumberedDepthFirstAndAlphabetically) {
  const UrdfResult result = load_urdf_text(robot(
      link("root") + link("a") + link("b") + link("c") + link("d") +
      joint("z", "revolute", "root", "a", kLimit) + joint("y", "revolute", "a", "b", kLimit) +
      joint("m", "prismatic", "root", "c", kLimit) + joint("x", "revolute", "c", "d", kLimit)));
  ASSERT_TRUE(result.ok()) << all(result.errors);
  std::string order;
  for (int i = 0; i < result.model.joint_count; ++i) order += result.model.joints[i].name;
  EXPECT_EQ(order, "mxzy");
  EXPECT_EQ(result.model.joints[0].type, GAITD_JOINT_PRISMATIC);
  EXPECT_EQ(result.model.joints[1].parent_body, 1);
  EXPECT_EQ(result.model.joints[2].parent_body, 0);
  EXPECT_EQ(result.model.joints[3].parent_body, 3);
  EXPECT_EQ(result.model.joints[0].axis[1], 1);  // normalised
}

// A robot with fixed links must move as if each had a joint of its own that never moves.
TEST(Urdf, FixedLinksAreMergedExactly) {
  const auto text = [](const std::string& type) {
    return robot(link("root", "3") + link("mid", "0.5") + link("tip") + link("end") +
                 joint("j1", type, "root", "mid", kLimit) +
                 joint("j2", "revolute", "mid", "tip", kLimit, "0.2 -0.3 0.1") +
                 joint("j3", type, "tip", "end", kLimit));
  };
  const UrdfResult merged = load_urdf_text(text("fixed"));
  const UrdfResult moving = load_urdf_text(text("revolute"));
  ASSERT_TRUE(merged.ok() && moving.ok()) << all(merged.errors) << all(moving.errors);
  ASSERT_EQ(merged.model.joint_count, 1);
  EXPECT_STREQ(merged.model.bodies[1].name, "tip");
  Dynamics a(merged.model), b(moving.model);
  const Eigen::Quaterniond R_WP(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  Vector6d V;
  V << 0.1, -0.4, 0.3, 1, 2, -0.5;
  const Eigen::Vector3d p(1, 2, 3);
  a.update(p, R_WP, V, Eigen::VectorXd::Constant(1, 0.4), Eigen::VectorXd::Constant(1, -2));
  b.update(p, R_WP, V, Eigen::Vector3d(0, 0.4, 0), Eigen::Vector3d(0, -2, 0));
  const std::vector<int> kept = {0, 1, 2, 3, 4, 5, 7};
  EXPECT_LE((a.mass_matrix() - b.mass_matrix()(kept, kept)).norm(), 1e-12);
  EXPECT_LE((a.bias() - b.bias()(kept)).norm(), 1e-12 * b.bias().norm());
  EXPECT_LE((a.com() - b.com()).norm(), 1e-14);

  ASSERT_EQ(merged.links.size(), 4u);
  for (const UrdfLink& l : merged.links) {
    const Eigen::Isometry3d X_WL =
        a.X_WB(l.body) * Eigen::Translation3d(l.p_BL) * Eigen::Isometry3d(l.R_BL);
    const Eigen::Isometry3d expected = b.X_WB(moving.find_link(l.name)->body);
    EXPECT_LE((X_WL.matrix() - expected.matrix()).norm(), 1e-12) << l.name;
  }
}

// What is fixed needs no drive; it stays where its range is nearest to zero.
TEST(Urdf, FixesJointsByNameAndThoseThatMimic) {
  const std::string text = robot(
      link("pelvis") + link("leg") + link("finger") + link("tip") +
      joint("hip", "revolute", "pelvis", "leg", kLimit) +
      joint("grip_1", "revolute", "leg", "finger", "<limit lower='0.5' upper='1' effort='0'/>") +
      joint("grip_2", "revolute", "finger", "tip", "<mimic joint='hip'/>"));
  UrdfOptions options;
  options.fixed = {"grip_1", "no_*"};
  const UrdfResult result = load_urdf_text(text, "t", options);
  ASSERT_TRUE(result.ok()) << all(result.errors);
  EXPECT_EQ(result.model.joint_count, 1);
  EXPECT_EQ(result.find_link("tip")->body, 1);
  UrdfOptions other = options;
  std::string at_zero = text;
  at_zero.replace(at_zero.find("lower='0.5'"), 11, "lower='-1'");
  const UrdfResult zero = load_urdf_text(at_zero, "t", other);
  EXPECT_NEAR(result.find_link("finger")->R_BL.angularDistance(zero.find_link("finger")->R_BL), 0.5,
              1e-7);
  EXPECT_EQ(result.unused_fixed, std::vector<std::string>{"no_*"});
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_NE(result.warnings[0].find("joint 'grip_2': <mimic>"), std::string::npos);
}

TEST(Urdf, TakesAPelvisThatLooksElsewhere) {
  UrdfOptions options;
  options.R_LB = Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitZ());  // forward is its y axis
  const std::string text =
      robot(link("pelvis") + link("leg") + joint("hip", "revolute", "pelvis", "leg", kLimit));
  const UrdfResult result = load_urdf_text(text, "t", options);
  ASSERT_TRUE(result.ok()) << all(result.errors);
  EXPECT_NEAR(result.model.joints[0].origin[0], 0.1, 1e-12);  // y of the link
  EXPECT_NEAR(result.model.joints[0].origin[1], 0.0, 1e-12);
}

TEST(Urdf, MovesAnImpossibleInertiaToTheNearestPossibleOne) {
  for (const double most : {0.041, 0.06}) {  // rounded; wrong, as some published ones are
    const std::string part =
        "<link name='a'><inertial><mass value='1'/><inertia ixx='0.02' iyy='0.02' izz='" +
        std::to_string(most) + "'/></inertial></link>";
    UrdfOptions options;
    options.nearest_inertias = most > 0.05;
    const UrdfResult result = load_urdf_text(robot(part), "t", options);
    ASSERT_TRUE(result.ok()) << all(result.errors);
    EXPECT_EQ(result.far_inertias, most > 0.05);
    ASSERT_EQ(result.warnings.size(), 1u);
    EXPECT_NE(result.warnings[0].find("sum of the two others"), std::string::npos);
    const double* inertia = result.model.bodies[0].inertia;
    EXPECT_NEAR(inertia[5], most, 1e-6);
    EXPECT_NEAR(inertia[0], 0.5 * most, 1e-5);
    EXPECT_GE(inertia[0] + inertia[3], inertia[5]);
  }
}

TEST(Urdf, TakesAMassWithoutAnInertiaForABallOfWater) {
  for (const char* inertia :
       {"<inertia ixx='0' iyy='0' izz='0'/>", "<inertia ixx='0' iyy='-2.4e-35' izz='0'/>", ""}) {
    const UrdfResult result =
        load_urdf_text(robot(std::string("<link name='a'><inertial><mass value='4.19'/>") +
                             inertia + "</inertial></link>"),
                       "t");
    ASSERT_TRUE(result.ok()) << all(result.errors);
    ASSERT_EQ(result.warnings.size(), 1u);
    for (const int moment : {0, 3, 5}) {
      EXPECT_NEAR(result.model.bodies[0].inertia[moment], 0.4 * 4.19 * 0.01, 1e-4);
    }
  }
}

TEST(Urdf, ALinkBetweenTwoJointsMayLackAMass) {
  const UrdfResult result = load_urdf_text(robot(link("a") + "<link name='cross'/>" + link("b") +
                                                 joint("roll", "revolute", "a", "cross", kLimit) +
                                                 joint("pitch", "revolute", "cross", "b", kLimit)),
                                           "t");
  ASSERT_TRUE(result.ok()) << all(result.errors);
  EXPECT_NE(
      all(result.warnings).find("'cross' moves without a mass; that of a ball of water of 10 g"),
      std::string::npos)
      << all(result.warnings);
  EXPECT_EQ(result.warnings.size(), 1u);
  EXPECT_EQ(result.model.bodies[1].mass, 0.01);
  EXPECT_GT(result.model.bodies[1].inertia[0], 0.0);
}

TEST(Urdf, LimitsMayBeLeftToWhoeverKnowsThem) {
  const std::string text = robot(
      link("a") + link("b") + link("c") + link("d") +
      joint("bare", "revolute", "a", "b", "<limit/>") + joint("none", "revolute", "b", "c", "") +
      joint("range", "revolute", "c", "d", "<limit lower='-1' upper='2'/>"));
  UrdfOptions options;
  EXPECT_EQ(load_urdf_text(text, "t", options).errors.size(), 6u);
  options.limits_required = false;
  const UrdfResult result = load_urdf_text(text, "t", options);
  ASSERT_TRUE(result.ok()) << all(result.errors);
  EXPECT_EQ(all(result.joints_without_range), "bare\nnone\n");
  EXPECT_EQ(result.model.joints[0].effort_limit, kNoUrdfLimit);
  EXPECT_EQ(result.model.joints[1].velocity_limit, kNoUrdfLimit);
  EXPECT_EQ(result.model.joints[1].position_max, kNoUrdfLimit);
  EXPECT_EQ(result.model.joints[2].position_max, 2.0);
}

TEST(Urdf, FloatsOnAnEmptyWorld) {
  const UrdfResult result =
      load_urdf_text(robot("<link name='world'/>" + link("pelvis") + link("leg") +
                           "<joint name='free' type='floating'><parent link='world'/><child "
                           "link='pelvis'/></joint>" +
                           joint("hip", "revolute", "pelvis", "leg", kLimit)),
                     "t");
  ASSERT_TRUE(result.ok()) << all(result.errors);
  EXPECT_STREQ(result.model.bodies[0].name, "pelvis");
}

TEST(Urdf, ALinkFixedToTheRootCanBeTheBase) {
  const std::string text = robot("<link name='base'/>" + link("pelvis") + link("leg") +
                                 joint("weld", "fixed", "base", "pelvis") +
                                 joint("hip", "revolute", "pelvis", "leg", kLimit));
  UrdfOptions options;
  options.root_link = "pelvis";
  const UrdfResult result = load_urdf_text(text, "t", options);
  ASSERT_TRUE(result.ok()) << all(result.errors);
  EXPECT_STREQ(result.model.bodies[0].name, "pelvis");
  EXPECT_LE(result.find_link("pelvis")->p_BL.norm(), 1e-15);
  EXPECT_NEAR(result.model.bodies[0].com[0], 0.1, 1e-15);
  EXPECT_NEAR(result.model.joints[0].origin[2], -0.4, 1e-15);
  const UrdfLink* base = result.find_link("base");
  EXPECT_NEAR((base->R_BL.inverse() * -base->p_BL - Eigen::Vector3d(0, 0.1, -0.4)).norm(), 0,
              1e-15);
}

// Of many robots the torso is the root and the pelvis hangs on the waist.
TEST(Urdf, APelvisThatHangsOnMovingJointsIsTurnedIntoTheRoot) {
  const std::string slide =
      "<axis xyz='1 0 1'/><limit lower='-1' upper='2' velocity='3' effort='4'/>";
  const std::string text =
      robot(link("torso") + link("head") + link("waist") + link("plate") + link("pelvis") +
            link("leg") + joint("neck", "revolute", "torso", "head", kLimit) +
            joint("lift", "prismatic", "torso", "waist", slide) +
            joint("bolt", "fixed", "waist", "plate") +
            joint("turn", "revolute", "plate", "pelvis", kLimit, "0.3 0 -0.1") +
            joint("hip", "revolute", "pelvis", "leg", kLimit));
  UrdfOptions options;
  options.root_link = "pelvis";
  options.R_LB = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ());
  const UrdfResult from_torso = load_urdf_text(text);
  const UrdfResult from_pelvis = load_urdf_text(text, "<text>", options);
  ASSERT_TRUE(from_torso.ok() && from_pelvis.ok()) << all(from_pelvis.errors);
  const GaitdModel& model = from_pelvis.model;
  ASSERT_EQ(model.joint_count, 4);
  EXPECT_STREQ(model.bodies[0].name, "pelvis");
  EXPECT_STREQ(model.joints[0].name, "hip");
  EXPECT_STREQ(model.joints[1].name, "turn");
  EXPECT_STREQ(model.bodies[2].name, "plate");
  EXPECT_STREQ(model.joints[2].name, "lift");
  EXPECT_STREQ(model.bodies[3].name, "torso");
  EXPECT_NEAR(model.total_mass, from_torso.model.total_mass, 1e-12);

  // At the same positions of the same joints all links stand to each other as before.
  const auto poses_of_links = [](const UrdfResult& result) {
    Eigen::VectorXd q(result.model.joint_count);
    for (int i = 0; i < q.size(); ++i) {
      const std::string name = result.model.joints[i].name;
      q[i] = name == "neck" ? 0.4 : name == "lift" ? -0.3 : name == "turn" ? 0.7 : -0.5;
    }
    Kinematics kinematics(result.model);
    kinematics.update(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity(),
                      dynamics::Vector6d::Zero(), q, Eigen::VectorXd::Zero(q.size()));
    std::map<std::string, Eigen::Isometry3d> poses;
    for (const UrdfLink& link : result.links) {
      poses[link.name] = kinematics.X_WB(link.body) * Eigen::Translation3d(link.p_BL) * link.R_BL;
    }
    return std::pair(poses, Eigen::Vector3d(poses["leg"].inverse() * kinematics.com()));
  };
  const auto [expected, com] = poses_of_links(from_torso);
  const auto [got, com_got] = poses_of_links(from_pelvis);
  for (const auto& [name, pose] : got) {
    EXPECT_TRUE((got.at("leg").inverse() * pose)
                    .isApprox(expected.at("leg").inverse() * expected.at(name), 1e-12))
        << name;
  }
  EXPECT_LT((com - com_got).norm(), 1e-12);
}

TEST(Urdf, ContinuousJointsHaveNoStopsAndDampingIsKept) {
  const UrdfResult result =
      load_urdf_text(robot(link("a") + link("b") +
                           joint("j", "continuous", "a", "b",
                                 "<limit velocity='3' effort='4'/><dynamics damping='0.25'/>")));
  ASSERT_TRUE(result.ok()) << all(result.errors);
  const GaitdJoint& j = result.model.joints[0];
  EXPECT_EQ(j.type, GAITD_JOINT_REVOLUTE);
  EXPECT_EQ(j.position_min, -1e9);
  EXPECT_EQ(j.position_max, 1e9);
  EXPECT_EQ(j.damping, 0.25);
  EXPECT_EQ(j.axis[0], 1);  // the default axis
}

}  // namespace
}  // namespace gaitd::dynamics

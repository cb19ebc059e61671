// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "cli/robot/ankle_reach.h"
#include "cli/robot/describe.h"
#include "cli/robot/find_legs.h"
#include "cli/robot/fixed_joints.h"
#include "cli/robot/proportions.h"
#include "cli/robot/robot_init.h"
#include "cli/robot/sole_shape.h"
#include "gaitd/dynamics/mesh_points.h"

namespace gaitd::porting {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::vector<ShapePoint> box(const Vector3d& low, const Vector3d& high) {
  std::vector<ShapePoint> points;
  for (int i = 0; i < 8; ++i) {
    points.push_back({{(i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                       (i & 4) != 0 ? high.z() : low.z()}});
  }
  return points;
}

// What people measured at Atlas by hand is found from its URDF alone.
TEST(RobotInit, FindsWhatIsKnownOfAtlas) {
  Guess guess;
  std::string error;
  ASSERT_TRUE(guess_robot(GAITD_ATLAS_URDF, "atlas", {}, &guess, &error)) << error;
  const GaitdModel& model = guess.model;
  EXPECT_STREQ(model.bodies[0].name, "pelvis");
  EXPECT_TRUE(guess.options.R_LB.isApprox(Eigen::Quaterniond::Identity()));
  EXPECT_EQ(guess.chest, "utorso");
  EXPECT_STREQ(model.joints[guess.legs[0].hip_pitch].name, "l_leg_hpy");
  EXPECT_STREQ(model.joints[guess.legs[0].knee].name, "l_leg_kny");
  EXPECT_STREQ(model.joints[guess.legs[1].ankle_pitch].name, "r_leg_aky");
  EXPECT_STREQ(model.joints[guess.legs[1].ankle_roll].name, "r_leg_akx");
  const Vector3d sole = guess.soles[0].frame.X_LF.translation();
  EXPECT_LT((sole - Vector3d(0.0426, 0.0017, -0.07645)).norm(), 1e-4) << sole.transpose();
  ASSERT_EQ(guess.soles[0].outline.size(), 4u);
  EXPECT_NEAR(polygon_area(guess.soles[0].outline), 0.2604 * 0.1286, 1e-4);
  EXPECT_NEAR(model.nominal_position[guess.legs[0].knee], 0.5, 1e-6);
  EXPECT_NEAR(model.nominal_foot_separation, 0.2264, 2e-3);
  EXPECT_NEAR(guess.proportions.scale, 1.0, 0.05);
}

TEST(RobotInit, SaysWhyItEnds) {
  Guess guess;
  std::string error;
  EXPECT_FALSE(guess_robot("/no/such.urdf", "r", {}, &guess, &error));
  EXPECT_NE(error.find("cannot be read"), std::string::npos) << error;
  const std::string file = testing::TempDir() + "gaitd_arm.urdf";
  std::ofstream(file) << "<robot name='r'><link name='a'><inertial><mass value='1'/><inertia "
                         "ixx='1' iyy='1' izz='1'/></inertial></link></robot>";
  EXPECT_TRUE(describe_robot(file, "r.urdf", "r", {}, &error).empty());
  EXPECT_NE(error.find("no two legs"), std::string::npos) << error;
  std::filesystem::remove(file);
}

// One drive turns both hips of a NAO: with only the one that mimics fixed, its legs would differ.
TEST(FixedJoints, OneThatIsMimickedByItsMirrorIsFixedWithIt) {
  dynamics::UrdfOutline outline;
  for (const std::string side : {"L", "R"}) {
    dynamics::UrdfJointNote hip{side + "Hip", "torso", side + "Thigh", "revolute"};
    hip.has_effort = true;
    if (side == "R") {
      hip.mimic = true;
      hip.mimicked = "LHip";
    }
    dynamics::UrdfJointNote knee{side + "Knee", side + "Thigh", side + "Shin", "revolute"};
    knee.has_effort = true;
    outline.joints.push_back(hip);
    outline.joints.push_back(knee);
    outline.links_with_mass.insert({side + "Thigh", side + "Shin"});
  }
  std::vector<std::string> fixed;
  for (const FixedGuess& one : joints_to_fix(outline)) fixed.push_back(one.joint);
  EXPECT_EQ(fixed, (std::vector<std::string>{"RHip", "LHip"}));
}

TEST(Names, AreReadInWords) {
  EXPECT_EQ(spaced("LHipYaw"), "L_Hip_Yaw");
  EXPECT_EQ(spaced("leg_l1_joint"), "leg_l_1_joint");
  EXPECT_EQ(spaced("ImuTorsoGyrometer_frame"), "Imu_Torso_Gyrometer_frame");
  EXPECT_EQ(spaced("left_knee_joint"), "left_knee_joint");
  EXPECT_EQ(spaced("r_leg_akx"), "r_leg_akx");
}

// A corner that rounding puts beside a long edge is one nevertheless.
TEST(SoleShape, KeepsCornersThatAreNotQuiteInLine) {
  const std::vector<Vector2d> corners = {
      {-0.07, -0.028}, {-0.07 - 1e-8, -0.02}, {-0.07, 0.028}, {0.17, 0.028}, {0.17, -0.028}};
  EXPECT_NEAR(polygon_area(convex_hull(corners, 0.0)), 0.24 * 0.056, 1e-8);
}

// A sole is no larger than its ankle holds, and the frame is in the middle of it.
TEST(SoleShape, IsCutToWhatTheAnkleHolds) {
  Guess guess;
  std::string error;
  ASSERT_TRUE(guess_robot(GAITD_ATLAS_URDF, "atlas", {}, &guess, &error)) << error;
  SoleGuess sole = guess.soles[0];
  cut_to_ankle(guess, GAITD_LEFT, &sole);
  EXPECT_EQ(sole.outline, guess.soles[0].outline);  // 890 N m hold all of it
  guess.urdf.model.joints[guess.legs[0].ankle_pitch].effort_limit = 100.0;
  cut_to_ankle(guess, GAITD_LEFT, &sole);
  const double reach = 0.9 * 100.0 / (guess.urdf.model.total_mass * 9.81);
  Vector2d most = sole.outline[0];
  for (const Vector2d& p : sole.outline) most = most.cwiseMax(p);
  EXPECT_NEAR(most.x(), reach, 1e-4);
  EXPECT_NEAR(sole.frame.X_LF.translation().x(), 0.0, 1e-4);
  EXPECT_NE(sole.frame.why.back().find("holds the whole robot 52 mm"), std::string::npos)
      << sole.frame.why.back();
}

TEST(SoleShape, IsTheLowerFaceOfABox) {
  SoleGuess sole;
  std::string error;
  const auto points = box({-0.1, -0.05, -0.08}, {0.2, 0.05, -0.02});
  ASSERT_TRUE(find_sole(points, -Vector3d::UnitZ(), Vector3d::UnitX(), &sole, &error)) << error;
  EXPECT_LT((sole.frame.X_LF.translation() - Vector3d(0.05, 0, -0.08)).norm(), 1e-9);
  EXPECT_TRUE(sole.frame.X_LF.linear().isIdentity(1e-9));
  EXPECT_NEAR(polygon_area(sole.outline), 0.03, 1e-9);
}

// A foot that hangs by 0.2 rad still has its sole where the box is flat.
TEST(SoleShape, FollowsAFootThatHangsTilted) {
  SoleGuess sole;
  std::string error;
  const auto points = box({-0.1, -0.05, -0.08}, {0.2, 0.05, -0.02});
  const Vector3d down(std::sin(0.2), 0, -std::cos(0.2));
  const Vector3d forward(std::cos(0.2), 0, std::sin(0.2));
  ASSERT_TRUE(find_sole(points, down, forward, &sole, &error)) << error;
  EXPECT_TRUE(sole.frame.X_LF.linear().isIdentity(1e-6));
}

TEST(SoleShape, StandsOnSpheresAndNotOnOne) {
  SoleGuess sole;
  std::string error;
  std::vector<ShapePoint> points;
  for (const double x : {-0.05, 0.12}) {
    for (const double y : {-0.03, 0.03}) points.push_back({{x, y, -0.03}, 0.005});
  }
  ASSERT_TRUE(find_sole(points, -Vector3d::UnitZ(), Vector3d::UnitX(), &sole, &error)) << error;
  EXPECT_NEAR(sole.frame.X_LF.translation().z(), -0.035, 1e-9);
  EXPECT_NEAR(polygon_area(sole.outline), 0.17 * 0.06, 1e-9);
  points.resize(1);
  EXPECT_FALSE(find_sole(points, -Vector3d::UnitZ(), Vector3d::UnitX(), &sole, &error));
}

TEST(SoleShape, HasAtMostSevenCornersAllInside) {
  std::vector<ShapePoint> points;
  for (int i = 0; i < 100; ++i) {
    const double angle = 2 * M_PI * i / 100;
    points.push_back({{0.1 * std::cos(angle), 0.05 * std::sin(angle), 0}});
  }
  SoleGuess sole;
  std::string error;
  ASSERT_TRUE(find_sole(points, -Vector3d::UnitZ(), Vector3d::UnitX(), &sole, &error)) << error;
  ASSERT_EQ(sole.outline.size(), 7u);
  for (const Vector2d& corner : sole.outline) {
    const Vector2d p = corner + sole.frame.X_LF.translation().head<2>();
    EXPECT_LE(std::hypot(p.x() / 0.1, p.y() / 0.05), 1.0 + 3e-4);
  }
  EXPECT_GT(polygon_area(sole.outline), 0.85 * M_PI * 0.1 * 0.05);
}

// A mesh has corners along its straight edges. None is left of them, rounded as robot.yaml is.
TEST(SoleShape, IsConvexAsItIsWritten) {
  const std::vector<Vector2d> outline = {
      {-0.07, -0.0361}, {0.17, -0.0601}, {0.171, 0.06}, {-0.0703, 0.0359}};
  std::vector<ShapePoint> points;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d way = outline[(i + 1) % outline.size()] - outline[i];
    for (int k = 0; k < 7; ++k) {
      const Vector2d p = outline[i] + k / 7.0 * way + Vector2d(way.y(), -way.x()) * 1e-5 * (k % 2);
      points.push_back({{static_cast<float>(p.x()), static_cast<float>(p.y()), -0.08}});
    }
  }
  SoleGuess sole;
  std::string error;
  ASSERT_TRUE(find_sole(points, -Vector3d::UnitZ(), Vector3d::UnitX(), &sole, &error)) << error;
  ASSERT_EQ(sole.outline.size(), 4u);
  for (const Vector2d& p : sole.outline) {
    EXPECT_NEAR(std::remainder(p.x(), 1e-5), 0.0, 1e-12);
    EXPECT_NEAR(std::remainder(p.y(), 1e-5), 0.0, 1e-12);
  }
}

// A box whose faces are neither level nor along the axes of the link.
TEST(SoleShape, IsTheFaceOfABoxThatLiesAskew) {
  Guess guess;
  guess.outline.shapes.emplace_back();
  dynamics::UrdfShape& shape = guess.outline.shapes.back();
  shape.link = "foot";
  shape.kind = dynamics::ShapeKind::kBox;
  shape.collision = true;
  shape.size = {0.24, 0.1, 0.02};
  const Eigen::Matrix3d R(Eigen::AngleAxisd(0.4, Vector3d(0.6, 0.8, 0)));
  shape.X_LS.linear() = R;
  guess.urdf.links.push_back({"foot", 1, Vector3d::Zero(), Eigen::Quaterniond::Identity()});
  Reasons why;
  SoleGuess sole;
  std::string error;
  ASSERT_TRUE(find_sole(shape_points(guess, 1, true, &why), -Vector3d::UnitZ(), Vector3d::UnitX(),
                        &sole, &error))
      << error;
  EXPECT_LT((sole.frame.X_LF.linear().col(2) - R.col(2)).norm(), 1e-6);
  EXPECT_NEAR(polygon_area(sole.outline), 0.024, 1e-5);
}

TEST(FixedJoints, AreThoseThatWalkingHasNoUseFor) {
  dynamics::UrdfOutline outline;
  outline.joints = {{"knee", "a", "b", "revolute", false, true},
                    {"thumb_1", "b", "c", "revolute", false, true},
                    {"follower", "b", "d", "revolute", true, true},
                    {"neck", "a", "e", "revolute", false, false},
                    {"ring_joint", "a", "left_hand_ring_1", "revolute", false, true},
                    {"camera", "a", "g", "revolute", false, true, false},
                    {"tip", "b", "h", "revolute", false, true},
                    {"slide", "a", "i", "planar", false, false},
                    {"weld", "a", "f", "fixed", false, false}};
  outline.links_with_mass = {"a", "c", "d", "e", "g", "left_hand_ring_1"};
  std::vector<std::string> names;
  for (const FixedGuess& fixed : joints_to_fix(outline)) names.push_back(fixed.joint);
  EXPECT_EQ(names, (std::vector<std::string>{"thumb_1", "follower", "neck", "ring_joint", "camera",
                                             "tip", "slide"}));
  EXPECT_EQ(joints_without_limits(outline), "neck, camera");
}

TEST(Proportions, LeaveARobotLikeAtlasAlone) {
  Proportions p;
  p.scale = 0.9;
  EXPECT_TRUE(scaled_parameters(p).empty());
  p.scale = 0.5;
  EXPECT_FALSE(scaled_parameters(p).empty());
}

TEST(MeshPoints, AreReadFromEachFormatWithinTheFolders) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "gaitd_meshes";
  std::filesystem::create_directories(folder / "urdf");
  std::ofstream(folder / "a.stl")
      << "solid a\nfacet\nouter loop\n vertex 1 2 3e-1\nvertex 0 0 +1\n";
  std::ofstream(folder / "a.obj") << "# a\nv 1 2 3\nvn 0 0 1\nv 4 5 6\n";
  std::ofstream(folder / "a.dae")
      << "<COLLADA><asset><unit meter='0.01'/></asset><library_geometries><geometry id='g'><mesh>"
         "<source id='s'><float_array>100 200 300</float_array></source><vertices><input "
         "semantic='POSITION' source='#s'/></vertices></mesh></geometry></library_geometries>"
         "<library_visual_scenes><visual_scene><node><translate>0 0 100</translate>"
         "<instance_geometry url='#g'/></node></visual_scene></library_visual_scenes></COLLADA>";
  std::ofstream(folder / "bad.stl") << "nothing";
  const auto read = [&](const std::string& name) {
    std::vector<Vector3d> points;
    std::string error;
    const auto file = dynamics::find_mesh(folder / "urdf" / "r.urdf", name);
    if (!file.empty()) dynamics::read_mesh_points(file, &points, &error);
    return points;
  };
  ASSERT_EQ(read("../a.stl").size(), 2u);
  EXPECT_TRUE(read("../a.stl")[0].isApprox(Vector3d(1, 2, 0.3)));
  EXPECT_EQ(read("package://gaitd_meshes/a.obj").size(), 2u);
  ASSERT_EQ(read("package://gaitd_meshes/a.dae").size(), 1u);
  EXPECT_TRUE(read("package://anything/a.dae")[0].isApprox(Vector3d(1, 2, 4)));
  EXPECT_TRUE(read("../bad.stl").empty());
  EXPECT_TRUE(read("package://../../etc/passwd").empty());
  EXPECT_TRUE(read("http://example.com/a.stl").empty());
  // Where ROS finds packages.
  std::filesystem::create_directories(folder / "ros" / "share" / "robot_meshes");
  std::filesystem::rename(folder / "a.obj", folder / "ros" / "share" / "robot_meshes" / "b.obj");
  EXPECT_TRUE(read("package://robot_meshes/b.obj").empty());
  setenv("AMENT_PREFIX_PATH", ("/nowhere:" + (folder / "ros").string()).c_str(), 1);
  EXPECT_EQ(read("package://robot_meshes/b.obj").size(), 2u);
  EXPECT_TRUE(read("package://../share/robot_meshes/b.obj").empty());
  unsetenv("AMENT_PREFIX_PATH");
  setenv("ROS_PACKAGE_PATH", (folder / "ros" / "share").c_str(), 1);
  EXPECT_EQ(read("package://robot_meshes/b.obj").size(), 2u);
  unsetenv("ROS_PACKAGE_PATH");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace gaitd::porting

// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/robot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "daemon/config/command_parse.h"
#include "daemon/config/leg_kinematics.h"
#include "daemon/config/paths.h"
#include "daemon/config/test/temporary_folder.h"
#include "gaitd/dynamics/model_check.h"

namespace gaitd::daemon {
namespace {

std::string atlas_file() { return Paths::detect().robot("atlas").value_or("").string(); }

std::string atlas_text() {
  std::ostringstream text;
  text << std::ifstream(atlas_file()).rdbuf();
  return text.str();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// Reads a changed description of Atlas and returns the errors.
std::string errors_of_robot(const std::string& text) {
  TemporaryFolder folder;
  std::filesystem::copy_file(std::filesystem::path(atlas_file()).parent_path() / "atlas.urdf",
                             folder.path() / "atlas.urdf");
  const std::string file = folder.write("robot.yaml", text);
  Settings settings;
  Issues issues;
  const auto robot = load_robot(file, Profile::kSimulation, &settings, &issues);
  EXPECT_EQ(robot.has_value(), issues.ok());
  return issues.error_text();
}

std::string errors_with(const std::string& from, const std::string& to) {
  return errors_of_robot(replaced(atlas_text(), from, to));
}

#define EXPECT_ERROR(from, to, part)                                                \
  do {                                                                              \
    const std::string errors = errors_with(from, to);                               \
    EXPECT_NE(errors.find(part), std::string::npos) << part << "\nin:\n" << errors; \
  } while (false)

class Atlas : public testing::Test {
 protected:
  void SetUp() override {
    Issues issues;
    robot_ = load_robot(atlas_file(), Profile::kSimulation, &settings_, &issues);
    ASSERT_TRUE(robot_) << issues.error_text();
  }
  Settings settings_;
  std::optional<Robot> robot_;
};

TEST_F(Atlas, IsAWholeModel) {
  const GaitdModel& model = robot_->model;
  EXPECT_STREQ(model.name, "atlas");
  EXPECT_EQ(model.size, sizeof(GaitdModel));
  EXPECT_EQ(model.joint_count, 30);
  EXPECT_EQ(model.body_count, 31);
  EXPECT_NEAR(model.total_mass, 175.118, 1e-3);
  EXPECT_STREQ(model.bodies[model.chest_body].name, "utorso");
  EXPECT_EQ(model.imu_count, 1);
  EXPECT_EQ(model.imus[0].body, 0);
  for (const std::string& error : dynamics::check_model(model)) ADD_FAILURE() << error;
}

TEST_F(Atlas, StandsLevelSideBySideWithTheCentreOfMassAboveTheFeet) {
  const PostureFigures figures = compute_posture_figures(robot_->model);
  for (int side = 0; side < 2; ++side) {
    EXPECT_LT(figures.sole_tilt[side], 1e-9);
    EXPECT_LT(std::abs(figures.sole_yaw[side]), 1e-9);
  }
  const auto& left = figures.sole_position[GAITD_LEFT];
  const auto& right = figures.sole_position[GAITD_RIGHT];
  EXPECT_NEAR(left[0], right[0], 1e-9);
  EXPECT_NEAR(left[2], right[2], 1e-9);
  EXPECT_NEAR(figures.com[0], 0.5 * (left[0] + right[0]), 0.005);
  EXPECT_NEAR(figures.com[1], 0.5 * (left[1] + right[1]), 0.005);
  EXPECT_NEAR(robot_->model.nominal_pelvis_height, 0.9242, 1e-4);
  EXPECT_NEAR(robot_->model.nominal_com_height, 1.1772, 1e-4);
  EXPECT_NEAR(robot_->model.nominal_foot_separation, 0.2264, 1e-6);
}

TEST_F(Atlas, HasItsFeetAndLegs) {
  const GaitdModel& model = robot_->model;
  for (int side = 0; side < 2; ++side) {
    const GaitdFoot& foot = model.feet[side];
    const double mirror = side == GAITD_LEFT ? 1.0 : -1.0;
    EXPECT_EQ(foot.point_count, 4);
    EXPECT_STREQ(model.bodies[foot.body].name, side == GAITD_LEFT ? "l_foot" : "r_foot");
    // The corners of the real sole in the frame of the foot.
    double front = -1, back = 1, outer = -1, inner = 1;
    for (int i = 0; i < 4; ++i) {
      front = std::max(front, foot.sole.origin[0] + foot.points[i][0]);
      back = std::min(back, foot.sole.origin[0] + foot.points[i][0]);
      outer = std::max(outer, mirror * (foot.sole.origin[1] + foot.points[i][1]));
      inner = std::min(inner, mirror * (foot.sole.origin[1] + foot.points[i][1]));
    }
    EXPECT_NEAR(front, 0.1728, 1e-9);
    EXPECT_NEAR(back, -0.0876, 1e-9);
    EXPECT_NEAR(outer, 0.0660, 1e-9);
    EXPECT_NEAR(inner, -0.0626, 1e-9);
    EXPECT_NEAR(foot.sole.origin[2], -0.07645, 1e-12);
    EXPECT_NEAR(foot.toe_point[0], 0.1302, 1e-12);
    EXPECT_NEAR(foot.toe_point[1], 0.0, 1e-12);
    const GaitdLeg& leg = model.legs[side];
    EXPECT_EQ(leg.joint_count, 6);
    EXPECT_EQ(leg.knee_bend_sign, 1.0);
    EXPECT_EQ(leg.hip_pitch_bend_sign, -1.0);
    EXPECT_EQ(leg.ankle_pitch_bend_sign, -1.0);
  }
  EXPECT_STREQ(model.joints[model.legs[GAITD_RIGHT].knee].name, "r_leg_kny");
}

TEST_F(Atlas, KeepsItsArmsAwayFromTheirStops) {
  for (int i = 0; i < robot_->model.joint_count; ++i) {
    const GaitdJoint& joint = robot_->model.joints[i];
    if (std::string_view(joint.name).find("_arm_") == std::string_view::npos) continue;
    const double position = robot_->model.nominal_position[i];
    EXPECT_GT(position - joint.position_min, 0.2) << joint.name;
    EXPECT_GT(joint.position_max - position, 0.2) << joint.name;
  }
}

TEST_F(Atlas, GivesTheParametersOfTheProfileOverItsOwn) {
  EXPECT_EQ(settings_.peek("gait.swing_duration")->text, "0.6");
  Settings hardware;
  Issues issues;
  const auto robot = load_robot(atlas_file(), Profile::kHardware, &hardware, &issues);
  ASSERT_TRUE(robot) << issues.error_text();
  EXPECT_EQ(hardware.peek("gait.swing_duration")->text, "1.0");
  EXPECT_EQ(hardware.peek("gait.transfer_duration")->text, "0.35");
  EXPECT_EQ(hardware.peek("legs.straight_knee")->text, "0.3");
}

TEST_F(Atlas, LeavesTheDrivesToTheDefaultsInSimulation) {
  const int ankle = joint_index(robot_->model, "l_leg_aky");
  const int knee = joint_index(robot_->model, "l_leg_kny");
  EXPECT_FALSE(robot_->impedance.given);
  EXPECT_EQ(robot_->impedance.swing.stiffness[ankle], 0.0);
  EXPECT_EQ(robot_->impedance.support.damping[knee], 0.0);
  Settings settings;
  Issues issues;
  const auto robot = load_robot(atlas_file(), Profile::kHardware, &settings, &issues);
  ASSERT_TRUE(robot) << issues.error_text();
  EXPECT_TRUE(robot->impedance.given);
  EXPECT_GT(robot->impedance.swing.stiffness[ankle], 0.0);
  EXPECT_EQ(robot->impedance.swing.stiffness[knee], 0.0);
  EXPECT_GT(robot->impedance.heel_strike.damping[ankle], robot->impedance.support.damping[ankle]);
}

TEST(BendSigns, AKneeThatMayBendEitherWayBendsForwards) {
  Settings settings;
  Issues issues;
  const auto robot = load_robot(Paths::detect().robot("atlas").value_or("").string(),
                                Profile::kSimulation, &settings, &issues);
  ASSERT_TRUE(robot) << issues.error_text();
  for (const double sign : {1.0, -1.0}) {
    GaitdModel model = robot->model;
    GaitdLeg leg = model.legs[GAITD_LEFT];
    for (const int j : {leg.hip_pitch, leg.knee, leg.ankle_pitch}) model.nominal_position[j] = 0.0;
    GaitdJoint& knee = model.joints[leg.knee];
    knee.position_min = -2.3;
    knee.position_max = 2.2;
    for (double& x : knee.axis) x *= sign;
    EXPECT_EQ(compute_bend_signs(model, &leg), "");
    EXPECT_EQ(leg.knee_bend_sign, sign);
  }
}

TEST(UnitreeG1, HasItsPublishedFigures) {
  Settings settings;
  Issues issues;
  const auto robot = load_robot(Paths::detect().robot("g1").value_or("").string(),
                                Profile::kSimulation, &settings, &issues);
  ASSERT_TRUE(robot) << issues.error_text();
  EXPECT_EQ(issues.warning_text(), "");
  const GaitdModel& model = robot->model;
  EXPECT_EQ(model.joint_count, 29);
  EXPECT_EQ(model.body_count, 30);
  EXPECT_NEAR(model.total_mass, 33.341142, 1e-6);
  EXPECT_STREQ(model.bodies[model.chest_body].name, "torso_link");
  for (const std::string& error : dynamics::check_model(model)) ADD_FAILURE() << error;

  const PostureFigures figures = compute_posture_figures(model);
  const auto& left = figures.sole_position[GAITD_LEFT];
  EXPECT_NEAR(figures.com[0], left[0], 0.001);
  EXPECT_NEAR(figures.com[1], 0.0, 0.001);
  EXPECT_NEAR(model.nominal_foot_separation, 0.129, 0.001);
  for (const GaitdLeg& leg : model.legs) {
    EXPECT_EQ(leg.joint_count, 6);
    EXPECT_EQ(leg.knee_bend_sign, 1.0);
    EXPECT_EQ(model.joints[leg.knee].position_max, 2.8798);
  }
  ASSERT_EQ(model.imu_count, 2);
  EXPECT_STREQ(model.bodies[model.imus[0].body].name, "pelvis");
  EXPECT_STREQ(model.bodies[model.imus[1].body].name, "torso_link");

  // The drives: what was tested, where the URDF allows more.
  const GaitdJoint& knee = model.joints[joint_index(model, "left_knee_joint")];
  EXPECT_EQ(knee.effort_limit, 111.0);
  EXPECT_EQ(knee.velocity_limit, 14.5);
  EXPECT_EQ(knee.rotor_inertia, 0.025101925);
  const GaitdJoint& ankle = model.joints[joint_index(model, "right_ankle_pitch_joint")];
  EXPECT_EQ(ankle.effort_limit, 35.0);
  EXPECT_EQ(ankle.rotor_inertia, 0.00721945);
  for (int i = 0; i < model.joint_count; ++i) {
    EXPECT_GT(model.joints[i].rotor_inertia, 0.0) << model.joints[i].name;
  }
}

// Of the maker's description with all its links, by a computation of its own: straight legs, and
// the posture of the maker's examples.
TEST(UnitreeG1, StandsAsTheUnmergedRobotDoes) {
  Settings settings;
  Issues issues;
  auto robot = load_robot(Paths::detect().robot("g1").value_or("").string(), Profile::kSimulation,
                          &settings, &issues);
  ASSERT_TRUE(robot) << issues.error_text();
  GaitdModel& model = robot->model;
  std::fill(std::begin(model.nominal_position), std::end(model.nominal_position), 0.0);
  PostureFigures figures = compute_posture_figures(model);
  EXPECT_NEAR(figures.pelvis_height(), 0.791864, 1e-6);
  EXPECT_NEAR(figures.com_height(), 0.7032, 1e-4);
  EXPECT_NEAR(figures.com[0] - figures.sole_position[GAITD_LEFT][0], 0.0203 - 0.035, 1e-4);

  for (const char* side : {"left_", "right_"}) {
    const double mirror = side[0] == 'l' ? 1.0 : -1.0;
    const std::pair<const char*, double> joints[] = {
        {"hip_pitch", -0.1},          {"knee", 0.3},   {"ankle_pitch", -0.2},
        {"shoulder_pitch", 0.3},      {"elbow", 0.97}, {"shoulder_roll", mirror * 0.25},
        {"wrist_roll", mirror * 0.15}};
    for (const auto& [name, position] : joints) {
      model.nominal_position[joint_index(model, std::string(side) + name + "_joint")] = position;
    }
  }
  figures = compute_posture_figures(model);
  EXPECT_NEAR(figures.pelvis_height(), 0.784202, 1e-6);
  EXPECT_NEAR(figures.com_height(), 0.6888, 1e-4);
  EXPECT_NEAR(figures.foot_separation(), 0.237013, 1e-6);
  EXPECT_NEAR(figures.com[0] - figures.sole_position[GAITD_LEFT][0], 0.0332 - 0.035, 1e-4);
  for (const double tilt : figures.sole_tilt) EXPECT_LT(tilt, 1e-9);
}

TEST(Robot, TakesLimitsOfDrivesBelowThoseOfTheUrdf) {
  const std::string inertia = "rotor_inertia: {\"*\": 0.0}";
  EXPECT_EQ(errors_with(inertia, inertia + "\ndrive_limits: {\"?_leg_kny\": {effort: 300}}"), "");
  EXPECT_ERROR(inertia, inertia + "\ndrive_limits: {l_leg_kny: {effort: 891, velocity: 5}}",
               "drive_limits.l_leg_kny.effort: expected at most that of the URDF for l_leg_kny, "
               "890, got 891");
  EXPECT_ERROR(inertia, inertia + "\ndrive_limits: {l_knee: {effort: 5}}",
               "drive_limits.l_knee: expected a joint of the URDF or a glob");
  EXPECT_EQ(errors_with(inertia, inertia + "\ndrive_limits: {l_leg_kny: {range: [0.1, 2]}}"), "");
  EXPECT_ERROR(
      inertia, inertia + "\ndrive_limits: {l_leg_kny: {range: [2, 1]}}",
      "drive_limits.l_leg_kny.range: expected the lower end before the upper one, got 2 and "
      "1");
  EXPECT_ERROR(inertia, inertia + "\ndrive_limits: {l_leg_kny: {range: [3, 4]}}",
               "drive_limits.l_leg_kny.range: expected one within that of the URDF for l_leg_kny");
  EXPECT_ERROR(inertia, inertia + "\ndrive_limits: {l_leg_kny: {range: [0.6, 2]}}",
               "posture.l_leg_kny");
}

TEST(Robot, NamesTheUnknownLinkAndJoint) {
  EXPECT_ERROR("{name: pelvis_imu, link: pelvis", "{name: pelvis_imu, link: pelviss",
               "imus[0].link: expected a link of the URDF, got pelviss; did you mean 'pelvis'?");
  EXPECT_ERROR("knee: l_leg_kny", "knee: l_leg_knee",
               "legs.left.knee: expected a joint of the URDF that moves, got 'l_leg_knee' (text); "
               "did you mean 'l_leg_kny'?");
  EXPECT_ERROR("knee: l_leg_kny", "knee: r_leg_kny",
               "legs.left.knee: expected one of the joints of this leg, got r_leg_kny");
  EXPECT_ERROR("chest: utorso", "chest: chest", "chest: expected a link of the URDF, got chest");
}

TEST(Robot, WantsTheWholeChainFromPelvisToFoot) {
  EXPECT_ERROR("joints: [l_leg_hpz, l_leg_hpx,", "joints: [l_leg_hpx, l_leg_hpz,",
               "legs.left.joints: expected a joint that starts at pelvis");
  EXPECT_ERROR(", l_leg_kny, l_leg_aky, l_leg_akx]", ", l_leg_aky]",
               "legs.left.joints: expected a list of 5");
}

TEST(Robot, GivesTheFiguresOfAPostureThatDoesNotStand) {
  EXPECT_ERROR("l_leg_aky: -0.2760", "l_leg_aky: -0.1760",
               "posture: expected level soles that point forward (within 0.002 rad), got the left "
               "one tilted by 0.1000 rad");

  EXPECT_ERROR("l_arm_elx: 0.5", "l_arm_elx: -0.5",
               "posture.l_arm_elx: expected a position in 0..2.35619 rad, got -0.5");
  std::string leaning = atlas_text();
  for (const char* side : {"l_leg_", "r_leg_"}) {
    leaning = replaced(leaning, std::string(side) + "hpy: -0.2240", std::string(side) + "hpy: 0.1");
    leaning =
        replaced(leaning, std::string(side) + "aky: -0.2760", std::string(side) + "aky: -0.6");
  }
  const std::string errors = errors_of_robot(leaning);
  EXPECT_NE(errors.find("posture: expected a centre of mass above the feet, got 0."),
            std::string::npos)
      << errors;
}

TEST(Robot, ChecksTheOutlineOfTheSole) {
  EXPECT_ERROR(
      "outline: [[0.1302, -0.0643], [0.1302, 0.0643], [-0.1302, 0.0643], "
      "[-0.1302, -0.0643]]",
      "outline: [[0.1302, -0.0643], [-0.1302, -0.0643], [-0.1302, 0.0643], "
      "[0.1302, 0.0643]]",
      "feet.left.outline: expected a convex outline, counter-clockwise from above, got "
      "points in clockwise order");
}

TEST(Robot, TellsOneCauseOnce) {
  const auto lines = [](const std::string& errors) {
    return std::count(errors.begin(), errors.end(), '\n') + (errors.empty() ? 0 : 1);
  };
  // Of the joints of the leg, of its knee and of the posture; of the foot and the chain to it; a
  // foot that is tilted stands elsewhere too.
  const std::string knee = errors_with("joints: [l_leg_hpz, l_leg_hpx, l_leg_hpy, l_leg_kny,",
                                       "joints: [l_leg_hpz, l_leg_hpx, l_leg_hpy, l_knee,");
  EXPECT_EQ(lines(knee), 2) << knee;  // and that l_leg_kny is not among them
  const std::string foot = errors_with("link: l_foot", "link: left_foot");
  EXPECT_EQ(lines(foot), 1) << foot;
  const std::string bent = errors_with("l_leg_kny: 0.5", "l_leg_kny: 0.4");
  EXPECT_EQ(lines(bent), 1) << bent;
  const std::string pelvis = errors_with("pelvis: pelvis", "pelvis: hips");
  EXPECT_EQ(lines(pelvis), 1) << pelvis;
}

TEST(Robot, FixesJointsAndTurnsThePelvis) {
  std::string text =
      replaced(atlas_text(), "pelvis: pelvis", "pelvis: {link: pelvis, rpy: [0, 0, 0]}");
  text = replaced(text, "chest: utorso", "chest: utorso\nfixed: [\"?_arm_*w*\"]");
  for (const char* side : {"l", "r"}) {
    for (const char* joint : {"uwy", "mwx", "lwy"}) {
      text = replaced(text, std::string("  ") + side + "_arm_" + joint + ": 0.0\n", "");
    }
  }
  EXPECT_EQ(errors_of_robot(text), "");
  EXPECT_ERROR("chest: utorso", "chest: utorso\nfixed: [l_thumb]",
               "fixed: expected a joint of the URDF or a glob (*_finger_*), got l_thumb");
  EXPECT_EQ(errors_of_robot(replaced(text, "rpy: [0, 0, 0]}", "xyz: [0, 0, 0.1]}")), "");
  // The soles follow the frame of the pelvis.
  EXPECT_ERROR("pelvis: pelvis", "pelvis: {link: pelvis, rpy: [0, 0, 1.5708]}",
               "level soles that point forward");
}

TEST(Robot, ReducesAnOutlineOfManyPoints) {
  std::string circle = "outline: [";
  for (int i = 0; i < 40; ++i) {
    const double angle = 2 * M_PI * i / 40;
    circle += "[" + std::to_string(0.1 * std::cos(angle)) + ", " +
              std::to_string(0.06 * std::sin(angle)) + "], ";
  }
  circle.resize(circle.size() - 2);
  TemporaryFolder folder;
  std::filesystem::copy_file(std::filesystem::path(atlas_file()).parent_path() / "atlas.urdf",
                             folder.path() / "atlas.urdf");
  const std::string file = folder.write(
      "robot.yaml", replaced(atlas_text(),
                             "outline: [[0.1302, -0.0643], [0.1302, 0.0643], [-0.1302, 0.0643], "
                             "[-0.1302, -0.0643]]",
                             circle + "]"));
  Settings settings;
  Issues issues;
  const auto robot = load_robot(file, Profile::kSimulation, &settings, &issues);
  ASSERT_TRUE(robot.has_value()) << issues.error_text();
  EXPECT_NE(issues.warning_text().find("40 points"), std::string::npos) << issues.warning_text();
  const GaitdFoot& foot = robot->model.feet[GAITD_LEFT];
  ASSERT_EQ(foot.point_count, GAITD_MAX_FOOT_POINTS);
  double area = 0.0;
  for (int i = 0; i < foot.point_count; ++i) {
    const double* a = foot.points[i];
    const double* b = foot.points[(i + 1) % foot.point_count];
    area += 0.5 * (a[0] * b[1] - b[0] * a[1]);
  }
  EXPECT_GT(area, 0.88 * M_PI * 0.1 * 0.06);
}

TEST(Robot, ReportsErrorsOfAllSectionsTogether) {
  const std::string errors =
      errors_with("chest: utorso\n", "chest: nothing\ncolour: blue\n") +
      errors_with("profiles:", "parameters:\n  omega: 3.0\n  gait.x: [1]\nprofiles:") +
      errors_with("urdf: atlas.urdf", "urdf: other.urdf") +
      errors_with("schema: gaitd.robot/1", "schema: gaitd.robot/9") +
      errors_with("rotor_inertia: {\"*\": 0.0}", "rotor_inertia: {\"left_*\": 0.0, \"*\": -1}");
  for (const char* part : {"chest: expected a link", "colour: unknown key",
                           "parameters.omega: expected scope.name or layer/variant.name, got omega",
                           "parameters.gait.x: expected a value, got a list of 1", "urdf: ",
                           "other.urdf", "schema: expected gaitd.robot/1, got gaitd.robot/9",
                           "rotor_inertia.left_*: expected a joint of the URDF or a glob",
                           "rotor_inertia.*: expected a number in 0..100 kg m^2, got -1"}) {
    EXPECT_NE(errors.find(part), std::string::npos) << part << "\nin:\n" << errors;
  }
}

}  // namespace
}  // namespace gaitd::daemon

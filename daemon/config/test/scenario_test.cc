// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/scenario.h"

#include <gtest/gtest.h>

#include <memory>

#include "daemon/config/command_parse.h"
#include "daemon/config/paths.h"
#include "daemon/config/robot.h"

namespace gaitd::daemon {
namespace {

const std::string kHead = "schema: gaitd.scenario/1\nname: test\nrobot: atlas\nduration: 10\n";

std::optional<Scenario> read_text(const std::string& text, Issues* issues, Settings* settings) {
  const NodePtr root = parse_yaml(text, "test.yaml", issues);
  if (!root) return std::nullopt;
  return read_scenario(root, "test.yaml", settings, issues);
}

std::string errors_of_scenario(const std::string& text) {
  Issues issues;
  Settings settings;
  const auto scenario = read_text(text, &issues, &settings);
  EXPECT_EQ(scenario.has_value(), issues.ok());
  return issues.error_text();
}

#define EXPECT_PART(text, part) \
  EXPECT_NE((text).find(part), std::string::npos) << part << "\nin:\n" << (text)

TEST(Scenario, ANameLeadsToNoOtherFolder) {
  const auto errors_of_name = [](const std::string& name) {
    return errors_of_scenario("schema: gaitd.scenario/1\nname: '" + name +
                              "'\nrobot: atlas\nduration: 10\n" + "terrain: {ground_z: 0}\n");
  };
  for (const char* name :
       {"../x", "/tmp/x", "a/b", ".hidden", "..", "a b", "a\\b", "caf\xC3\xA9"}) {
    EXPECT_PART(errors_of_name(name), "test.yaml:2: name: expected a name for files");
    EXPECT_PART(errors_of_name(name), "got '" + std::string(name));
  }
  EXPECT_PART(errors_of_name(std::string(101, 'a')), "at most 100");
  for (const char* name : {"flat-0.35", "Push_3", "a..b", "7"}) EXPECT_EQ(errors_of_name(name), "");
}

TEST(Scenario, ALogHoldsWhatIsExpected) {
  Issues issues;
  Settings settings;
  const auto scenario = read_text(kHead +
                                      "terrain: {ground_z: 0}\n"
                                      "expect: {no_fall: true, icp_error_rms_max: 0.02, checks: "
                                      "[{signal: com/z, stat: p99, during: always, max: 1.5}]}\n",
                                  &issues, &settings);
  ASSERT_TRUE(scenario) << issues.error_text();
  const auto logged = read_logged_expectations(scenario->expect_section.dump());
  ASSERT_TRUE(logged);
  EXPECT_EQ(logged->no_fall, true);
  EXPECT_EQ(logged->icp_error_rms_max, 0.02);
  ASSERT_EQ(logged->checks.size(), 1u);
  EXPECT_EQ(logged->checks[0].statistic, Statistic::kP99);
  EXPECT_EQ(logged->checks[0].max, 1.5);
  EXPECT_TRUE(read_logged_expectations("{}"));
  for (const char* text : {"", "null", "[]", "{\"no_such\": 1}", "{\"no_fall\": 3}"}) {
    EXPECT_FALSE(read_logged_expectations(text)) << text;
  }
}

TEST(Scenario, BoundsOfRealDrivesAreWider) {
  const std::string text = kHead +
                           "terrain: {ground_z: 0}\n"
                           "mode: walk-bent\n"
                           "commands: [{at: 1, walk: {steps: 4, length: 0.2}}]\n"
                           "expect: {no_fall: true, icp_error_rms_max: 0.02, stance_knee_mean_max: "
                           "0.3, final_pelvis: {x: 0, y: 0, tolerance: 0.2}}\n";
  Issues issues;
  Settings settings;
  settings.set(SettingSource::kCommandLine, "expect.bounds", make_scalar("real_drives", {}));
  const auto scenario = read_text(text, &issues, &settings);
  ASSERT_TRUE(scenario) << issues.error_text();
  EXPECT_DOUBLE_EQ(scenario->expect.icp_error_rms_max.value(), 0.04);
  EXPECT_DOUBLE_EQ(scenario->expect.stance_knee_mean_max.value(), 0.36);
  EXPECT_DOUBLE_EQ(scenario->expect.final_pelvis.value().tolerance, 0.3);
  const auto logged = read_logged_expectations(scenario->expect_section.dump());
  ASSERT_TRUE(logged);
  EXPECT_DOUBLE_EQ(logged->icp_error_rms_max.value(), 0.04);
}

TEST(Scenario, ReadsEverySection) {
  Issues issues;
  Settings settings;
  const auto scenario = read_text(
      kHead +
          "seed: 7\n"
          "start: {x: 1, y: 2, yaw: 0.5}\n"
          "mode: walk-straight\n"
          "set: {step_adjuster.variant: step_plan, gait: {swing_duration: 0.7}}\n"
          "terrain:\n"
          "  friction: 0.6\n"
          "  ground_z: 0.1\n"
          "  boxes: [{center: [1.5, 0, 0.1], size: [0.3, 2, 0.2]}]\n"
          "sensors: {noise: {gyro_noise: 0.01}}\n"
          "actuators: {model: nominal}\n"
          "model_error: {mass_scale: {utorso: 1.1}, com_offset: {utorso: [0, 0.01, 0]}}\n"
          "commands:\n"
          "  - {at: 4.0, pause: true}\n"
          "  - {at: 1.0, walk: {steps: 12, length: 0.35, first: right}}\n"
          "  - {at: 2.0, footsteps: [{side: left, x: 0.3, y: 0.12}]}\n"
          "  - {at: 3.0, swap: {layer: whole_body_controller, to: com_height_qp}}\n"
          "  - {at: 3.5, param: {gait.swing_duration: 0.8, gait.swing_height: 0.1}}\n"
          "  - {at: 5.0, mode: walk-bent}\n"
          "  - {at: 6.0, push: {link: utorso, force: [1, 2, 3], duration: 0.1}}\n"
          "disturbances:\n"
          "  - {link: utorso, point: [0, 0, 0.3], force: [444, 0, 0], duration: 0.1,\n"
          "     when: {step: 3, phase: swing, fraction: 0.5}}\n"
          "  - {link: pelvis, force: [0, 1, 0], duration: 0.2, when: {time: 2.5}}\n"
          "expect:\n"
          "  no_fall: true\n"
          "  steps_taken: 12\n"
          "  final_pelvis: {x: 4.2, y: 0, tolerance: 0.2, yaw: 0.1, yaw_tolerance: 0.05}\n"
          "  final_yaw: {yaw: 0.1, tolerance: 0.05}\n"
          "  stance_knee_mean_max: 0.35\n"
          "  toe_off_steps_min: 10\n"
          "  icp_error_rms_max: 0.03\n"
          "  foot_slip_max: 0.01\n"
          "  torque_saturation_max: 0.02\n"
          "  torque_chatter_max: 0.01\n"
          "  contact_lost: false\n"
          "  pelvis_drift_max: {start: 1, max: 0.005}\n"
          "  checks: [{signal: 'truth/foot/*/side_force', stat: max, during: swing, max: 50}]\n",
      &issues, &settings);
  ASSERT_TRUE(scenario) << issues.error_text();
  EXPECT_EQ(issues.warning_text(), "");
  EXPECT_EQ(scenario->seed, 7u);
  EXPECT_EQ(scenario->mode, GAITD_MODE_WALK_STRAIGHT);
  EXPECT_EQ(settings.peek("gait.swing_duration")->text, "0.7");
  EXPECT_EQ(settings.peek("robot")->text, "atlas");

  const nlohmann::json world = scenario->simulator_config();
  EXPECT_EQ(world["start"], (nlohmann::json{{"x", 1.0}, {"y", 2.0}, {"z", 0.1}, {"yaw", 0.5}}));
  EXPECT_EQ(world["terrain"]["boxes"][0]["friction"], 0.6);
  EXPECT_EQ(world["terrain"]["boxes"][0]["size"][1], 2.0);
  EXPECT_EQ(world["sensors"]["noise"]["gyro_noise"], 0.01);
  EXPECT_EQ(world["actuators"]["model"], "nominal");
  EXPECT_EQ(world["model_error"]["mass_scale"]["utorso"], 1.1);

  ASSERT_EQ(scenario->commands.size(), 8u);
  EXPECT_EQ(scenario->commands[0].method, "walk");
  EXPECT_EQ(scenario->commands[0].where.line, 18);
  EXPECT_EQ(scenario->commands[1].method, "footsteps");
  EXPECT_EQ(scenario->commands[2].method, "plugin.swap");
  EXPECT_EQ(scenario->commands[2].params["variant"], "com_height_qp");
  EXPECT_EQ(scenario->commands[3].method, "param.set");
  EXPECT_EQ(scenario->commands[4].params["value"], 0.1);
  EXPECT_EQ(scenario->commands[7].method, "sim.push");

  ASSERT_EQ(scenario->disturbances.size(), 2u);
  EXPECT_TRUE(scenario->disturbances[0].at_step);
  EXPECT_EQ(scenario->disturbances[0].step, 3);
  EXPECT_EQ(scenario->disturbances[0].fraction, 0.5);
  EXPECT_FALSE(scenario->disturbances[1].at_step);
  EXPECT_EQ(scenario->disturbances[1].time, 2.5);

  const Expectations& expect = scenario->expect;
  EXPECT_EQ(expect.no_fall, true);
  EXPECT_EQ(expect.steps_taken, 12);
  EXPECT_EQ(expect.final_pelvis->yaw_tolerance, 0.05);
  EXPECT_EQ(expect.final_yaw->tolerance, 0.05);
  EXPECT_EQ(expect.contact_lost, false);
  EXPECT_EQ(expect.pelvis_drift_max->start, 1.0);
  ASSERT_EQ(expect.checks.size(), 1u);
  EXPECT_EQ(expect.checks[0].statistic, Statistic::kMax);
  EXPECT_EQ(expect.checks[0].during, During::kSwing);
  EXPECT_EQ(expect.checks[0].max, 50.0);
}

TEST(Scenario, CommandsCanBeParsedAgainFromWhatTheScenarioHolds) {
  Issues issues;
  Settings settings;
  const auto scenario = read_text(kHead +
                                      "commands:\n"
                                      "  - {at: 1, mode: walk-bent}\n"
                                      "  - {at: 1, walk: {steps: 2, first: left}}\n"
                                      "  - {at: 1, replace: [{side: left, x: 0.3, y: 0.12}]}\n"
                                      "  - {at: 2, stop: true}\n",
                                  &issues, &settings);
  ASSERT_TRUE(scenario) << issues.error_text();
  const auto model = std::make_unique<GaitdModel>();
  for (const ScenarioCommand& command : scenario->commands) {
    std::string error;
    EXPECT_TRUE(parse_command(command.method, command.params, *model, &error)) << error;
  }
}

TEST(Scenario, HasFlatGroundAndNoDisturbancesByDefault) {
  Issues issues;
  Settings settings;
  const auto scenario = read_text(kHead, &issues, &settings);
  ASSERT_TRUE(scenario) << issues.error_text();
  EXPECT_EQ(scenario->terrain["ground_z"], 0.0);
  EXPECT_EQ(scenario->sensors["noise"], "none");
  EXPECT_EQ(scenario->actuators["model"], "ideal");
  EXPECT_EQ(scenario->seed, 1u);
}

TEST(Scenario, ReportsEveryErrorAtOnce) {
  const std::string errors = errors_of_scenario(
      "schema: gaitd.scenario/2\nname: test\nrobot: atlas\nduration: -3\nmood: bent\n"
      "terrain: {friction: -1, boxes: [{center: [0, 0, 0], size: [0, 1, 1]}]}\n"
      "sensors: {noise: loud}\nactuators: {model: {bandwith: 60}}\n"
      "commands: [{at: -1, walk: {steps: 0}}, {walk: {steps: 1}, stop: true}, {at: 1}]\n"
      "disturbances: [{link: utorso, force: [1, 2], duration: 0.1, when: {}}]\n"
      "expect: {no_fal: true, checks: [{signal: x, stat: median}]}\n");
  for (const char* part :
       {"test.yaml:1: schema: expected gaitd.scenario/1, got gaitd.scenario/2",
        "test.yaml:4: duration: expected a number in 0.001..86400 s, got -3",
        "test.yaml:5: mood: unknown key; did you mean 'mode'?",
        "test.yaml:6: terrain.friction: expected a number in 0..10, got -1",
        "test.yaml:6: terrain.boxes[0].size[0]: expected a number in 0.001..10000 m, got 0",
        "start.z: expected the height of the soles, as there is no terrain.ground_z",
        "test.yaml:7: sensors.noise: expected one of none, nominal, lab, rough, got 'loud'",
        "test.yaml:8: actuators.model.bandwith: unknown key; did you mean 'bandwidth'?",
        "test.yaml:9: commands[0].at: expected a number in 0..86400 s, got -1",
        "test.yaml:9: commands[0].walk.steps: expected a whole number in 1..1000, got 0",
        "test.yaml:9: commands[1].at: expected a value, got nothing",
        "test.yaml:9: commands[1]: expected one command beside 'at', got 2",
        "test.yaml:9: commands[2]: expected one command beside 'at', got 0",
        "test.yaml:10: disturbances[0].force: expected a list of 3 numbers, got a list of 2",
        "test.yaml:10: disturbances[0].when: expected either time or step, got neither",
        "test.yaml:11: expect.no_fal: unknown key; did you mean 'no_fall'?",
        "test.yaml:11: expect.checks[0].stat: expected one of rms, mean, min, max, p99, range",
        "test.yaml:11: expect.checks[0]: expected min or max, got neither"}) {
    EXPECT_PART(errors, part);
  }
}

TEST(Scenario, ATerrainOfOtherFiguresOnlyIsFlatGround) {
  for (const char* figures : {"friction: 0.5", "stiffness: 1.0e+6"}) {
    Issues issues;
    Settings settings;
    const auto scenario = read_text(kHead + "terrain: {" + figures + "}\n", &issues, &settings);
    ASSERT_TRUE(scenario) << issues.error_text();
    EXPECT_EQ(scenario->terrain["ground_z"], 0.0);
  }
  EXPECT_PART(errors_of_scenario(kHead + "terrain: {stiffness: 1000}\n"), "terrain.stiffness");
}

TEST(Scenario, RefusesContradictions) {
  EXPECT_PART(errors_of_scenario(kHead + "commands: [{at: 11, stop: true}]\n"),
              "commands[0].at: expected a time before the end of the scenario, got 11");
  EXPECT_PART(
      errors_of_scenario(kHead + "disturbances: [{link: a, force: [1, 0, 0], duration: 1, when: "
                                 "{time: 12}}]\n"),
      "when.time: expected a time before the end");
  EXPECT_PART(errors_of_scenario(kHead + "commands: [{at: 1, pause: false}]\n"),
              "expected true, got false");
  EXPECT_PART(errors_of_scenario(kHead + "commands: [{at: 1, swap: {layer: toe_of, to: x}}]\n"),
              "did you mean 'toe_off'?");
  EXPECT_PART(errors_of_scenario(kHead + "expect: {final_pelvis: {x: 1, y: 1, tolerance: 1, "
                                         "yaw_tolerance: 1}}\n"),
              "expected a yaw beside it");
  EXPECT_PART(errors_of_scenario(kHead + "commands: [{at: 1, wlak: {steps: 1}}]\n"),
              "commands[0].wlak: unknown key; did you mean 'walk'?");
}

const std::string kWalking = kHead + "mode: walk-bent\n";

TEST(Scenario, RefusesADisturbanceInAStepThatIsNeverCommanded) {
  const std::string walk = kWalking + "commands: [{at: 1, walk: {steps: 2}}]\n";
  const std::string push = "disturbances: [{link: a, force: [1, 0, 0], duration: 1, when: {step: ";
  EXPECT_EQ(errors_of_scenario(walk + push + "3}}]\n"), "");
  EXPECT_PART(errors_of_scenario(walk + push + "4}}]\n"),
              "test.yaml:7: disturbances[0].when.step: expected at most the last step that is "
              "commanded, 3, got 4");
}

TEST(Scenario, RefusesExpectationsThatNothingCanFulfil) {
  EXPECT_PART(
      errors_of_scenario(kHead + "expect: {steps_taken: 2}\n"),
      "test.yaml:5: expect.steps_taken: expected at most the steps that are commanded, 0 by "
      "the commands, got 2; add a walk to 'commands'");
  EXPECT_EQ(errors_of_scenario(kHead + "expect: {steps_taken: 0}\n"), "");
  const std::string walk = kWalking + "commands: [{at: 1, walk: {steps: 2}}]\n";
  EXPECT_EQ(errors_of_scenario(walk + "expect: {steps_taken: 2, toe_off_steps_min: 2}\n"), "");
  EXPECT_PART(errors_of_scenario(walk + "expect: {steps_taken: 3, toe_off_steps_min: 4}\n"),
              "expect.toe_off_steps_min: expected at most the steps that are commanded, 2");
  EXPECT_PART(errors_of_scenario(kHead + "expect: {stance_knee_mean_max: 0.3}\n"),
              "expected a walk, as it is taken over single support");
  EXPECT_PART(errors_of_scenario(
                  kHead + "expect: {checks: [{signal: a, stat: max, during: swing, max: 1}]}\n"),
              "expect.checks: expected a walk, as 'a' is checked while walking, got none");
  EXPECT_PART(errors_of_scenario(kHead + "expect: {pelvis_drift_max: {start: 10, max: 1}}\n"),
              "expected a start before the end of the scenario, got 10 s");
}

TEST(Scenario, RefusesWalkingInModeStand) {
  const std::string walk = "commands: [{at: 1, walk: {steps: 2}}]\n";
  EXPECT_PART(errors_of_scenario(kHead + walk),
              "test.yaml:5: commands: walk at 1 s will be refused: the gait mode is stand; write "
              "mode: walk-bent");
  EXPECT_PART(
      errors_of_scenario(kWalking + "commands: [{at: 1, mode: stand}, {at: 2, footsteps: [{side: "
                                    "left, x: 0, y: 0.1}]}]\n"),
      "footsteps at 2 s will be refused: the gait mode is stand");
  EXPECT_EQ(errors_of_scenario(kHead +
                               "commands: [{at: 2, walk: {steps: 2}}, {at: 1, mode: walk-bent}]\n"),
            "");
}

TEST(Scenario, RefusesWalkingWhileNotArmed) {
  const auto with = [](const std::string& before) {
    return errors_of_scenario(kWalking + "commands:\n" + before +
                              "  - {at: 4, walk: {steps: 2}}\n");
  };
  EXPECT_PART(with("  - {at: 1, disarm: true}\n"),
              "test.yaml:8: commands: walk at 4 s will be refused: the robot is not armed since "
              "'disarm' at 1 s; add arm before it");
  EXPECT_PART(with("  - {at: 1, estop: true}\n"), "add reset and arm before it");
  EXPECT_PART(with("  - {at: 1, estop: true}\n  - {at: 1.1, reset: true}\n"),
              "not armed since 'reset'");
  EXPECT_PART(with("  - {at: 1, estop: true}\n  - {at: 1.1, arm: true}\n"),
              "arm at 1.1 s will be refused: a fault is latched by 'estop'; add a reset");
  EXPECT_EQ(with("  - {at: 1, estop: true}\n  - {at: 1.1, reset: true}\n  - {at: 2, arm: true}\n"),
            "");
  EXPECT_EQ(with("  - {at: 1, disarm: true}\n  - {at: 2, arm: true}\n"), "");
  EXPECT_EQ(with("  - {at: 1, estop: true}\n  - {at: 2, sim.reset: true}\n"), "");
}

TEST(Scenario, RefusesFeetThatDoNotAlternate) {
  const auto of = [](const std::string& commands) {
    return errors_of_scenario(kWalking + "commands:\n" + commands);
  };
  // Right, left and the closing right: the second walk cannot begin right.
  const std::string walk = "  - {at: 1, walk: {steps: 2, first: right}}\n";
  EXPECT_PART(of(walk + "  - {at: 1, walk: {steps: 2, first: right}}\n"),
              "test.yaml:8: commands: walk at 1 s will be refused: it begins right, as the "
              "footsteps ahead of line 7 end");
  EXPECT_EQ(of(walk + "  - {at: 1, walk: {steps: 2, first: left}}\n"), "");
  EXPECT_EQ(of(walk + "  - {at: 6, walk: {steps: 2, first: right}}\n"), "");
  EXPECT_EQ(
      of(walk + "  - {at: 1.1, abort: true}\n  - {at: 1.2, walk: {steps: 2, first: right}}\n"), "");
  EXPECT_PART(
      of("  - {at: 1, footsteps: [{side: left, x: 0, y: 0.1}, {side: right, x: 0, y: -0.1}, "
         "{side: right, x: 0.1, y: -0.1}]}\n"),
      "footsteps 2 and 3 are both right; let the sides alternate");
}

TEST(Scenario, RefusesReversedOutlinesAndRegionsBesideTheFoothold) {
  const auto of = [](const std::string& more) {
    return errors_of_scenario(kWalking +
                              "commands: [{at: 1, footsteps: [{side: left, x: 0.3, y: 0.1, " +
                              more + "}]}]\n");
  };
  EXPECT_PART(of("contact_polygon: [[0.1, 0.05], [0.1, -0.05], [0, -0.05], [0, 0.05]]"),
              "commands[0].footsteps.footsteps[0].contact_polygon: expected a convex outline, "
              "counter-clockwise from above, got points in clockwise order; reverse the list");
  EXPECT_PART(of("landing_region: [[0, 0, 0], [1, 1, 0], [1, 0, 0]]"), "clockwise order");
  EXPECT_PART(of("landing_region: [[1, 0, 0], [2, 0, 0], [2, 1, 0]]"),
              "expected a region around the foothold itself, got one beside it");
  EXPECT_EQ(of("landing_region: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]"), "");
}

TEST(Scenario, TheCommandLineReplacesKeysOfTheScenario) {
  Issues issues;
  Settings settings;
  for (const char* assignment :
       {"seed=5", "duration=3", "sensors.noise=nominal", "actuators.model={bandwidth: 30}",
        "terrain.friction=0.4", "model_error.mass_scale.utorso=1.05", "start.x=2",
        "mode=walk-straight", "gait.swing_duration=0.7"}) {
    ASSERT_TRUE(settings.set_assignment(assignment, &issues)) << issues.error_text();
  }
  const auto scenario =
      read_text(kHead + "terrain: {ground_z: 0, friction: 0.8}\nsensors: {noise: none}\n", &issues,
                &settings);
  ASSERT_TRUE(scenario) << issues.error_text();
  EXPECT_EQ(scenario->seed, 5u);
  EXPECT_EQ(scenario->duration, 3.0);
  EXPECT_EQ(scenario->sensors["noise"], "nominal");
  EXPECT_EQ(scenario->actuators["model"]["bandwidth"], 30.0);
  EXPECT_EQ(scenario->terrain["friction"], 0.4);
  EXPECT_EQ(scenario->model_error["mass_scale"]["utorso"], 1.05);
  EXPECT_EQ(scenario->start.position[0], 2.0);
  EXPECT_EQ(scenario->mode, GAITD_MODE_WALK_STRAIGHT);
  // Only what is no key of the scenario is left to be known by others.
  settings.find("robot");
  settings.report_unknown(&issues);
  EXPECT_EQ(issues.error_count(), 1u) << issues.error_text();
  EXPECT_PART(issues.error_text(), "gait.swing_duration: unknown key");
}

TEST(Scenario, SensorsAreAClassOrFiguresOrBoth) {
  const auto noise_of = [](const std::string& noise) {
    Issues issues;
    Settings settings;
    const auto scenario = read_text(
        kHead + "terrain: {ground_z: 0}\nsensors: {noise: " + noise + "}\n", &issues, &settings);
    return scenario ? scenario->sensors["noise"].dump() : issues.error_text();
  };
  EXPECT_EQ(noise_of("rough"), R"("rough")");
  EXPECT_EQ(noise_of("{class: lab, stamp: arrival, joint_zero: [-0.02, 0.02], delay: 0.002}"),
            R"({"class":"lab","delay":0.002,"joint_zero":[-0.02,0.02],"stamp":"arrival"})");
  EXPECT_PART(noise_of("{class: loud}"), "sensors.noise.class: expected one of none, nominal, lab");
  EXPECT_PART(noise_of("{stamp: never}"), "sensors.noise.stamp: expected one of measurement");
  EXPECT_PART(noise_of("{gyro_nois: 1}"), "sensors.noise.gyro_nois: unknown key; did you mean");
  EXPECT_PART(noise_of("{delay: [0.002, 0.001]}"), "sensors.noise.delay: expected the lower limit");
  EXPECT_PART(noise_of("{delay: [0.002]}"), "sensors.noise.delay: expected a list of 2 numbers");
  EXPECT_PART(noise_of("{delay: [0, 2]}"), "sensors.noise.delay[1]: expected a number in 0..0.1 s");
  EXPECT_PART(noise_of("{encoder_bits: many}"), "sensors.noise.encoder_bits: expected a number");
}

TEST(Scenario, TheCommandLineReplacesKeysOfADisturbance) {
  const std::string pushed =
      kHead + "terrain: {ground_z: 0}\ndisturbances:\n" +
      "  - {link: utorso, force: [1, 2, 3], duration: 0.1, when: {time: 0.2}}\n" +
      "  - {link: utorso, force: 10, direction: 0.5, duration: 0.1, when: {time: 0.3}}\n";
  const auto with = [&](std::initializer_list<const char*> assignments, Issues* issues) {
    Settings settings;
    for (const char* assignment : assignments) settings.set_assignment(assignment, issues);
    return read_text(pushed, issues, &settings);
  };
  Issues issues;
  const auto scenario = with({"disturbances.1.force=20", "disturbances.1.direction=1.5707963",
                              "disturbances.0.when={time: 0.4}"},
                             &issues);
  ASSERT_TRUE(scenario) << issues.error_text();
  EXPECT_EQ(scenario->disturbances[0].force[2], 3.0);
  EXPECT_EQ(scenario->disturbances[0].time, 0.4);
  EXPECT_NEAR(scenario->disturbances[1].force[0], 0.0, 1e-5);
  EXPECT_NEAR(scenario->disturbances[1].force[1], 20.0, 1e-5);
  EXPECT_EQ(scenario->disturbances[1].time, 0.3);

  Issues wrong;
  EXPECT_FALSE(with({"disturbances.2.force=20", "disturbances.0.direction=1"}, &wrong));
  EXPECT_PART(wrong.error_text(),
              "disturbances.2.force: expected one of the 2 disturbances of the scenario, got "
              "'2.force'");
  EXPECT_PART(wrong.error_text(), "disturbances[0].direction: expected none beside a force");
}

TEST(Scenario, TheCommandLineReplacesKeysOfACommand) {
  const std::string commanded =
      kHead + "mode: walk-bent\ncommands:\n" + "  - {at: 0.1, walk: {steps: 2, length: 0.2}}\n" +
      "  - {at: 0.2, param: {}}\n" + "  - at: 0.3\n    footsteps: [{side: left, x: 1, y: 1}]\n";
  const auto with = [&](std::initializer_list<const char*> assignments, Issues* issues) {
    Settings settings;
    for (const char* assignment : assignments) settings.set_assignment(assignment, issues);
    return read_text(commanded, issues, &settings);
  };
  Issues issues;
  const auto scenario =
      with({"commands.0.walk.length=0.3", "commands.1.param.gait.swing_height=0.2",
            "commands.2.footsteps.0.contact_polygon=[[0.1, 0], [0, 0.1], [0, 0]]"},
           &issues);
  ASSERT_TRUE(scenario) << issues.error_text();
  ASSERT_EQ(scenario->commands.size(), 3u);
  EXPECT_EQ(scenario->commands[0].params["length"], 0.3);
  EXPECT_EQ(scenario->commands[0].params["steps"], 2);
  EXPECT_EQ(scenario->commands[1].params["name"], "gait.swing_height");
  EXPECT_EQ(scenario->commands[1].params["value"], 0.2);
  EXPECT_EQ(scenario->commands[2].params[0]["contact_polygon"][1][1], 0.1);

  Issues wrong;
  EXPECT_FALSE(with({"commands.3.at=0", "commands.0.walk.lenght=1"}, &wrong));
  EXPECT_PART(wrong.error_text(), "commands.3.at: expected one of the 3 commands of the scenario");
  EXPECT_PART(wrong.error_text(), "lenght");
}

TEST(Scenario, ErrorsOfAnOverrideNameTheCommandLine) {
  Issues issues;
  Settings settings;
  settings.set_assignment("seed=many", &issues);
  EXPECT_FALSE(read_text(kHead, &issues, &settings));
  EXPECT_PART(issues.error_text(), "--set seed=many: seed: expected a whole number");
}

TEST(Scenario, EveryOneThatIsShippedIsValidForItsRobot) {
  const Paths paths = Paths::detect();
  const std::vector<std::string> names = paths.scenarios();
  EXPECT_GE(names.size(), 10u);
  Issues robot_issues;
  Settings robot_settings;
  const auto robot = load_robot(paths.robot("atlas").value_or("").string(), Profile::kSimulation,
                                &robot_settings, &robot_issues);
  ASSERT_TRUE(robot) << robot_issues.error_text();
  for (const std::string& name : names) {
    Settings settings;
    Issues issues;
    const auto scenario = load_scenario(paths.scenario(name)->string(), &settings, &issues);
    ASSERT_TRUE(scenario) << issues.error_text();
    EXPECT_EQ(scenario->name, name);
    if (scenario->robot == "atlas") check_scenario(*scenario, robot->model, &issues);
    EXPECT_TRUE(issues.all().empty()) << issues.error_text() << issues.warning_text();
  }
}

TEST(Scenario, LinksAreCheckedAgainstTheRobot) {
  Issues issues;
  Settings settings;
  const auto robot = load_robot(Paths::detect().robot("atlas").value_or("").string(),
                                Profile::kSimulation, &settings, &issues);
  ASSERT_TRUE(robot) << issues.error_text();
  const auto scenario = read_text(
      kHead +
          "commands: [{at: 1, push: {link: utorsoo, force: [1, 0, 0], duration: 1}}]\n"
          "disturbances: [{link: pelvs, force: [1, 0, 0], duration: 1, when: {time: 1}}]\n"
          "model_error: {mass_scale: {head1: 1.1}, friction: 0.5}\n",
      &issues, &settings);
  ASSERT_TRUE(scenario) << issues.error_text();
  check_scenario(*scenario, robot->model, &issues);
  EXPECT_EQ(issues.error_count(), 3u) << issues.error_text();
  EXPECT_PART(issues.error_text(), "test.yaml:5: push.link");
  EXPECT_PART(issues.error_text(), "did you mean 'utorso'?");
  EXPECT_PART(issues.error_text(), "test.yaml:6: disturbances.link");
  EXPECT_PART(issues.error_text(), "did you mean 'head'?");
}

TEST(Scenario, TheRobotMustHaveRoomAtItsStart) {
  Issues none;
  Settings settings;
  const auto robot = load_robot(Paths::detect().robot("atlas").value_or("").string(),
                                Profile::kSimulation, &settings, &none);
  ASSERT_TRUE(robot) << none.error_text();
  const auto check = [&](const std::string& text, bool warning = false) {
    Issues issues;
    const auto scenario = read_text(kHead + text, &issues, &settings);
    EXPECT_TRUE(scenario) << issues.error_text();
    if (scenario) check_scenario(*scenario, robot->model, &issues);
    return warning ? issues.warning_text() : issues.error_text();
  };
  const std::string box =
      "terrain: {ground_z: 0, boxes: [{center: [1, 0, 0.1], size: [1, 1, 0.2]}]}\n";
  EXPECT_EQ(check(box), "");
  EXPECT_PART(check(box + "start: {x: 1}\n"),
              "test.yaml:6: start: expected a place that is free, got (1, 0), inside "
              "terrain.boxes[0]; move the start, the box, or start.z to the top of the box");
  EXPECT_PART(check(box + "start: {x: 0.4}\n"), "inside terrain.boxes[0]");  // with its toes
  EXPECT_EQ(check(box + "start: {x: 1, z: 0.2}\n", false), "");
  EXPECT_EQ(check(box + "start: {x: 1, z: 0.2}\n", true), "");
  const std::string beam =
      "terrain: {ground_z: 0, boxes: [{center: [0, 0, 0.8], size: [1, 1, 0.1]}]}\n";
  EXPECT_PART(check(beam), "inside terrain.boxes[0]");
  EXPECT_PART(check("start: {z: -0.1}\n"), "expected a height on or above the ground, got -0.1 m");
  EXPECT_EQ(check("start: {z: 0.3}\n"), "");
  EXPECT_PART(check("start: {z: 0.3}\n", true), "the robot will drop");
}

}  // namespace
}  // namespace gaitd::daemon

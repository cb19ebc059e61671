// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/command_parse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>

namespace gaitd::daemon {
namespace {

using nlohmann::json;

const GaitdModel& model() {
  static const auto kModel = [] {
    auto model = std::make_unique<GaitdModel>();
    model->body_count = 2;
    std::strcpy(model->bodies[0].name, "pelvis");
    std::strcpy(model->bodies[1].name, "utorso");
    return model;
  }();
  return *kModel;
}

std::optional<Command> parse(const std::string& method, const json& params, std::string* error) {
  return parse_command(method, params, model(), error);
}

TEST(CommandParse, PlainCommandsNeedNoParameters) {
  std::string error;
  for (const char* method : {"arm", "disarm", "estop", "reset", "pause", "resume", "stop", "abort",
                             "tare", "sim.reset"}) {
    EXPECT_TRUE(parse(method, nullptr, &error)) << method << ": " << error;
    EXPECT_TRUE(parse(method, json::object(), &error)) << method << ": " << error;
    EXPECT_TRUE(parse(method, true, &error)) << method << ": " << error;
    EXPECT_FALSE(parse(method, false, &error)) << method;
    EXPECT_FALSE(parse(method, {{"really", true}}, &error)) << method;
  }
  EXPECT_EQ(parse("estop", nullptr, &error)->type, CommandType::kEstop);
}

TEST(CommandParse, Mode) {
  std::string error;
  EXPECT_EQ(parse("mode", {{"mode", "walk-bent"}}, &error)->mode, GAITD_MODE_WALK_BENT);
  EXPECT_EQ(parse("mode", "walk-straight", &error)->mode, GAITD_MODE_WALK_STRAIGHT);
  EXPECT_FALSE(parse("mode", {{"mode", "walk-bend"}}, &error));
  EXPECT_EQ(error,
            "mode.mode: expected one of stand, walk-straight, walk-bent, got 'walk-bend' (text); "
            "did you mean 'walk-bent'?");
  EXPECT_FALSE(parse("mode", nullptr, &error));
}

TEST(CommandParse, Goto) {
  std::string error;
  const auto there = parse("goto", {{"x", 2.0}, {"y", -0.5}, {"yaw", 1.57}}, &error);
  ASSERT_TRUE(there) << error;
  EXPECT_EQ(there->type, CommandType::kGoto);
  EXPECT_EQ(there->target.x, 2.0);
  EXPECT_EQ(there->target.y, -0.5);
  EXPECT_TRUE(there->target.has_yaw);
  EXPECT_EQ(there->target.yaw, 1.57);
  EXPECT_FALSE(parse("goto", {{"x", 2.0}, {"y", 0.0}}, &error)->target.has_yaw);
  EXPECT_FALSE(parse("goto", {{"x", 2.0}}, &error));
  EXPECT_NE(error.find("goto.y"), std::string::npos) << error;
  EXPECT_FALSE(parse("goto", {{"x", 2.0}, {"y", 0.0}, {"z", 0.0}}, &error));
  EXPECT_FALSE(parse("goto", {{"x", 1e6}, {"y", 0.0}}, &error));
}

TEST(CommandParse, Walk) {
  std::string error;
  const auto command = parse("walk",
                             {{"steps", 12},
                              {"length", 0.35},
                              {"lateral", 0.1},
                              {"width", 0.25},
                              {"turn", -0.1},
                              {"swing", 0.6},
                              {"transfer", 0.25},
                              {"first", "right"}},
                             &error);
  ASSERT_TRUE(command) << error;
  EXPECT_EQ(command->type, CommandType::kWalk);
  EXPECT_EQ(command->walk.steps, 12);
  EXPECT_EQ(command->walk.length, 0.35);
  EXPECT_EQ(command->walk.lateral, 0.1);
  EXPECT_EQ(command->walk.width, 0.25);
  EXPECT_EQ(command->walk.turn, -0.1);
  EXPECT_EQ(command->walk.swing_duration, 0.6);
  EXPECT_EQ(command->walk.transfer_duration, 0.25);
  EXPECT_EQ(command->walk.first_side, GAITD_RIGHT);

  const auto short_command = parse("walk", {{"steps", 1}}, &error);
  ASSERT_TRUE(short_command) << error;
  EXPECT_EQ(short_command->walk.first_side, GAITD_BOTH);
  EXPECT_EQ(short_command->walk.swing_duration, 0.0);
}

TEST(CommandParse, SaysEverythingThatIsWrongWithAWalk) {
  std::string error;
  EXPECT_FALSE(parse("walk",
                     {{"steps", 0},
                      {"length", 3},
                      {"swing", 0.01},
                      {"transfer", "0.25"},
                      {"frist", "left"},
                      {"turn", NAN}},
                     &error));
  for (const char* part : {"walk.steps: expected a whole number in 1..1000, got 0",
                           "walk.length: expected a number in -2..2 m, got 3",
                           "walk.swing: expected a number in 0.05..20 s, got 0.01",
                           "walk.transfer: expected a number in 0.05..20 s, got '0.25' (text)",
                           "walk.turn: expected a number in -1.6..1.6 rad, got 'not finite' (text)",
                           "walk.frist: unknown key; did you mean 'first'?"}) {
    EXPECT_NE(error.find(part), std::string::npos) << part << "\nin:\n" << error;
  }
}

TEST(CommandParse, Footsteps) {
  std::string error;
  const json step = {{"side", "left"},
                     {"x", 0.3},
                     {"y", 0.12},
                     {"yaw", M_PI / 2},
                     {"swing", 0.6},
                     {"transfer", 0.25},
                     {"swing_height", 0.1},
                     {"contact_polygon", {{0.1, 0.05}, {0.0, 0.05}, {0.0, -0.05}, {0.1, -0.05}}},
                     {"landing_region", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}}};
  const auto command = parse("footsteps", {{"footsteps", {step, step}}, {"replace", true}}, &error);
  ASSERT_TRUE(command) << error;
  EXPECT_EQ(command->footstep_count, 2);
  EXPECT_TRUE(command->replace);
  const GaitdFootstep& footstep = command->footsteps[1];
  EXPECT_EQ(footstep.side, GAITD_LEFT);
  EXPECT_EQ(footstep.pose.position[0], 0.3);
  EXPECT_NEAR(footstep.pose.orientation[2], std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(footstep.pose.orientation[3], std::sqrt(0.5), 1e-12);
  EXPECT_EQ(footstep.polygon_count, 4);
  EXPECT_EQ(footstep.contact_polygon[3][1], -0.05);
  EXPECT_EQ(footstep.region_count, 3);
  EXPECT_EQ(footstep.landing_region[2][1], 1.0);
  // The short form, and replacing as a command of its own.
  EXPECT_FALSE(parse("footsteps", json::array({step}), &error)->replace);
  EXPECT_TRUE(parse("replace", json::array({step}), &error)->replace);
}

TEST(CommandParse, RefusesRegionsThatAreNone) {
  const auto error_of = [](const json& region, double z = 0.0) {
    std::string error;
    const json step = {
        {"side", "left"}, {"x", 0.3}, {"y", 0.12}, {"z", z}, {"landing_region", region}};
    const bool taken = parse("footsteps", json::array({step}), &error).has_value();
    EXPECT_EQ(taken, error.empty()) << error;
    return error;
  };
  struct Row {
    const char* what;
    json region;
    const char* error;
  };
  const double far = 1e300;
  const Row rows[] = {
      {"empty", json::array(), "landing_region: expected a list of 3 to 8 items, got a list of 0"},
      {"a line", {{0, 0, 0}, {0.5, 0.2, 0}}, "a list of 3 to 8 items, got a list of 2"},
      {"no area", {{0, 0, 0}, {0.3, 0.12, 0}, {0.6, 0.24, 0}}, "a convex outline"},
      {"a notch",
       {{0, 0, 0}, {0.6, 0, 0}, {0.35, 0.12, 0}, {0.6, 0.3, 0}, {0, 0.3, 0}},
       "a convex outline"},
      {"clockwise", {{0, 0, 0}, {0, 0.3, 0}, {0.6, 0.3, 0}, {0.6, 0, 0}}, "clockwise order"},
      {"not a number", {{0, 0, 0}, {0.6, "nan", 0}, {0.6, 0.3, 0}}, "landing_region[1][1]"},
      {"no number", {{0, 0, 0}, {0.6, nullptr, 0}, {0.6, 0.3, 0}}, "landing_region[1][1]"},
      {"out of the world", {{0, 0, 0}, {far, 0, 0}, {0.6, 0.3, 0}}, "landing_region[1][0]"},
      {"out of reach",
       {{9, 0, 0}, {10, 0, 0}, {10, 1, 0}, {9, 1, 0}},
       "a region around the foothold itself, got one beside it"},
      {"below",
       {{0, 0, -1}, {0.6, 0, -1}, {0.6, 0.3, -0.9}, {0, 0.3, -0.9}},
       "a region at the height of the foothold, 0 m, got one from -1 m to -0.9 m"},
  };
  for (const Row& row : rows) {
    const std::string error = error_of(row.region);
    EXPECT_NE(error.find(row.error), std::string::npos) << row.what << ": " << error;
    EXPECT_NE(error.find("footsteps[0].landing_region"), std::string::npos) << error;
  }
  EXPECT_EQ(error_of({{0, 0, 0}, {0.6, 0, 0}, {0.6, 0.3, 0.2}, {0, 0.3, 0.2}}, 0.1), "");
}

TEST(CommandParse, SaysWhichFootstepIsWrong) {
  std::string error;
  const json good = {{"side", "left"}, {"x", 0.3}, {"y", 0.12}};
  json bad = {{"side", "both"},
              {"x", 1e300},
              {"contact_polygon", {{0.1, 0.05}, {0.1, -0.05}, {0, -0.05}, {0, 0.05}}},
              {"landing_region", json::array()}};
  for (int i = 0; i < 9; ++i) bad["landing_region"].push_back({i, i * i, 0});
  EXPECT_FALSE(parse("footsteps", {{"footsteps", {good, bad}}}, &error));
  for (const char* part :
       {"footsteps.footsteps[1].side: expected one of left, right",
        "footsteps.footsteps[1].x: expected a number in",
        "footsteps.footsteps[1].y: expected a value, got nothing", "points in clockwise order",
        "a list of 3 to 8 items, got a list of 9"}) {
    EXPECT_NE(error.find(part), std::string::npos) << part << "\nin:\n" << error;
  }
  json many = json::array();
  for (int i = 0; i < 65; ++i) many.push_back(good);
  EXPECT_FALSE(parse("footsteps", many, &error));
  EXPECT_FALSE(parse("footsteps", json::array(), &error));
}

TEST(CommandParse, Push) {
  std::string error;
  const auto command =
      parse("sim.push", {{"link", "utorso"}, {"force", {444, 0, 0}}, {"duration", 0.1}}, &error);
  ASSERT_TRUE(command) << error;
  EXPECT_EQ(command->push.body, 1);
  EXPECT_EQ(command->push.force[0], 444.0);
  EXPECT_FALSE(
      parse("sim.push", {{"link", "utorzo"}, {"force", {444, 0}}, {"duration", -1}}, &error));
  for (const char* part :
       {"sim.push.link: expected a link of the robot that moves, got utorzo; did "
        "you mean 'utorso'?",
        "sim.push.force: expected a list of 3 numbers",
        "sim.push.duration: expected a number in 0.0001..60 s, got -1"}) {
    EXPECT_NE(error.find(part), std::string::npos) << part << "\nin:\n" << error;
  }
}

TEST(CommandParse, RefusesUnknownMethodsAndParametersThatAreNoMap) {
  std::string error;
  EXPECT_FALSE(parse("wlak", nullptr, &error));
  EXPECT_NE(error.find("did you mean 'walk'?"), std::string::npos) << error;
  for (const json& params : {json(3), json("x"), json::array({1, 2}), json(true)}) {
    EXPECT_FALSE(parse("walk", params, &error)) << params.dump();
    EXPECT_FALSE(error.empty());
  }
}

}  // namespace
}  // namespace gaitd::daemon

// SPDX-License-Identifier: Apache-2.0
// What the gauntlet draws: always the same, within its ranges, and ground that the feet can stand
// on.
#include "cli/gauntlet/gauntlet.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "cli/gauntlet/story.h"
#include "daemon/config/paths.h"
#include "daemon/config/robot.h"
#include "daemon/config/scenario.h"
#include "daemon/config/yaml_reader.h"
#include "walking/test/atlas.h"

namespace gaitd::cli {
namespace {

using testing::atlas;

using Eigen::Isometry3d;
using Eigen::Vector3d;
using nlohmann::json;

constexpr int kSeeds = 60;

std::uint64_t hash_of(const std::string& text) {
  std::uint64_t h = 14695981039346656037ULL;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return h;
}

daemon::Scenario drawn_scenario(const std::string& kind, std::uint64_t seed) {
  daemon::Issues issues;
  daemon::Settings settings;
  const daemon::NodePtr root = daemon::parse_yaml(gauntlet_scenario(kind, seed), kind, &issues);
  auto scenario = daemon::read_scenario(root, kind, &settings, &issues);
  EXPECT_TRUE(scenario) << kind << " " << seed << ": " << issues.error_text();
  if (!scenario) return {};
  check_scenario(*scenario, atlas(), &issues);
  EXPECT_TRUE(issues.all().empty()) << kind << " " << seed << ": " << issues.error_text();
  return *scenario;
}

Isometry3d pose(const json& position, double roll, double pitch) {
  Isometry3d out = Isometry3d::Identity();
  out.translation() = Vector3d(position[0], position[1], position[2]);
  out.rotate(Eigen::AngleAxisd(pitch, Vector3d::UnitY()) *
             Eigen::AngleAxisd(roll, Vector3d::UnitX()));
  return out;
}

// How far the point is above the ground that is highest there; it must be above some.
double height_above(const json& terrain, const Vector3d& point) {
  double ground = terrain["ground_z"].get<double>();
  for (const json& box : terrain["boxes"]) {
    const Isometry3d middle = pose(box["center"], box["rpy"][0], box["rpy"][1]);
    const Vector3d half = 0.5 * Vector3d(box["size"][0], box["size"][1], box["size"][2]);
    const Vector3d up = middle.linear().col(2);
    // Where the vertical through the point meets the plane of the top.
    const Vector3d top = middle * Vector3d(0.0, 0.0, half.z());
    Vector3d hit = point;
    hit.z() = top.z() - (up.x() * (point.x() - top.x()) + up.y() * (point.y() - top.y())) / up.z();
    const Vector3d local = middle.inverse() * hit;
    if (std::abs(local.x()) > half.x() || std::abs(local.y()) > half.y()) continue;
    ground = std::max(ground, hit.z());
  }
  return point.z() - ground;
}

const json& footsteps_of(const daemon::Scenario& scenario) {
  return scenario.commands.at(0).params;
}

template <typename Visit>
void for_each_drawn(const std::string& kind, const Visit& visit) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(kind + " " + std::to_string(seed));
    visit(drawn_scenario(kind, seed));
  }
}

// The least and the largest of what is drawn: in the range, and nearly all of it.
class Range {
 public:
  Range(double low, double high) : low_(low), high_(high) {}
  ~Range() {
    const double part = 0.15 * (high_ - low_);
    EXPECT_GE(least_, low_ - 1e-3);
    EXPECT_LE(least_, low_ + part);
    EXPECT_LE(most_, high_ + 1e-3);
    EXPECT_GE(most_, high_ - part);
  }
  void see(double value) {
    least_ = std::min(least_, value);
    most_ = std::max(most_, value);
  }

 private:
  double low_, high_;
  double least_ = 1e9, most_ = -1e9;
};

TEST(Gauntlet, TheSameSeedIsTheSameTextOnEveryMachine) {
  // Drives (1), worlds (2), half footholds (3) and sessions (4) apart: they came later.
  std::map<int, std::string> all;
  std::set<std::string> different;
  for (const std::string& kind : gauntlet_kinds()) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const std::string text = gauntlet_scenario(kind, seed);
      EXPECT_EQ(text, gauntlet_scenario(kind, seed));
      different.insert(text.substr(text.find("terrain:")));
      all[kind == "drive"            ? 1
          : kind.starts_with("goto") ? 2
          : kind == "partial"        ? 3
          : kind == "session"        ? 4
                                     : 0] += text;
    }
  }
  EXPECT_EQ(different.size(), 20 * gauntlet_kinds().size());
  // Whoever changes what is drawn changes this, and makes old figures those of another gauntlet.
  EXPECT_EQ(hash_of(all[0]), 0x5f94b2a5a103e6bfULL);
  EXPECT_EQ(hash_of(all[1]), 0x871326e179adc25fULL);
  EXPECT_EQ(hash_of(all[2]), 0x38638c62b9913a6bULL);
  EXPECT_EQ(hash_of(all[3]), 0xfee805db951847c3ULL);
  EXPECT_EQ(hash_of(all[4]), 0x51b863dc6cfc92f7ULL);
}

// The robot has to see its way, there is room where it starts and where it goes to, and what is
// harder has more obstacles.
TEST(Gauntlet, WorldsAreCoursesBetweenTwoFreePlaces) {
  std::map<std::string, double> boxes;
  for (const std::string kind : {"goto-easy", "goto", "goto-hard"}) {
    for_each_drawn(kind, [&](const daemon::Scenario& scenario) {
      EXPECT_EQ(scenario.perception["sensor"], "depth_camera");
      const json& goal = scenario.commands.at(0).params;
      EXPECT_GT(goal["x"].get<double>(), 1.2);
      EXPECT_LT(goal["x"].get<double>(), 12.0);
      EXPECT_EQ(scenario.expect.final_pelvis->tolerance, 0.15);
      boxes[kind] += static_cast<double>(scenario.terrain["boxes"].size());
      for (const json& box : scenario.terrain["boxes"]) {
        const double top = box["center"][2].get<double>() + 0.5 * box["size"][2].get<double>();
        if (top < 0.301) continue;
        for (const double x : {0.0, goal["x"].get<double>()}) {
          const double off =
              std::abs(box["center"][0].get<double>() - x) -
              0.5 * std::hypot(box["size"][0].get<double>(), box["size"][1].get<double>());
          const double across =
              std::abs(box["center"][0].get<double>() - x) - 0.5 * box["size"][0].get<double>();
          EXPECT_GT(std::max(off, across), 0.2) << scenario.name << box.dump();
        }
      }
    });
  }
  EXPECT_GT(boxes["goto"], 1.3 * boxes["goto-easy"]);
  EXPECT_GT(boxes["goto-hard"], 1.3 * boxes["goto"]);
}

TEST(Gauntlet, ADriveIsAMinuteOfTenVelocities) {
  Range forward(-0.3, 0.6), lateral(-0.2, 0.2), turn(-0.4, 0.4);
  for_each_drawn("drive", [&](const daemon::Scenario& scenario) {
    EXPECT_EQ(scenario.expect.no_fall, true);
    EXPECT_EQ(scenario.expect.drive_speed_error_max, 0.1);
    ASSERT_EQ(scenario.expect.checks.size(), 1u);
    EXPECT_EQ(scenario.expect.checks[0].min, 20.0);
    ASSERT_EQ(scenario.commands.size(), 11u);
    EXPECT_GE(scenario.commands.back().at, 42.5);
    EXPECT_LE(scenario.commands.back().at, 82.5);
    EXPECT_GE(scenario.duration, scenario.commands.back().at + 8.0);
    for (std::size_t i = 0; i + 1 < scenario.commands.size(); ++i) {
      const json& velocity = scenario.commands[i].params;
      forward.see(velocity["forward"]);
      lateral.see(velocity["lateral"]);
      turn.see(velocity["turn"]);
    }
  });
}

// Everything that operators do, in time, while the robot stands and while it walks.
TEST(Gauntlet, ASessionIsEightActsInAnyOrder) {
  std::map<std::string, int> said;
  int pushes = 0, together = 0;
  Range length(-0.3, 0.6), aside(0.05, 0.45), height(-0.12, 0.02), impulse(10.0, 30.0);
  for_each_drawn("session", [&](const daemon::Scenario& scenario) {
    EXPECT_EQ(scenario.expect.no_fall, true);
    EXPECT_GE(scenario.commands.size(), 8u);
    double before = 0.0;
    for (const auto& command : scenario.commands) {
      EXPECT_GE(command.at, before);
      together += command.at < before + 1.0;
      before = command.at;
      ++said[command.method];
      const json& p = command.params;
      if (command.method == "walk") length.see(p["length"]);
      if (command.method == "footsteps") aside.see(std::abs(p["footsteps"][0]["y"].get<double>()));
      if (command.method == "pose" && p.contains("pelvis") && p["pelvis"].contains("z")) {
        height.see(p["pelvis"]["z"]);
      }
    }
    EXPECT_GE(scenario.duration, before + 4.0);
    for (const auto& push : scenario.disturbances) {
      ++pushes;
      impulse.see(std::hypot(push.force[0], push.force[1]) * push.duration);
    }
  });
  for (const char* method :
       {"walk", "velocity", "footsteps", "pose", "mode", "stop", "pause", "resume"}) {
    EXPECT_GT(said[method], kSeeds / 4) << method;
  }
  EXPECT_GT(pushes, kSeeds);
  EXPECT_GT(together, kSeeds);
}

TEST(Gauntlet, EveryKindIsAcceptedAndAsksForAWalkToAGoal) {
  EXPECT_EQ(gauntlet_scenario("nothing", 1), "");
  for (const std::string& kind : gauntlet_kinds()) {
    // Whoever drives or tries things looks where the robot is.
    if (kind == "drive" || kind == "session") continue;
    for_each_drawn(kind, [&](const daemon::Scenario& scenario) {
      EXPECT_EQ(scenario.expect.no_fall, true);
      ASSERT_TRUE(scenario.expect.final_pelvis);
      // Who stands still does not arrive.
      const daemon::FinalPelvis& goal = *scenario.expect.final_pelvis;
      EXPECT_GT(std::hypot(goal.x, goal.y), 1.5 * goal.tolerance);
      const bool goes = kind.starts_with("goto");
      if (kind.starts_with("push") || goes) {
        ASSERT_EQ(scenario.expect.checks.size(), 1u);
        EXPECT_EQ(scenario.expect.checks[0].signal, "gait/step_index");
        EXPECT_GE(scenario.expect.checks[0].min.value_or(0.0), goes ? 4.0 : 5.0);
        EXPECT_EQ(scenario.disturbances.size(), goes ? 0u : 2u);
      } else {
        ASSERT_TRUE(scenario.expect.steps_taken);
        EXPECT_GE(*scenario.expect.steps_taken, 6);
        EXPECT_TRUE(scenario.disturbances.empty());
      }
    });
  }
}

TEST(Gauntlet, MassesCentreAndFrictionAreWithinTheirRanges) {
  Range friction(0.55, 1.0), mass(0.95, 1.05), com(-0.01, 0.01);
  for (const std::string& kind : gauntlet_kinds()) {
    for_each_drawn(kind, [&](const daemon::Scenario& scenario) {
      friction.see(scenario.terrain["friction"]);
      const json& scale = scenario.model_error["mass_scale"];
      EXPECT_EQ(scale.size(), 31u);
      for (const auto& [link, value] : scale.items()) mass.see(value);
      for (const json& value : scenario.model_error["com_offset"]["utorso"]) com.see(value);
    });
  }
}

TEST(Gauntlet, WalksAreWithinTheirRanges) {
  Range length(0.50, 0.70), back(-0.30, -0.10), side(-0.25, 0.25), turn(-0.2, 0.2);
  const auto walk = [](const daemon::Scenario& scenario) { return scenario.commands.at(0).params; };
  for_each_drawn("long", [&](const auto& s) { length.see(walk(s)["length"]); });
  for_each_drawn("back", [&](const auto& s) { back.see(walk(s)["length"]); });
  for_each_drawn("side", [&](const auto& s) { side.see(walk(s)["lateral"]); });
  for_each_drawn("curve", [&](const auto& s) { turn.see(walk(s)["turn"]); });
}

TEST(Gauntlet, FeetStandFlatOnTheGroundOfEveryFoothold) {
  for (const char* kind :
       {"stairs-up", "stairs-down", "drops", "slope-up", "slope-down", "blocks"}) {
    for_each_drawn(kind, [&](const daemon::Scenario& scenario) {
      bool left = footsteps_of(scenario)[0]["side"] == "right";
      for (const json& step : footsteps_of(scenario)) {
        EXPECT_NE(step["side"] == "left", left);
        left = !left;
        const Isometry3d sole =
            pose({step["x"], step["y"], step["z"]}, step["roll"], step["pitch"]);
        for (const double x : {-0.1302, 0.1302}) {
          for (const double y : {-0.0643, 0.0643}) {
            EXPECT_NEAR(height_above(scenario.terrain, sole * Vector3d(x, y, 0.0)), 0.0, 0.002)
                << step.dump();
          }
        }
      }
    });
  }
}

// Half of the sole hangs over a pit, or nothing of it; toes, heel, inner and outer half alike.
TEST(Gauntlet, PartialFootholdsCarryHalfASole) {
  std::map<std::string, int> lost;
  int whole = 0;
  for_each_drawn("partial", [&](const daemon::Scenario& scenario) {
    for (const json& step : footsteps_of(scenario)) {
      const double out = step["side"] == "left" ? 1.0 : -1.0;
      int carried = 0;
      Vector3d middle = Vector3d::Zero();  // of what is not
      constexpr int kPoints = 10;
      for (int i = 0; i < kPoints; ++i) {
        for (int j = 0; j < kPoints; ++j) {
          const Vector3d in_sole(0.26 * ((i + 0.5) / kPoints - 0.5),
                                 0.128 * ((j + 0.5) / kPoints - 0.5), 0.0);
          const Vector3d p = Vector3d(step["x"], step["y"], step["z"]) + in_sole;
          const double above = height_above(scenario.terrain, p);
          EXPECT_TRUE(std::abs(above) < 1e-3 || above > 0.1) << step.dump();
          if (above < 0.05) {
            ++carried;
          } else {
            middle += in_sole;
          }
        }
      }
      if (carried == kPoints * kPoints) {
        ++whole;
        continue;
      }
      EXPECT_EQ(carried, kPoints * kPoints / 2) << step.dump();
      const bool along = std::abs(middle.x()) > std::abs(middle.y());
      ++lost[along ? (middle.x() > 0.0 ? "toes" : "heel")
                   : (middle.y() * out > 0.0 ? "outer" : "inner")];
    }
  });
  int partial = 0;
  for (const char* half : {"toes", "heel", "outer", "inner"}) {
    EXPECT_GT(lost[half], kSeeds / 3) << half;
    partial += lost[half];
  }
  EXPECT_EQ(lost.size(), 4u);
  EXPECT_GT(partial, 2 * kSeeds);
  EXPECT_GT(whole, 4 * kSeeds);
}

TEST(Gauntlet, StairsDropsAndSlopesAreWithinTheirRanges) {
  Range rise(0.10, 0.20), fall(-0.20, -0.10), drop(-0.20, -0.10),
      angle(3 * kRadiansPerDegree, 13 * kRadiansPerDegree);
  const auto changes = [](const daemon::Scenario& scenario, Range* range) {
    double z = scenario.start.position[2];
    int stairs = 0;
    for (const json& step : footsteps_of(scenario)) {
      const double change = step["z"].get<double>() - z;
      z += change;
      if (std::abs(change) < 0.001) continue;
      range->see(change);
      ++stairs;
    }
    EXPECT_GE(stairs, 2);
  };
  for_each_drawn("stairs-up", [&](const auto& s) { changes(s, &rise); });
  for_each_drawn("stairs-down", [&](const auto& s) { changes(s, &fall); });
  for_each_drawn("drops", [&](const auto& s) { changes(s, &drop); });
  for_each_drawn("slope-up", [&](const auto& s) {
    angle.see(-footsteps_of(s)[2]["pitch"].template get<double>());
  });
  for_each_drawn("slope-down", [&](const auto& s) { angle.see(footsteps_of(s)[2]["pitch"]); });
}

TEST(Gauntlet, BlocksTiltUpToFifteenDegreesAndGoUpAndDown) {
  Range tilt(5 * kRadiansPerDegree, 15 * kRadiansPerDegree);
  int up = 0, down = 0;
  for_each_drawn("blocks", [&](const daemon::Scenario& scenario) {
    for (const json& step : footsteps_of(scenario)) {
      const double tilted =
          std::abs(step["roll"].get<double>()) + std::abs(step["pitch"].get<double>());
      if (tilted > 0.0) tilt.see(tilted);
    }
    const double change =
        footsteps_of(scenario).back()["z"].get<double>() - scenario.start.position[2];
    up += change > 0.05 ? 1 : 0;
    down += change < -0.05 ? 1 : 0;
  });
  EXPECT_GE(up, 10);
  EXPECT_GE(down, 10);
}

TEST(Gauntlet, UnknownStepsAreThereAndTheWalkIsNotToldOfThem) {
  Range height(-0.10, 0.04), change(-0.05, 0.05);
  for_each_drawn("unknown-steps", [&](const daemon::Scenario& scenario) {
    EXPECT_EQ(scenario.commands.at(0).method, "walk");
    const double length = scenario.commands[0].params["length"];
    double before = 0.0;
    for (int i = 1; i <= 10; ++i) {
      const Vector3d foothold(length * i, 0.0, scenario.start.position[2]);
      const double now = -height_above(scenario.terrain, foothold);
      height.see(now);
      change.see(now - before);
      before = now;
    }
  });
}

TEST(Gauntlet, PushesAreWithinTheirRangesAndInEveryDirection) {
  Range impulse(25.0, 60.0), force(150.0, 340.0), direction(-M_PI, M_PI);
  const auto strength = [&](const daemon::ScenarioDisturbance& push) {
    direction.see(std::atan2(push.force[1], push.force[0]));
    EXPECT_EQ(push.force[2], 0.0);
    return std::hypot(push.force[0], push.force[1]);
  };
  for_each_drawn("push-walking", [&](const daemon::Scenario& scenario) {
    for (const auto& push : scenario.disturbances) {
      EXPECT_TRUE(push.at_step);
      impulse.see(strength(push) * push.duration);
    }
    // Apart, and both before the last steps.
    EXPECT_GE(scenario.disturbances[1].step - scenario.disturbances[0].step, 2);
    EXPECT_LE(scenario.disturbances[1].step, 6);
  });
  for_each_drawn("push-standing", [&](const daemon::Scenario& scenario) {
    for (const auto& push : scenario.disturbances) {
      EXPECT_FALSE(push.at_step);
      EXPECT_LT(push.time + 3.0, scenario.commands.at(0).at);
      EXPECT_EQ(push.duration, 0.2);
      force.see(strength(push));
    }
  });
}

}  // namespace
}  // namespace gaitd::cli

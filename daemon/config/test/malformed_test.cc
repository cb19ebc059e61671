// SPDX-License-Identifier: Apache-2.0
// Whatever a file holds, reading it ends with a list of errors, never with a crash or an exception.
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "daemon/config/command_parse.h"
#include "daemon/config/daemon_config.h"
#include "daemon/config/paths.h"
#include "daemon/config/robot.h"
#include "daemon/config/scenario.h"
#include "daemon/config/test/temporary_folder.h"

namespace gaitd::daemon {
namespace {

std::string contents(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

// Characters that mean something in YAML, so that most texts get past the first one.
std::string random_yaml(std::mt19937* random) {
  static constexpr char kCharacters[] = "abn01.-+:?,[]{}#&*!|>'\"%@` \n\n\t~<=\\\0\x80\xff";
  static const std::string kAlphabet(kCharacters, sizeof(kCharacters) - 1);
  std::string text(std::uniform_int_distribution<int>(0, 200)(*random), ' ');
  for (char& c : text) {
    c = kAlphabet[std::uniform_int_distribution<std::size_t>(0, kAlphabet.size() - 1)(*random)];
  }
  return text;
}

std::string mutated(std::string text, std::mt19937* random) {
  const int changes = std::uniform_int_distribution<int>(1, 8)(*random);
  for (int i = 0; i < changes && !text.empty(); ++i) {
    const auto at = std::uniform_int_distribution<std::size_t>(0, text.size() - 1)(*random);
    switch (std::uniform_int_distribution<int>(0, 3)(*random)) {
      case 0:
        text[at] = static_cast<char>(std::uniform_int_distribution<int>(0, 255)(*random));
        break;
      case 1:
        text.erase(at, std::uniform_int_distribution<std::size_t>(1, 20)(*random));
        break;
      case 2:
        text.insert(at, random_yaml(random).substr(0, 5));
        break;
      default:
        text.insert(at, text.substr(text.size() / 2, 30));
    }
  }
  return text;
}

TEST(Malformed, RandomTextIsReadOrRefused) {
  std::mt19937 random(1);
  for (int i = 0; i < 3000; ++i) {
    const std::string text = random_yaml(&random);
    Issues issues;
    const NodePtr root = parse_yaml(text, "x.yaml", &issues);
    if (!root) {
      EXPECT_FALSE(issues.ok()) << text;
      continue;
    }
    Settings settings;
    read_scenario(root, "x.yaml", &settings, &issues);
    to_json(*root);
  }
}

TEST(Malformed, DamagedScenariosAreReadOrRefused) {
  const Paths paths = Paths::detect();
  std::mt19937 random(2);
  const std::string rich =
      contents(paths.scenario("one-by-one").value_or("")) +
      "terrain: {friction: 1, ground_z: 0, boxes: [{center: [1, 0, 0], size: [1, 1, 1]}]}\n"
      "disturbances: [{link: utorso, force: [1, 0, 0], duration: 1, when: {step: 1}}]\n";
  for (int i = 0; i < 3000; ++i) {
    Issues issues;
    Settings settings;
    const NodePtr root = parse_yaml(mutated(rich, &random), "x.yaml", &issues);
    if (!root) continue;
    const auto scenario = read_scenario(root, "x.yaml", &settings, &issues);
    if (scenario)
      scenario->simulator_config().dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    issues.error_text();
  }
}

TEST(Malformed, DamagedRobotsAreReadOrRefused) {
  const std::filesystem::path file = Paths::detect().robot("atlas").value_or("");
  const std::string text = contents(file);
  TemporaryFolder folder;
  std::filesystem::copy_file(file.parent_path() / "atlas.urdf", folder.path() / "atlas.urdf");
  std::mt19937 random(3);
  for (int i = 0; i < 150; ++i) {
    Issues issues;
    Settings settings;
    const auto robot = load_robot(folder.write("robot.yaml", mutated(text, &random)),
                                  Profile::kSimulation, &settings, &issues);
    EXPECT_EQ(robot.has_value(), issues.ok());
  }
}

TEST(Malformed, DamagedConfigurationsAreReadOrRefused) {
  const std::string text = contents(Paths::detect().config().value_or(""));
  TemporaryFolder folder;
  std::mt19937 random(4);
  for (int i = 0; i < 400; ++i) {
    Issues issues;
    Settings settings;
    load_config_file(folder.write("gaitd.yaml", mutated(text, &random)), &settings, &issues);
    read_daemon_config(&settings, &issues);
    settings.report_unknown(&issues);
    issues.error_text();
  }
}

nlohmann::json random_json(std::mt19937* random, int depth) {
  switch (std::uniform_int_distribution<int>(0, depth > 4 ? 5 : 8)(*random)) {
    case 0:
      return nullptr;
    case 1:
      return true;
    case 2:
      return std::uniform_int_distribution<int>(-3, 3)(*random);
    case 3:
      return std::uniform_real_distribution<double>(-1e3, 1e3)(*random);
    case 4:
      return "left";
    case 5:
      return "\xff\x00";
    default:
      break;
  }
  static const std::vector<std::string> kKeys = {
      "steps", "length", "footsteps",       "side",           "x",       "mode", "link", "force",
      "y",     "bad",    "contact_polygon", "landing_region", "duration"};
  nlohmann::json result;
  const int size = std::uniform_int_distribution<int>(0, 4)(*random);
  const bool list = std::uniform_int_distribution<int>(0, 1)(*random) == 0;
  result = list ? nlohmann::json::array() : nlohmann::json::object();
  for (int i = 0; i < size; ++i) {
    nlohmann::json value = random_json(random, depth + 1);
    if (list) {
      result.push_back(std::move(value));
    } else {
      result[kKeys[std::uniform_int_distribution<std::size_t>(0, kKeys.size() - 1)(*random)]] =
          std::move(value);
    }
  }
  return result;
}

TEST(Malformed, RandomParametersOfCommandsAreReadOrRefused) {
  const auto model = std::make_unique<GaitdModel>();
  std::mt19937 random(5);
  for (int i = 0; i < 5000; ++i) {
    for (const std::string& method : command_methods()) {
      std::string error;
      const auto command = parse_command(method, random_json(&random, 0), *model, &error);
      EXPECT_EQ(command.has_value(), error.empty());
    }
  }
}

TEST(Malformed, DeepJsonIsRefused) {
  nlohmann::json deep = 1;
  for (int i = 0; i < 1000; ++i) deep = nlohmann::json::array({deep});
  const auto model = std::make_unique<GaitdModel>();
  std::string error;
  EXPECT_FALSE(parse_command("footsteps", deep, *model, &error));
  EXPECT_FALSE(error.empty());
}

}  // namespace
}  // namespace gaitd::daemon

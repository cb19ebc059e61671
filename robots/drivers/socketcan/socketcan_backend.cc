// SPDX-License-Identifier: Apache-2.0
// The plugin: a robot on CAN as a backend.
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "can_robot.h"
#include "gaitd/sdk/backend.h"
#include "json_reader.h"

namespace gaitd::can {
namespace {

class SocketcanBackend {
 public:
  explicit SocketcanBackend(const GaitdHost& host) : host_(host) {}

  std::string init(const GaitdModel& model, const std::string& config, double period, int clock) {
    std::vector<std::string> errors;
    const nlohmann::json document = nlohmann::json::parse(config, nullptr, false);
    sim::JsonReader root(document, "", &errors);
    root.allow({"can", "lockstep_timeout"});
    RobotOptions options;
    options.period = period;
    options.lockstep = clock == GAITD_CLOCK_LOCKSTEP;
    root.number("lockstep_timeout", {0.001, 60}, &options.lockstep_timeout);
    Wiring wiring;
    if (root.has("can")) {
      wiring = parse_wiring(root.at("can").dump(), model, period, &errors);
    } else {
      errors.push_back(
          "can: expected the wiring of the robot, got nothing; add a can: section to its "
          "robot.yaml");
    }
    std::string text;
    for (const std::string& line : errors) text += (text.empty() ? "" : "\n") + line;
    if (!text.empty()) return text;
    robot_ = std::make_unique<CanRobot>(
        std::move(wiring), model, options,
        [this](int level, const std::string& line) { log(level, line); });
    return "";
  }

  GaitdStatus start() {
    std::vector<std::string> errors;
    if (robot_->start(&errors)) return GAITD_OK;
    for (const std::string& line : errors) log(GAITD_LOG_ERROR, line);
    robot_->stop();
    return GAITD_ERROR;
  }

  GaitdStatus read(GaitdSensors& sensors) { return robot_->read(&sensors); }
  GaitdStatus write(const GaitdJointCommands& commands) { return robot_->write(commands); }
  GaitdStatus advance() { return robot_->advance(); }
  void stop() { robot_->stop(); }

  GaitdStatus health(GaitdHealth& health) {
    robot_->health(&health);
    return GAITD_OK;
  }

 private:
  void log(int level, const std::string& line) const {
    if (host_.log != nullptr) host_.log(host_.context, level, line.c_str());
  }

  GaitdHost host_;
  std::unique_ptr<CanRobot> robot_;
};

}  // namespace
}  // namespace gaitd::can

// The figure is of read and write.
GAITD_EXPORT_BACKEND(gaitd::can::SocketcanBackend, "socketcan", GAITD_SOCKETCAN_VERSION, 200.0, 0)

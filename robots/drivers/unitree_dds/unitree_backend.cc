// SPDX-License-Identifier: Apache-2.0
// The plugin: a Unitree humanoid over its own DDS interface as a backend.
#include <memory>
#include <string>
#include <vector>

#include "gaitd/sdk/backend.h"
#include "unitree_robot.h"

namespace gaitd::unitree {
namespace {

class UnitreeBackend {
 public:
  explicit UnitreeBackend(const GaitdHost& host) : host_(host) {}

  std::string init(const GaitdModel& model, const std::string& config, double period, int clock) {
    std::vector<std::string> errors;
    const Settings settings = parse_settings(config, model, &errors);
    RobotOptions options;
    options.period = period;
    options.lockstep = clock == GAITD_CLOCK_LOCKSTEP;
    options.link_program = find_link_program();
    if (options.link_program.empty()) {
      errors.push_back(
          "expected gaitd-unitree-link in lib/gaitd of this installation, got nothing there; "
          "install "
          "gaitd-unitree");
    }
    std::string text;
    for (const std::string& line : errors) text += (text.empty() ? "" : "\n") + line;
    if (!text.empty()) return text;
    robot_ = std::make_unique<UnitreeRobot>(
        settings, model, options, [this](int level, const std::string& line) { log(level, line); });
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
  std::unique_ptr<UnitreeRobot> robot_;
};

}  // namespace
}  // namespace gaitd::unitree

// The figure is of read and write.
GAITD_EXPORT_BACKEND(gaitd::unitree::UnitreeBackend, "unitree_dds", GAITD_UNITREE_VERSION, 100.0, 0)

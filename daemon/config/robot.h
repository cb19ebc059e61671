// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "daemon/config/calibration.h"
#include "daemon/config/issues.h"
#include "daemon/config/settings.h"
#include "gaitd/abi/types.h"
#include "gaitd/dynamics/urdf.h"

namespace gaitd::daemon {

enum class Profile { kSimulation, kHardware };

// Stiffness and damping of the drives around the integrated references, per joint of the model.
struct JointImpedance {
  std::array<double, GAITD_MAX_JOINTS> stiffness{};  // N m/rad
  std::array<double, GAITD_MAX_JOINTS> damping{};    // N m s/rad
};

// What a leg uses in each of its states; joints that belong to no leg use `support`.
struct ImpedanceProfile {
  bool given = false;          // robot.yaml has a section for it
  JointImpedance support;      // the foot carries load
  JointImpedance swing;        // the foot is in the air
  JointImpedance heel_strike;  // the first moments after touchdown
};

// A robot as its robot.yaml describes it: data, never code.
struct Robot {
  std::string name;
  std::string file;  // robot.yaml
  std::string urdf;  // path of the URDF file
  dynamics::UrdfOptions urdf_options;
  GaitdModel model{};
  ImpedanceProfile impedance;  // of the chosen profile
  Calibration calibration;     // none unless load_calibration() was called
  std::string calibration_file;
  NodePtr can;  // wiring of the motors, see load_wiring(); null without
};

// Reads robots/<name>/robot.yaml and the URDF it names, fills the model, and puts the parameters of
// the robot and of the profile into `settings`. Reports everything that is wrong and then returns
// nothing: unknown keys, links and joints, a chain that does not run from pelvis to foot, a nominal
// posture outside the joint limits or in which the soles are not level and side by side.
std::optional<Robot> load_robot(const std::string& file, Profile profile, Settings* settings,
                                Issues* issues);

// The same from a document that has been read. `load` reads the URDF file; a relative path in the
// document is meant from the folder of `file`.
using UrdfLoader = std::function<dynamics::UrdfResult(const std::string& path,
                                                      const dynamics::UrdfOptions& options)>;
std::optional<Robot> read_robot(const NodePtr& document, const std::string& file, Profile profile,
                                const UrdfLoader& load, Settings* settings, Issues* issues);

// Reads a calibration into `robot`: the path of a file, or the NAME of calibration/NAME.yaml beside
// robot.yaml; "" for none. `where`: of the setting, for the errors.
void load_calibration(const std::string& name, Robot* robot, const Location& where, Issues* issues);

// The wiring of a robot, for the backend to check: a map, or the name of a file that holds it,
// relative to `folder`. Null and an issue when it cannot be read. Only who drives motors needs it.
NodePtr load_wiring(const NodePtr& value, const std::string& folder, Issues* issues);

}  // namespace gaitd::daemon

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/command/command.h"
#include "daemon/config/node.h"

namespace gaitd::daemon {

// The methods that parse_command understands.
const std::vector<std::string>& command_methods();

// A request of a client or a line of a scenario as a command of the control thread. Methods:
//   arm disarm estop reset pause resume stop abort sim.reset      (no parameters)
//   mode       {mode: stand|walk-straight|walk-bent}
//   walk       {steps, length, lateral, width, turn, swing, transfer, first}   (steps required)
//   footsteps  {footsteps: [{side, x, y, z, yaw, pitch, roll, swing, transfer, swing_height,
//               contact_polygon, landing_region}, ...], replace}
//   goto       {x, y, yaw}
//   replace    footsteps with replace: true
//   sim.push   {link, force: [x, y, z], duration, point: [x, y, z]}
//   sim.load   {link, mass, com: [x, y, z]}
//   payload.set {link, mass, com: [x, y, z]}, payload.clear {link}, payload.estimate {link}
//   handhold.take {hand, normal: [x, y, z], friction, force}, handhold.release {hand}
//   joint.test {joint, amplitude, duration}
//   pose       {pelvis: {x, y, z, roll, pitch, yaw}, duration}
// Everything that is wrong goes to `issues`; then nothing is returned. Without a model the names of
// links are not checked and the body of a push is -1.
std::optional<Command> parse_command(std::string_view method, const NodePtr& params,
                                     const GaitdModel* model, const std::string& path,
                                     Issues* issues);

// For the server: `error` gets all errors, one per line. Absent parameters may be null or {}.
std::optional<Command> parse_command(std::string_view method, const nlohmann::json& params,
                                     const GaitdModel& model, std::string* error);

// "stand", "walk-straight", "walk-bent"; -1 for anything else.
int mode_from_name(std::string_view name);
std::string_view mode_name(int mode);

// Index of a body by name, -1 when there is none.
int body_index(const GaitdModel& model, std::string_view name);
std::vector<std::string> body_names(const GaitdModel& model);
int joint_index(const GaitdModel& model, std::string_view name);

}  // namespace gaitd::daemon

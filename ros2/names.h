// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace gaitd::ros2 {

/// A namespace as ROS 2 writes it, "/robots/one"; empty for none. Nothing if it is no valid one:
/// segments of letters, digits and underscores that do not begin with a digit.
std::optional<std::string> normalised_namespace(std::string_view text);

/// The name of a ROS topic on the wire, "rt/robots/one/odom". A `topic` that begins with a slash
/// stands in no namespace: "/tf".
std::string topic_on_wire(std::string_view name_space, std::string_view topic);

}  // namespace gaitd::ros2

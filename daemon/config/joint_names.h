// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/issues.h"
#include "daemon/config/node.h"

namespace gaitd::daemon {

// Indices of the joints among `names` that the key of `entry`, a name or a glob, stands for;
// reports when there are none.
std::vector<int> joints_like(const Node::Entry& entry, std::string_view path,
                             const std::vector<std::string>& names, Issues* issues);

}  // namespace gaitd::daemon

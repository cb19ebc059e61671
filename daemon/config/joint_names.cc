// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/joint_names.h"

#include <fnmatch.h>

namespace gaitd::daemon {

std::vector<int> joints_like(const Node::Entry& entry, std::string_view path,
                             const std::vector<std::string>& names, Issues* issues) {
  std::vector<int> result;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (fnmatch(entry.key.c_str(), names[i].c_str(), 0) == 0) {
      result.push_back(static_cast<int>(i));
    }
  }
  if (result.empty()) {
    issues->add(entry.where, path, "a joint of the URDF or a glob (l_leg_*)", entry.key,
                suggestion(entry.key, names));
  }
  return result;
}

}  // namespace gaitd::daemon

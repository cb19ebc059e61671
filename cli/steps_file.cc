// SPDX-License-Identifier: Apache-2.0
#include "cli/steps_file.h"

#include <iostream>

#include "daemon/config/command_parse.h"
#include "daemon/config/issues.h"
#include "daemon/config/node.h"

namespace gaitd::cli {

using daemon::Issues;
using daemon::NodeKind;
using daemon::NodePtr;

std::optional<nlohmann::json> read_steps(const std::string& file, bool replace,
                                         std::string* error) {
  Issues issues;
  NodePtr root;
  if (file == "-") {
    root = daemon::read_yaml(std::cin, "standard input", &issues);
  } else {
    root = daemon::load_yaml_file(file, &issues);
  }
  if (root == nullptr || !issues.ok()) {
    *error = "\n" + issues.error_text();
    return std::nullopt;
  }
  NodePtr list = root;
  if (root->kind == NodeKind::kMap) {
    const daemon::Node::Entry* entry = root->find("footsteps");
    if (entry != nullptr) list = entry->value;
    for (const daemon::Node::Entry& other : root->entries) {
      if (other.key == "footsteps") continue;
      issues.add(other.where, other.key, "the key footsteps alone", "another key", "remove it");
    }
  }
  if (list->kind != NodeKind::kList || list->items.empty()) {
    issues.add(list->where, "footsteps", "a list of footsteps {side, x, y, z, yaw, ...}",
               daemon::describe(*list), "see `gaitctl steps --help`");
  }
  // The daemon checks them as well, but does not know the lines of this file.
  if (issues.ok()) daemon::parse_command("footsteps", list, nullptr, "", &issues);
  if (!issues.ok()) {
    *error = "\n" + issues.error_text();
    return std::nullopt;
  }
  return nlohmann::json{{"footsteps", daemon::to_json(*list)}, {"replace", replace}};
}

}  // namespace gaitd::cli

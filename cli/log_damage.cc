// SPDX-License-Identifier: Apache-2.0
#include "cli/log_damage.h"

#include <iostream>

#include "cli/context.h"
#include "daemon/log/log_info.h"

namespace gaitd::cli {

int tell_damage(std::string_view command, const daemon::LogReader& log, int done) {
  const auto tell = [&](std::string_view kind, const std::string& what) {
    std::cerr << "gaitctl: " << command << ": " << log.path() << ": " << kind << what << "\n";
  };
  if (log.changed()) tell("damaged: ", "the file was changed while it was read");
  for (const std::string& finding : log.damage().findings) tell("damaged: ", finding);
  if (!log.sealed()) {
    tell("note: ",
         "written without checksums of schemas, channels and metadata: damage of those cannot be "
         "told");
  }
  return log.changed() || log.damage().any() ? kDamaged : done;
}

void add_damage(const daemon::LogReader& log, nlohmann::json* result) {
  result->update(daemon::log_damage_json(log));
}

}  // namespace gaitd::cli

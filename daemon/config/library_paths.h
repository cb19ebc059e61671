// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "daemon/config/issues.h"
#include "daemon/config/scenario.h"
#include "daemon/config/settings.h"

namespace gaitd::daemon {

// A library is code, and whoever names one makes it run. The person at the command line may, and
// the configuration that gaitd was started with; a scenario, a robot.yaml or a file that is only to
// be checked may not, unless the person says --trust.

// Where a plugin is meant, a path of a library instead of the variant of an installed one.
bool is_library_path(std::string_view variant);

// The values that hold and are such paths: of "backend" and of every "<layer>.variant".
std::vector<Settings::Entry> library_paths(const Settings& settings);

struct LibraryTrust {
  bool files = false;         // --trust: of every file
  bool configuration = true;  // the configuration is that of this gaitd, not a file to be checked
};

// Reports every path of a library that holds and that the file which names it may not name, also in
// the swaps of a scenario (null: there is none). Nothing is read of the libraries.
void check_library_paths(const Settings& settings, const Scenario* scenario,
                         const LibraryTrust& trust, Issues* issues);

}  // namespace gaitd::daemon

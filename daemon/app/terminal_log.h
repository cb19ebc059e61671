// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace gaitd::daemon {

// How the messages of gaitd look on the terminal. What they quote of files, plugins and clients
// passes daemon/config/printable.h.
void set_terminal_log_format();

// A message of a plugin; `level`: GAITD_LOG_*.
void log_plugin(int level, std::string_view plugin, std::string_view message);

}  // namespace gaitd::daemon

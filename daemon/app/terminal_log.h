// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gaitd::daemon {

// How the messages of gaitd look on the terminal. What they quote of files, plugins and clients
// passes daemon/config/printable.h.
void set_terminal_log_format();

}  // namespace gaitd::daemon

// SPDX-License-Identifier: Apache-2.0
// Without libevdev: the keyboard only.
#include "cli/teleop/pad.h"

namespace gaitd::cli::teleop {

bool has_pads() { return false; }

std::unique_ptr<Pad> open_pad(const std::string&, std::string* error) {
  *error =
      "this gaitctl was built without libevdev and knows no gamepads; use the keyboard, or build "
      "it with the Debian package libevdev-dev";
  return nullptr;
}

}  // namespace gaitd::cli::teleop

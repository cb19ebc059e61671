// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace gaitd::daemon {

// Four significant digits with the unit; "-" for what is not a number.
std::string number_text(double value, const std::string& unit);

}  // namespace gaitd::daemon

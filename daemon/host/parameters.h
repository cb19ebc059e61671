// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gaitd/abi/plugin.h"

namespace gaitd::daemon {

/// The default of every parameter, in the order of the table.
std::vector<double> default_parameters(const GaitdPluginDescriptor& descriptor);

/// Whether the value may be set: empty if so, else what is wrong with it (type, range and unit).
std::string check_parameter(const GaitdParameter& parameter, double value);

}  // namespace gaitd::daemon

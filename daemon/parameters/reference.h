// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "daemon/host/plugin_directory.h"
#include "daemon/parameters/live_parameters.h"

namespace gaitd::daemon {

/// Every parameter there is, with its default as its value: those of the daemon and of every
/// variant of every layer among `plugins`; those of refused plugins are left out.
void add_all_parameters(const std::vector<PluginEntry>& plugins, LiveParameters* all);

/// docs/parameters.md: a table for each scope and variant.
std::string parameter_reference(const LiveParameters& all);

/// The shortest text that reads back as this number.
std::string shortest(double value);
/// A value as one writes it: "true", "3", "0.6".
std::string value_text(const GaitdParameter& parameter, double value);
/// "0.2..10", "true, false".
std::string range_text(const GaitdParameter& parameter);

}  // namespace gaitd::daemon

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

// What completion offers for the values of options: names of what is installed here.
namespace gaitd::cli {

/// Of backends; only of those that simulate.
std::vector<std::string> backend_names();
std::vector<std::string> simulation_names();

/// Variants of the layer that `words` name last; of all layers if they name none.
std::vector<std::string> variant_names(const std::vector<std::string>& words);

/// Of all installed robots.
std::vector<std::string> link_names();
std::vector<std::string> joint_names();

/// Keys for --set, each with its "="; behind those that choose a variant every variant too.
std::vector<std::string> setting_names();

/// Every parameter of the daemon and of the installed plugins.
std::vector<std::string> parameter_names();

}  // namespace gaitd::cli

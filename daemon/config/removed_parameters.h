// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace gaitd::daemon {

/// What to do about a parameter that gaitd once had, "" of any other key. Of a layer the key is
/// `layer.name` or `layer/variant.name`. Begins with "was removed".
std::string removed_parameter(std::string_view key);

}  // namespace gaitd::daemon

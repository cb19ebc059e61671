// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gaitd::daemon {

// * stands for any characters, slashes too; ? for one character.
bool glob_match(std::string_view pattern, std::string_view text);

// Splits at commas; blanks around an item and empty items are dropped.
std::vector<std::string> split_globs(std::string_view globs);

}  // namespace gaitd::daemon

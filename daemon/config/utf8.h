// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace gaitd::daemon {

// Where the text stops to be UTF-8 of characters that may stand in a text file: the first byte of
// what is none, of a control character that is no tab or end of line, or of a half. npos if
// nowhere.
std::size_t find_no_text(std::string_view bytes);

}  // namespace gaitd::daemon

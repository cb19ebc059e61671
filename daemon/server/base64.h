// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace gaitd::daemon {

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);
/// What it stands for, up to the first character that is no digit of it.
std::string from_base64(std::string_view text);

}  // namespace gaitd::daemon

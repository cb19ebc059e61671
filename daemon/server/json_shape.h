// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace gaitd::daemon {

/// The deepest nesting of arrays and objects in a text, JSON or not, and how many values it has at
/// most: looked at before parsing, so that nothing deep or large is ever built.
struct JsonShape {
  int deepest = 0;
  std::size_t values = 1;
};
JsonShape json_shape(std::string_view text);

}  // namespace gaitd::daemon

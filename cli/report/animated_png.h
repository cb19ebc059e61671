// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace gaitd::cli {

/// One animated PNG (https://wiki.mozilla.org/APNG_Specification) of PNG files of the same size and
/// kind, shown for ever at `rate` (frames per second). Programs that know plain PNG only show the
/// first. Empty if one of them is no PNG or differs from the first.
std::string animated_png(const std::vector<std::string>& frames, int rate);

}  // namespace gaitd::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace gaitd::cli {

/// The robot and each plot of a report page as PNG files in a folder, which is made if it is not
/// there. One run of chromium draws all of them. Empty, or the reason why not.
std::string draw_pictures(const std::filesystem::path& page, const std::filesystem::path& folder);

/// The robot of a report page as it moves from one time to another (s, of the log), in an animated
/// PNG file. Empty, or the reason why not.
std::string draw_film(const std::filesystem::path& page, const std::filesystem::path& file,
                      double from, double to);

}  // namespace gaitd::cli

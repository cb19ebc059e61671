// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace gaitd::cli {

/// All bytes of a file; none when it cannot be read.
std::string read_file(const std::filesystem::path& file);

/// Writes all of a file, in place of what was there; false with why not in `error`.
bool write_file(const std::filesystem::path& file, const std::string& text, std::string* error);

/// The same by way of a file beside it: what was there stays when the disk is full, and when the
/// machine goes down.
bool replace_file(const std::filesystem::path& file, const std::string& text, std::string* error);

}  // namespace gaitd::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace gaitd::cli {

/// Rows under a header, columns as wide as they need, no trailing blanks. Rows may be short. Where
/// that is wider than `columns`, the widest columns give way and their cells go on below, broken
/// between words. Where that does not do, what does not fit stands below each row, every cell
/// behind the name of its column. 0: no limit.
std::string table(const std::vector<std::string>& header,
                  const std::vector<std::vector<std::string>>& rows, std::size_t columns);

/// The same, as wide as the terminal of standard output, if it is one.
std::string table(const std::vector<std::string>& header,
                  const std::vector<std::vector<std::string>>& rows);

/// `text` in lines of at most `columns`, broken at blanks; a longer word has a line of its own.
std::vector<std::string> wrapped(const std::string& text, std::size_t columns);

/// Lines that are longer than `columns` go on below, two further in than they begin, or where the
/// second column of theirs begins, broken at blanks; a longer word stays whole, so that it can be
/// copied. 0: no limit.
std::string folded(const std::string& text, std::size_t columns);

/// Characters of UTF-8: µ is one wide.
std::size_t width_of(const std::string& text);

}  // namespace gaitd::cli

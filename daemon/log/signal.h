// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gaitd::daemon {

// One column of the log. The values of a tick are one flat array of doubles in the order of the
// table; how each double is stored follows from its kind.
struct SignalDescription {
  enum class Kind {
    kReal,         // stored as it is, every bit
    kInteger,      // stored as int64; what does not fit (NaN, infinity) reads back as NaN
    kBoolean,      // 0 or 1; anything but 0 is 1
    kEnumeration,  // index into `words`; any other value reads back as NaN
  };

  std::string name;  // slash path, e.g. "joint/l_leg_kny/position"
  std::string unit;  // "" where there is none
  Kind kind = Kind::kReal;
  std::vector<std::string> words;  // of an enumeration, in the order of its values from 0

  bool operator==(const SignalDescription&) const = default;
};

using SignalTable = std::vector<SignalDescription>;

inline constexpr std::size_t kMaxSignals = 10000;
inline constexpr std::size_t kMaxSignalDepth = 12;  // segments of a path
inline constexpr std::size_t kMaxWords = 127;       // of an enumeration: one byte on the wire

// All that is wrong with a table, one line each; empty if it can be logged: names unique and
// without empty segments, enumerations with 1 to 127 words, sizes within the limits above.
std::string validate_signal_table(const SignalTable& table);

// The table as it stands in a log file.
std::string signal_table_to_json(const SignalTable& table);

// Reads and validates. False with `error` set if the text is not a table.
bool signal_table_from_json(std::string_view text, SignalTable* table, std::string* error);

// Position of the signal in the table, -1 if there is none of that name.
int find_signal(const SignalTable& table, std::string_view name);

// Value of the word of an enumeration, -1 if it has no such word.
int find_word(const SignalDescription& signal, std::string_view word);

}  // namespace gaitd::daemon

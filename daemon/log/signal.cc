// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/signal.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

namespace gaitd::daemon {

namespace {

using Kind = SignalDescription::Kind;

constexpr std::array<const char*, 4> kKindNames = {"real", "integer", "boolean", "enumeration"};
constexpr std::size_t kMaxNameSize = 200;

std::string validate_name(const std::string& name) {
  if (name.empty()) return "empty name";
  if (name.size() > kMaxNameSize) return "name longer than 200 bytes";
  if (name.front() == '/' || name.back() == '/' || name.find("//") != std::string::npos) {
    return "empty segment in the path";
  }
  const auto depth = static_cast<std::size_t>(std::count(name.begin(), name.end(), '/')) + 1;
  if (depth > kMaxSignalDepth) return "path deeper than 12 segments";
  const bool printable = std::all_of(
      name.begin(), name.end(), [](char c) { return c > ' ' && c < 127 && c != ',' && c != '"'; });
  return printable ? "" : "expected printable ASCII without blanks, commas and quotes";
}

std::string validate_words(const SignalDescription& signal) {
  if (signal.kind != Kind::kEnumeration) {
    return signal.words.empty() ? "" : "words on a signal that is no enumeration";
  }
  if (signal.words.empty() || signal.words.size() > kMaxWords) {
    return "expected 1 to 127 words, got " + std::to_string(signal.words.size());
  }
  std::set<std::string> seen;
  for (const std::string& word : signal.words) {
    const bool plain = !word.empty() && word.size() <= kMaxNameSize &&
                       std::all_of(word.begin(), word.end(), [](char c) {
                         return c >= ' ' && c < 127 && c != ',' && c != '"';
                       });
    if (!plain) return "word '" + word + "': expected ASCII without commas and quotes";
    if (!seen.insert(word).second) return "word '" + word + "' twice";
  }
  return "";
}

}  // namespace

std::string validate_signal_table(const SignalTable& table) {
  std::string errors;
  if (table.empty()) errors += "signal table: no signal\n";
  if (table.size() > kMaxSignals) errors += "signal table: more than 10000 signals\n";
  std::set<std::string> names;
  for (const SignalDescription& signal : table) {
    for (const std::string& error : {validate_name(signal.name), validate_words(signal)}) {
      if (!error.empty()) errors += "signal '" + signal.name + "': " + error + "\n";
    }
    if (!names.insert(signal.name).second) errors += "signal '" + signal.name + "': name twice\n";
  }
  return errors;
}

std::string signal_table_to_json(const SignalTable& table) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SignalDescription& signal : table) {
    nlohmann::ordered_json entry;
    entry["name"] = signal.name;
    entry["kind"] = kKindNames[static_cast<std::size_t>(signal.kind)];
    if (!signal.unit.empty()) entry["unit"] = signal.unit;
    if (!signal.words.empty()) entry["words"] = signal.words;
    list.push_back(std::move(entry));
  }
  return list.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

bool signal_table_from_json(std::string_view text, SignalTable* table, std::string* error) {
  table->clear();
  try {
    const nlohmann::json list = nlohmann::json::parse(text);
    if (!list.is_array()) throw std::runtime_error("expected a list");
    for (const nlohmann::json& entry : list) {
      SignalDescription signal;
      signal.name = entry.at("name").get<std::string>();
      signal.unit = entry.value("unit", std::string());
      signal.words = entry.value("words", std::vector<std::string>());
      const auto kind = entry.at("kind").get<std::string>();
      const auto* found = std::find(kKindNames.begin(), kKindNames.end(), kind);
      if (found == kKindNames.end()) throw std::runtime_error("unknown kind '" + kind + "'");
      signal.kind = static_cast<Kind>(found - kKindNames.begin());
      table->push_back(std::move(signal));
    }
  } catch (const std::exception& exception) {
    *error = std::string("signal table: ") + exception.what();
    return false;
  }
  *error = validate_signal_table(*table);
  return error->empty();
}

int find_signal(const SignalTable& table, std::string_view name) {
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

int find_word(const SignalDescription& signal, std::string_view word) {
  const auto found = std::find(signal.words.begin(), signal.words.end(), word);
  return found == signal.words.end() ? -1 : static_cast<int>(found - signal.words.begin());
}

}  // namespace gaitd::daemon

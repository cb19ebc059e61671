// SPDX-License-Identifier: Apache-2.0
#include "cli/print.h"

#include <algorithm>
#include <cstdio>

#include "cli/param_view.h"
#include "cli/status_view.h"
#include "cli/table.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

// A scalar as a person writes it; lists joined; anything deeper as JSON.
std::string plain(const json& value) {
  if (value.is_string()) {
    const auto text = value.get<std::string>();
    return text.empty() ? "-" : text;
  }
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_null()) return "-";
  if (value.is_number_float()) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.5g", value.get<double>());
    return text;
  }
  if (value.is_array() &&
      std::none_of(value.begin(), value.end(), [](const json& v) { return v.is_structured(); })) {
    std::string out;
    for (const json& one : value) out += (out.empty() ? "" : ", ") + plain(one);
    return out.empty() ? "none" : out;
  }
  if (value.is_object()) {
    std::string out;
    for (const auto& [key, member] : value.items()) {
      const bool nested = member.is_object();
      out += out.empty() ? "" : (nested ? "; " : ", ");
      out += key + (nested ? ": " : " ") + plain(member);
    }
    return out;
  }
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

bool is_list_of_objects(const json& value) {
  return value.is_array() && !value.empty() &&
         std::all_of(value.begin(), value.end(), [](const json& v) { return v.is_object(); });
}

// A list of objects as a table, the columns in the order they first appear.
std::string object_table(const json& list) {
  std::vector<std::string> header;
  for (const json& row : list) {
    for (const auto& [key, unused] : row.items()) {
      if (std::find(header.begin(), header.end(), key) == header.end()) header.push_back(key);
    }
  }
  // What names a row goes first; JSON objects come sorted by key.
  for (const char* first : {"variant", "layer", "name"}) {
    const auto found = std::find(header.begin(), header.end(), first);
    if (found != header.end()) std::rotate(header.begin(), found, found + 1);
  }
  std::vector<std::vector<std::string>> rows;
  for (const json& row : list) {
    std::vector<std::string> cells;
    cells.reserve(header.size());
    for (const std::string& key : header) {
      cells.push_back(row.contains(key) ? plain(row[key]) : "");
    }
    rows.push_back(std::move(cells));
  }
  return table(header, rows);
}

// Scalars as aligned lines, known ones first; then lists of objects as tables.
std::string object_text(const json& object, const std::vector<std::string>& first) {
  std::vector<std::string> keys;
  for (const std::string& key : first) {
    if (object.contains(key)) keys.push_back(key);
  }
  for (const auto& [key, unused] : object.items()) {
    if (std::find(first.begin(), first.end(), key) == first.end()) keys.push_back(key);
  }
  std::size_t widest = 0;
  for (const std::string& key : keys) {
    if (!is_list_of_objects(object[key])) widest = std::max(widest, width_of(key));
  }
  std::string lines;
  std::string tables;
  for (const std::string& key : keys) {
    const json& value = object[key];
    if (is_list_of_objects(value)) {
      tables += "\n" + key + "\n" + object_table(value);
    } else {
      lines += key + std::string(widest + 2 - width_of(key), ' ') + plain(value) + "\n";
    }
  }
  return lines + tables;
}

std::string plugin_list_text(const json& result) {
  const json plugins = result.value("plugins", json::array());
  std::vector<std::vector<std::string>> rows;
  std::string refused;
  for (const json& plugin : plugins) {
    const auto get = [&](const char* key) {
      return plugin.contains(key) ? plain(plugin[key]) : "";
    };
    if (plugin.contains("refused")) {
      refused += '\n' + get("refused") + '\n';
      continue;
    }
    const std::string active = plugin.value("active", false) ? "*" : "";
    rows.push_back(
        {active, get("layer"), get("variant"), get("version"), get("worst_case_us"), get("path")});
  }
  return table({"", "layer", "variant", "version", "worst case µs", "file"}, rows) + "* in use\n" +
         refused;
}

}  // namespace

std::string result_text(const std::string& command, const std::string& method, const json& result) {
  if (!result.is_object()) return plain(result) + "\n";
  if (std::string text = param_text(method, result); !text.empty()) return text;
  if (method == "plugin.list") return plugin_list_text(result);
  if (result.value("accepted", json()) == true && result.contains("tick")) {
    const json note = result.value("note", json());
    const json socket = result.value("socket", json());
    return command + ": accepted at tick " + plain(result["tick"]) +
           (socket.is_string() ? " by " + socket.get<std::string>() : "") +
           (note.is_string() ? "; " + note.get<std::string>() : "") + "\n";
  }
  json shown = result;
  if (shown.contains("payload")) {
    json& payload = shown["payload"];
    const bool weighs = payload.is_object() && payload.value("estimating", json()) == true;
    payload = payload_text(payload) + (weighs ? ", being weighed" : "");
  }
  if (shown.contains("state")) shown["state"] = state_text(shown);
  if (shown.contains("handholds")) shown["handholds"] = handholds_text(shown["handholds"]);
  return object_text(shown, {"state", "mode", "phase", "support", "step_index", "time", "faults",
                             "robot", "backend", "clock", "log"});
}

std::string json_text(const json& value) {
  return value.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace gaitd::cli

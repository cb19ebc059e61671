// SPDX-License-Identifier: Apache-2.0
#include "cli/param_view.h"

#include <vector>

#include "cli/print.h"
#include "cli/table.h"
#include "daemon/parameters/reference.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

std::string text(const json& object, const char* key) {
  const json value = object.value(key, json());
  if (value.is_number()) return daemon::shortest(value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  return value.is_null() ? "" : value.dump();
}

std::string with_unit(const std::string& value, const json& object) {
  const std::string unit = text(object, "unit");
  return unit.empty() ? value : value + " " + unit;
}

std::string range(const json& p) {
  if (text(p, "type") == "boolean") return "true, false";
  return text(p, "min") + ".." + text(p, "max");
}

std::string list_text(const json& result) {
  std::vector<std::vector<std::string>> rows;
  bool changed = false;
  for (const json& p : result.value("parameters", json::array())) {
    const bool differs = p.value("value", json()) != p.value("default", json());
    changed |= differs;
    rows.push_back({text(p, "name"), text(p, "value") + (differs ? " *" : ""), text(p, "unit"),
                    range(p), text(p, "default"), text(p, "rank"), text(p, "description")});
  }
  return table({"parameter", "value", "unit", "range", "default", "rank", ""}, rows) +
         (changed ? "* not the default\n" : "");
}

std::string get_text(const json& p) {
  return text(p, "name") + "  " + with_unit(text(p, "value"), p) + "\n  " + text(p, "description") +
         "\n  range    " + with_unit(range(p), p) + "\n  default  " +
         with_unit(text(p, "default"), p) + "\n  rank     " + text(p, "rank") + "\n  effect   " +
         text(p, "effect") + "\n";
}

std::string set_text(const json& r) {
  const std::string note = text(r, "note");
  return text(r, "name") + ": " + text(r, "old") + " -> " + with_unit(text(r, "value"), r) +
         " at tick " + text(r, "tick") + (note.empty() ? "" : "; " + note) + "\n";
}

}  // namespace

std::string param_text(const std::string& method, const json& result) {
  if (method == "param.list") return list_text(result);
  if (method == "param.get") return get_text(result);
  if (method == "param.set") return set_text(result);
  return "";
}

}  // namespace gaitd::cli

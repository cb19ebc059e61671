// SPDX-License-Identifier: Apache-2.0
#include "daemon/parameters/live_parameters.h"

#include <algorithm>
#include <cstring>

#include "daemon/config/node.h"
#include "daemon/config/removed_parameters.h"
#include "daemon/config/settings.h"
#include "daemon/host/plugin_json.h"
#include "daemon/log/glob.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;

constexpr const char* kRestart =
    "needs a restart: set it in gaitd.yaml or with --set and start gaitd again";

json effect_json(const ParameterEffect& effect) {
  switch (effect.kind) {
    case ParameterEffect::kAtRest:
      return "at rest";
    case ParameterEffect::kLater:
      return effect.text;
    case ParameterEffect::kBounded:
      return bounded_text(effect);
    default:
      return "at once";
  }
}

// "scope/variant.name" as "scope.name", and the variant.
std::string without_variant(std::string_view key, std::string* variant) {
  const std::size_t slash = key.find('/');
  const std::size_t dot = key.find('.', slash == std::string_view::npos ? 0 : slash);
  if (slash == std::string_view::npos || dot == std::string_view::npos) return std::string(key);
  if (dot == slash + 1) return "";  // an empty variant names nothing
  *variant = key.substr(slash + 1, dot - slash - 1);
  return std::string(key.substr(0, slash)) + std::string(key.substr(dot));
}

}  // namespace

LiveParameters::LiveParameters() : values_(std::make_unique<std::atomic<double>[]>(kCapacity)) {
  rows_.reserve(kCapacity);
  for (std::atomic<int>& table : tables_in_use_) table = -1;
}

int LiveParameters::add(int owner, std::string_view scope, std::string_view variant,
                        std::span<const GaitdParameter> table, const std::vector<double>& values) {
  if (rows_.size() + table.size() > kCapacity) return -1;
  const int number = tables_++;
  for (std::size_t i = 0; i < table.size(); ++i) {
    Row row{.key = std::string(scope) + "." + table[i].name,
            .variant = std::string(variant),
            .declared = table[i],
            .owner = owner,
            .index = static_cast<int>(i),
            .table = number,
            .effect = {}};
    row.effect = parameter_effect(row.key);
    values_[rows_.size()] = values[i];
    rows_.push_back(std::move(row));
  }
  size_.store(static_cast<int>(rows_.size()), std::memory_order_release);
  if (table_in_use(owner) < 0) use(owner, number);
  return number;
}

int LiveParameters::find_table(int owner, std::string_view variant,
                               std::span<const GaitdParameter> table) const {
  if (table.empty()) return -1;
  for (int i = 0; i + static_cast<int>(table.size()) <= size(); ++i) {
    if (rows_[i].owner != owner || rows_[i].index != 0 || rows_[i].variant != variant) continue;
    std::size_t same = 0;
    while (same < table.size() && rows_[i + same].table == rows_[i].table &&
           std::memcmp(&rows_[i + same].declared, &table[same], sizeof(GaitdParameter)) == 0) {
      ++same;
    }
    const std::size_t end = i + same;
    const bool ends = static_cast<int>(end) == size() || rows_[end].table != rows_[i].table;
    if (same == table.size() && ends) return rows_[i].table;
  }
  return -1;
}

int LiveParameters::find_row(int owner, int index) const {
  for (int i = 0; i < size(); ++i) {
    if (rows_[i].owner == owner && rows_[i].index == index && in_use(rows_[i])) return i;
  }
  return -1;
}

std::vector<double> LiveParameters::values(int table) const {
  std::vector<double> out;
  for (int i = 0; i < size(); ++i) {
    if (rows_[i].table == table) out.push_back(value(i));
  }
  return out;
}

int LiveParameters::find(std::string_view key, std::string* error) const {
  std::string variant;
  const std::string plain = without_variant(key, &variant);
  for (int i = 0; i < size(); ++i) {
    const Row& r = rows_[i];
    if (r.key == plain && in_use(r) && (variant.empty() || variant == r.variant)) return i;
  }
  const std::string name(key.substr(0, 200));
  std::vector<std::string> names;
  for (int i = 0; i < size(); ++i) {
    const Row& r = rows_[i];
    if (!in_use(r)) continue;
    if (!variant.empty() && r.key.substr(0, r.key.find('.')) == plain.substr(0, plain.find('.')) &&
        r.variant != variant) {
      *error = name + ": " + variant + " is not in use, " + r.variant + " is; it " + kRestart;
      return -1;
    }
    names.push_back(r.key);
  }
  if (std::find(restart_keys_.begin(), restart_keys_.end(), key) != restart_keys_.end()) {
    *error = name + ": cannot be changed while gaitd runs; it " + kRestart;
    return -1;
  }
  if (const std::string removed = removed_parameter(name); !removed.empty()) {
    *error = name + ": " + removed;
    return -1;
  }
  *error = name + ": no such parameter; ";
  const std::string closest = closest_name(name, names);
  if (!closest.empty()) {
    *error += "did you mean '" + closest + "'?";
    return -1;
  }
  // Those of its scope, or those of the same name in another.
  const std::string scope = name.substr(0, name.find('.') + 1);
  const std::string last = name.substr(name.rfind('.') + 1);
  std::vector<std::string> near;
  for (const std::string& n : names) {
    if ((!scope.empty() && n.starts_with(scope)) || n.ends_with("." + last)) near.push_back(n);
  }
  *error += near.empty() ? "`gaitctl param list` shows all" : suggestion(name, near);
  return -1;
}

std::optional<Command> LiveParameters::parse_set(const json& params, std::string* error) const {
  const auto name = params.is_object() ? params.find("name") : params.end();
  const auto value = params.is_object() ? params.find("value") : params.end();
  if (!params.is_object() || params.size() != 2 || name == params.end() || !name->is_string() ||
      value == params.end()) {
    *error = R"(expected {"name": a parameter, "value": a number, true or false})";
    return std::nullopt;
  }
  Command command{};
  command.type = CommandType::kSetParameter;
  command.parameter_index = find(name->get<std::string>(), error);
  if (command.parameter_index < 0) return std::nullopt;
  const Row& row = rows_[command.parameter_index];
  const NodePtr node = from_json(*value, {});
  const std::string wrong = read_parameter(row.declared, *node, &command.parameter_value);
  if (wrong.empty()) return command;
  *error = row.key + ": " + wrong + "; nothing was changed";
  return std::nullopt;
}

std::vector<int> LiveParameters::match(std::string_view glob) const {
  std::vector<int> result;
  for (int i = 0; i < size(); ++i) {
    if (!in_use(rows_[i])) continue;
    const std::string& key = rows_[i].key;
    if (glob.empty() || glob_match(glob, key) || glob == key.substr(0, key.find('.'))) {
      result.push_back(i);
    }
  }
  return result;
}

json LiveParameters::describe(int index) const {
  const Row& r = rows_[index];
  json out = parameter_json(r.declared);
  out["name"] = r.key;
  out["variant"] = r.variant.empty() ? json() : json(r.variant);
  out["default"] = parameter_value(r.declared, r.declared.default_value);
  out["value"] = parameter_value(r.declared, value(index));
  out["effect"] = effect_json(r.effect);
  return out;
}

json parameter_value(const GaitdParameter& parameter, double value) {
  if (parameter.type == GAITD_PARAMETER_BOOLEAN) return value != 0.0;
  if (parameter.type == GAITD_PARAMETER_INTEGER) return static_cast<std::int64_t>(value);
  return value;
}

}  // namespace gaitd::daemon

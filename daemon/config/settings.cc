// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/settings.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "daemon/config/removed_parameters.h"
#include "daemon/config/yaml_reader.h"
#include "gaitd/sdk/bounds.h"

namespace gaitd::daemon {
namespace {

NodePtr at_location(const Node& node, const Location& where) {
  auto copy = std::make_shared<Node>(node);
  copy->where = where;
  for (NodePtr& item : copy->items) item = at_location(*item, where);
  for (Node::Entry& entry : copy->entries) {
    entry.where = where;
    entry.value = at_location(*entry.value, where);
  }
  return copy;
}

bool is_key(std::string_view key) {
  if (key.empty()) return false;
  return std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '-' || c == '/';
  });
}

std::string expected_value(const GaitdParameter& parameter) {
  if (parameter.type == GAITD_PARAMETER_BOOLEAN) return "true or false";
  const std::string kind =
      parameter.type == GAITD_PARAMETER_INTEGER ? "a whole number" : "a number";
  const std::string range = Bounds{parameter.minimum, parameter.maximum, parameter.unit}.text();
  return range.empty() ? kind : kind + " " + range;
}

// "scope/variant" of "scope/variant.name", "" when the key is of no variant.
std::string variant_of(std::string_view key) {
  const std::size_t slash = key.find('/');
  const std::size_t dot = key.find('.', slash == std::string_view::npos ? 0 : slash);
  if (slash == std::string_view::npos || dot == std::string_view::npos) return "";
  return std::string(key.substr(0, dot));
}

}  // namespace

void Settings::set(SettingSource source, std::string key, NodePtr value) {
  values_[std::move(key)][source] = std::move(value);
}

bool Settings::set_assignment(std::string_view assignment, Issues* issues) {
  const Location where{"--set " + std::string(assignment), 0};
  const std::size_t equals = assignment.find('=');
  const std::string key(assignment.substr(0, equals));
  if (equals == std::string_view::npos || !is_key(key)) {
    issues->add(where, "", "KEY=VALUE", describe(*make_scalar(std::string(assignment), where)),
                "write for example gait.swing_duration=0.7");
    return false;
  }
  Issues found;
  const NodePtr value = parse_yaml(assignment.substr(equals + 1), key, &found);
  if (!value || !found.ok()) {
    issues->add(where, key, "a value", found.all().empty() ? "nothing" : found.all()[0].message,
                "write a number, a word, [a list] or {a: map}");
    return false;
  }
  set_leaves(SettingSource::kCommandLine, key, at_location(*value, where), issues);
  return true;
}

void Settings::set_tree(SettingSource source, const Node& map, Issues* issues) {
  for (const Node::Entry& entry : map.entries) {
    set_leaves(source, entry.key, entry.value, issues);
  }
}

void Settings::set_leaves(SettingSource source, const std::string& key, const NodePtr& value,
                          Issues* issues) {
  if (value->kind == NodeKind::kMap) {
    for (const Node::Entry& entry : value->entries) {
      set_leaves(source, key + "." + entry.key, entry.value, issues);
    }
    return;
  }
  if (value->kind == NodeKind::kNull) {
    issues->add(value->where, key, "a value", "nothing", "write one or remove the key");
    return;
  }
  const bool room = values_.size() < bounds::kSettings || values_.contains(key);
  if (key.size() > bounds::kYamlKey || !room) {
    // Once is enough.
    if (std::exchange(full_, true)) return;
    issues->add_text(value->where, key.substr(0, bounds::kYamlKey),
                     "expected at most " + std::to_string(bounds::kSettings) +
                         " settings with keys of at most " + std::to_string(bounds::kYamlKey) +
                         " characters, got more; remove what is none");
    return;
  }
  set(source, key, value);
}

NodePtr Settings::find(std::string_view key) {
  declare(std::string(key));
  return peek(key);
}

NodePtr Settings::peek(std::string_view key) const {
  const auto found = values_.find(key);
  return found == values_.end() ? nullptr : found->second.rbegin()->second;
}

std::vector<double> Settings::resolve(std::string_view scope, std::span<const GaitdParameter> table,
                                      Issues* issues, std::string_view variant) {
  if (!variant.empty()) declare_variant(scope, variant);
  std::vector<double> result;
  result.reserve(table.size());
  for (const GaitdParameter& parameter : table) {
    std::string key = std::string(scope) + "." + parameter.name;
    declare(key);
    auto found = values_.find(key);
    if (!variant.empty()) {
      const std::string special =
          std::string(scope) + "/" + std::string(variant) + "." + parameter.name;
      declare(special);
      const auto other = values_.find(special);
      if (other != values_.end() && (found == values_.end() || other->second.rbegin()->first >=
                                                                   found->second.rbegin()->first)) {
        found = other;
        key = special;
      }
    }
    double value = parameter.default_value;
    if (found != values_.end()) {
      const Node& node = *found->second.rbegin()->second;
      const std::string problem = read_parameter(parameter, node, &value);
      if (!problem.empty()) {
        issues->add_text(node.where, key, problem + "; write such a value or remove the key");
      }
    }
    result.push_back(value);
  }
  if (!variant.empty()) selected_.insert(std::string(scope) + "/" + std::string(variant));
  return result;
}

NodePtr Settings::subtree(std::string_view scope) {
  auto empty = std::make_shared<Node>();
  empty->kind = NodeKind::kMap;
  NodePtr map = empty;
  const std::string prefix = std::string(scope) + ".";
  for (const auto& [key, sources] : values_) {
    if (!key.starts_with(prefix)) continue;
    declare(key);
    map = with_value(map, std::string_view(key).substr(prefix.size()), sources.rbegin()->second);
  }
  return map;
}

void Settings::declare(std::string key) { known_.insert(std::move(key)); }

void Settings::reserve(std::string key) { reserved_.insert(std::move(key)); }

void Settings::declare_variant(std::string_view scope, std::string_view variant) {
  variants_.insert(std::string(scope) + "/" + std::string(variant));
}

void Settings::report_unknown(Issues* issues) const {
  const std::vector<std::string> known(known_.begin(), known_.end());
  const std::vector<std::string> variants(variants_.begin(), variants_.end());
  constexpr int kMaxSuggestions = 20;  // they take time, and nobody reads thousands
  int unknown = 0;
  for (const auto& [key, sources] : values_) {
    for (const auto& [source, value] : sources) {
      const bool own = source == SettingSource::kConfig || source == SettingSource::kCommandLine;
      if (own || !reserved_.contains(key)) continue;
      issues->add_text(value->where, key,
                       "only gaitd.yaml and the command line may set this key; remove it here");
    }
    if (known_.contains(key)) continue;
    const std::string variant = variant_of(key);
    // Of a variant that is there and not selected: it waits for being selected.
    if (variants_.contains(variant) && !selected_.contains(variant)) continue;
    if (++unknown > kMaxSuggestions) {
      for (const auto& [source, value] : sources)
        issues->add_text(value->where, key, "unknown key");
      continue;
    }
    const std::string removed = removed_parameter(key);
    const bool strange = !variant.empty() && !variants_.contains(variant);
    const std::string advice = !removed.empty() ? removed
                               : strange ? "no such variant; " + suggestion(variant, variants)
                                         : "unknown key; " + nearest_known(key, known);
    for (const auto& [source, value] : sources) issues->add_text(value->where, key, advice);
  }
}

std::string Settings::nearest_known(const std::string& key,
                                    const std::vector<std::string>& known) const {
  const std::string closest = closest_name(key, known);
  if (!closest.empty()) return "did you mean '" + closest + "'?";
  const std::size_t dot = key.rfind('.');
  const std::string prefix = key.substr(0, dot) + ".";
  std::vector<std::string> same_scope;
  for (const std::string& candidate : known) {
    if (candidate.starts_with(prefix)) same_scope.push_back(candidate.substr(prefix.size()));
  }
  if (!same_scope.empty()) {
    return suggestion(dot == std::string::npos ? "" : key.substr(dot + 1), same_scope);
  }
  std::set<std::string> scopes;
  for (const std::string& candidate : known)
    scopes.insert(candidate.substr(0, candidate.find('.')));
  return "its first word is none of those that are known; " +
         suggestion(key.substr(0, key.find('.')), {scopes.begin(), scopes.end()});
}

std::vector<std::string> Settings::known_keys() const { return {known_.begin(), known_.end()}; }

std::vector<Settings::Entry> Settings::effective() const {
  std::vector<Entry> result;
  for (const auto& [key, sources] : values_) {
    result.push_back({key, sources.rbegin()->second, sources.rbegin()->first});
  }
  return result;
}

std::vector<Settings::Entry> Settings::from(SettingSource source, std::string_view prefix) const {
  std::vector<Entry> result;
  for (const auto& [key, sources] : values_) {
    const auto found = sources.find(source);
    if (found != sources.end() && key.starts_with(prefix)) {
      result.push_back({key, found->second, source});
    }
  }
  return result;
}

std::string read_parameter(const GaitdParameter& parameter, const Node& node, double* result) {
  std::optional<double> value = as_number(node);
  if (parameter.type == GAITD_PARAMETER_BOOLEAN) {
    if (const auto boolean = as_boolean(node)) value = *boolean ? 1.0 : 0.0;
    if (value && *value != 0.0 && *value != 1.0) value.reset();
  } else if (parameter.type == GAITD_PARAMETER_INTEGER) {
    if (value && std::nearbyint(*value) != *value) value.reset();
  }
  if (value && *value >= parameter.minimum && *value <= parameter.maximum) {
    *result = *value;
    return "";
  }
  return "expected " + expected_value(parameter) + ", got " + describe(node);
}

}  // namespace gaitd::daemon

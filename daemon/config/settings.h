// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/node.h"
#include "gaitd/abi/plugin.h"

namespace gaitd::daemon {

// Who wrote a value: the later one wins.
enum class SettingSource { kRobot, kProfile, kConfig, kScenario, kCommandLine };

// Every configured value under its key, "scope.name" (gait.swing_duration, step_adjuster.variant,
// realtime.priority, seed), as an overlay of sources. A key "layer/variant.name" holds only while
// that variant is selected. What a key means is known to those who ask for it; what nobody asked
// for is reported in the end.
class Settings {
 public:
  struct Entry {
    std::string key;
    NodePtr value;
    SettingSource source;
  };

  void set(SettingSource source, std::string key, NodePtr value);
  // The argument of --set: KEY=VALUE, the value in YAML. False and an issue when it is not.
  bool set_assignment(std::string_view assignment, Issues* issues);
  // Every leaf of a map under its dotted path. A list is one leaf. A key may hold dots itself.
  void set_tree(SettingSource source, const Node& map, Issues* issues);

  // The value that holds, null when nobody set it. Marks the key as known.
  NodePtr find(std::string_view key);
  // The same without marking.
  NodePtr peek(std::string_view key) const;

  // One value per row of the table, in its order: the configured one or the default. Reports values
  // of a wrong type or out of range with the place they came from; those take the default. With a
  // variant, "scope/variant.name" holds over "scope.name" of the same or an earlier source.
  std::vector<double> resolve(std::string_view scope, std::span<const GaitdParameter> table,
                              Issues* issues, std::string_view variant = "");

  // Everything under "scope." as one map, for a backend that checks its configuration itself; marks
  // all of it as known. An empty map when nothing is set.
  NodePtr subtree(std::string_view scope);

  // Makes keys known that no table declares, for keys that are read elsewhere or later.
  void declare(std::string key);
  // Says that only the configuration of gaitd and its command line may set this key, for what no
  // robot.yaml and no scenario may decide. report_unknown reports the others.
  void reserve(std::string key);
  // Says that there is such a variant: its "scope/variant.name" are then acceptable although it is
  // not selected. To be called for every variant that is installed.
  void declare_variant(std::string_view scope, std::string_view variant);

  // Reports every key that is set and that nobody knows, with its place and the nearest known key,
  // and every reserved one that somebody else has set.
  void report_unknown(Issues* issues) const;

  // Every key that was found, resolved or declared.
  std::vector<std::string> known_keys() const;

  // Keys and values that hold, in the order of the keys: for the log.
  std::vector<Entry> effective() const;
  // Entries of one source whose key starts with the prefix.
  std::vector<Entry> from(SettingSource source, std::string_view prefix = "") const;

 private:
  using Sources = std::map<SettingSource, NodePtr>;

  void set_leaves(SettingSource source, const std::string& key, const NodePtr& value,
                  Issues* issues);
  std::string nearest_known(const std::string& key, const std::vector<std::string>& known) const;

  std::map<std::string, Sources, std::less<>> values_;
  std::set<std::string, std::less<>> known_;
  std::set<std::string, std::less<>> reserved_;
  std::set<std::string, std::less<>> variants_;  // "scope/variant"
  std::set<std::string, std::less<>> selected_;  // those that were resolved
  bool full_ = false;                            // that has been said
};

// Reads a value as its declaration wants it (booleans as 0 and 1). Returns "" and sets `result`, or
// "expected ..., got ...".
std::string read_parameter(const GaitdParameter& parameter, const Node& value, double* result);

}  // namespace gaitd::daemon

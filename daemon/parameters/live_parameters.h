// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/command/command.h"
#include "daemon/parameters/scopes.h"

namespace gaitd::daemon {

/// Every parameter that can be changed while gaitd runs: those of the layers in use and of the
/// scopes of the daemon, under their keys of the configuration. Filled once before the control
/// thread starts; after that only the values change. They are kept in memory, never on disk.
class LiveParameters {
 public:
  struct Row {
    std::string key;      ///< scope.name
    std::string variant;  ///< of a layer, else ""
    GaitdParameter declared;
    int owner;  ///< GAITD_LAYER_* or ParameterOwner
    int index;  ///< in the table of its owner
    ParameterEffect effect;
  };

  /// Appends a table with one value for each row. `variant` is "" for the scopes of the daemon.
  void add(int owner, std::string_view scope, std::string_view variant,
           std::span<const GaitdParameter> table, const std::vector<double>& values);
  /// Configuration keys beyond these: a change of one is refused with "needs a restart".
  void set_restart_keys(std::vector<std::string> keys) { restart_keys_ = std::move(keys); }

  int size() const { return static_cast<int>(rows_.size()); }
  const Row& row(int index) const { return rows_[index]; }

  // ---- Any thread.
  double value(int index) const { return values_[index].load(std::memory_order_relaxed); }
  // ---- Control thread. [rt]
  void store(int index, double value) { values_[index].store(value, std::memory_order_relaxed); }

  // ---- Server thread.

  /// Row of a key, `scope.name` or `scope/variant.name`. -1 with what is wrong in `error`: the
  /// nearest names, or that it needs a restart.
  int find(std::string_view key, std::string* error) const;
  /// {"name": key, "value": number or boolean} as a command. Nothing with what is wrong in `error`
  /// (what was expected, with range and unit).
  std::optional<Command> parse_set(const nlohmann::json& params, std::string* error) const;
  /// Rows that a glob takes in, or a scope without its parameters (`gait`); all for "".
  std::vector<int> match(std::string_view glob) const;
  /// {name, variant, type, unit, min, max, default, value, effect, description}.
  nlohmann::json describe(int index) const;

 private:
  std::deque<Row> rows_;
  std::deque<std::atomic<double>> values_;
  std::vector<std::string> restart_keys_;
};

/// A value as its type wants it in JSON: true, 3 or 0.5.
nlohmann::json parameter_value(const GaitdParameter& parameter, double value);

}  // namespace gaitd::daemon

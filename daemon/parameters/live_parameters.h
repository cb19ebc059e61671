// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <memory>
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
/// scopes of the daemon, under their keys of the configuration. A layer has one table for each
/// variant that was ever in use or is about to be; the control thread says which of them counts.
/// Rows are never taken away, so that an index stays what it is. Kept in memory, never on disk.
class LiveParameters {
 public:
  static constexpr int kCapacity = 4096;  ///< rows

  struct Row {
    std::string key;      ///< scope.name
    std::string variant;  ///< of a layer, else ""
    GaitdParameter declared;
    int owner;  ///< GAITD_LAYER_* or ParameterOwner
    int index;  ///< in the table of its owner
    int table;  ///< of add()
    ParameterEffect effect;
  };

  LiveParameters();

  /// Appends a table with one value for each row and returns its number, -1 if there is no room;
  /// the first one of an owner is in use. `variant` is "" for the scopes of the daemon. One thread.
  int add(int owner, std::string_view scope, std::string_view variant,
          std::span<const GaitdParameter> table, const std::vector<double>& values);
  /// Configuration keys beyond these: a change of one is refused with "needs a restart".
  void set_restart_keys(std::vector<std::string> keys) { restart_keys_ = std::move(keys); }

  /// The table of this variant with these very declarations, in use or not; -1: none.
  int find_table(int owner, std::string_view variant, std::span<const GaitdParameter> table) const;

  // ---- Any thread.
  int size() const { return size_.load(std::memory_order_acquire); }
  const Row& row(int index) const { return rows_[index]; }
  double value(int index) const { return values_[index].load(std::memory_order_relaxed); }
  bool in_use(const Row& row) const {
    return tables_in_use_[row.owner].load(std::memory_order_relaxed) == row.table;
  }
  int table_in_use(int owner) const {
    return tables_in_use_[owner].load(std::memory_order_relaxed);
  }
  /// Row in use of an owner by its place in the table; -1: none.
  int find_row(int owner, int index) const;
  /// The values of a table, in its order.
  std::vector<double> values(int table) const;
  // ---- Control thread. [rt]
  void store(int index, double value) { values_[index].store(value, std::memory_order_relaxed); }
  void use(int owner, int table) { tables_in_use_[owner].store(table, std::memory_order_relaxed); }

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
  std::vector<Row> rows_;  // never moves: appended to while others read what is before size_
  std::unique_ptr<std::atomic<double>[]> values_;
  std::atomic<int> size_{0};
  int tables_ = 0;
  std::array<std::atomic<int>, kParameterOwnerCount> tables_in_use_;
  std::vector<std::string> restart_keys_;
};

/// A value as its type wants it in JSON: true, 3 or 0.5.
nlohmann::json parameter_value(const GaitdParameter& parameter, double value);

}  // namespace gaitd::daemon

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/config/issues.h"

namespace gaitd::daemon {

enum class NodeKind { kNull, kScalar, kList, kMap };

struct Node;
using NodePtr = std::shared_ptr<const Node>;

// A value of a configuration, from YAML, JSON or the command line: untyped until a reader asks for
// a type, and always with the place it was written.
struct Node {
  struct Entry {
    std::string key;
    Location where;
    NodePtr value;
  };

  NodeKind kind = NodeKind::kNull;
  Location where;
  std::string text;            // kScalar
  bool quoted = false;         // kScalar: a text even when it looks like a number
  std::vector<NodePtr> items;  // kList
  std::vector<Entry> entries;  // kMap, in the order of the file, keys unique

  // The value of a key of a map; null when absent or not a map.
  const Entry* find(std::string_view key) const;
};

// Reads one YAML document. Reports to `issues` and returns null when the text is not YAML, is
// beyond one of the bounds of gaitd/sdk/bounds.h, or has several documents. Duplicate keys are
// reported and the first one kept. Never throws.
NodePtr parse_yaml(std::string_view text, const std::string& name, Issues* issues);
NodePtr load_yaml_file(const std::string& file, Issues* issues);
// From standard input; `name` is what the issues call it.
NodePtr read_yaml(std::istream& in, const std::string& name, Issues* issues);

// From a JSON value; `where` becomes the place of every node.
NodePtr from_json(const nlohmann::json& json, const Location& where);
// Plain scalars become null, booleans or numbers where they read as such, else strings.
nlohmann::json to_json(const Node& node);

NodePtr make_scalar(std::string text, const Location& where);

// The item of a list that a word of a dotted path names, from 0; nothing if there is none.
std::optional<std::size_t> item_index(const NodePtr& list, std::string_view word);

// A copy of `root` in which the value at the dotted path is replaced; maps are made where missing.
NodePtr with_value(const NodePtr& root, std::string_view dotted_path, NodePtr value);

// Strict readings of a scalar: nothing when the node is something else. Numbers are finite.
std::optional<double> as_number(const Node& node);
std::optional<long long> as_integer(const Node& node);
std::optional<bool> as_boolean(const Node& node);  // true | false

// What a user sees as "got": `'abc' (text)`, `3.5`, `a list of 4`, `a map`, `nothing`.
std::string describe(const Node& node);

}  // namespace gaitd::daemon

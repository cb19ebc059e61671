// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/node.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "gaitd/sdk/bounds.h"

namespace gaitd::daemon {
namespace {

constexpr std::size_t kMaxShownText = 60;

std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

// Short and on one line, whatever the file holds.
std::string printable(std::string_view text) {
  std::string result;
  for (const char c : text.substr(0, kMaxShownText)) {
    const unsigned char u = static_cast<unsigned char>(c);
    result += (u < 0x20 || u == 0x7f) ? ' ' : c;
  }
  if (text.size() > kMaxShownText) result += "...";
  return result;
}

NodePtr from_json_at(const nlohmann::json& json, const Location& where, int depth) {
  auto node = std::make_shared<Node>();
  node->where = where;
  if (depth > bounds::kYamlDepth) return node;
  switch (json.type()) {
    case nlohmann::json::value_t::object:
      node->kind = NodeKind::kMap;
      for (const auto& [key, value] : json.items()) {
        node->entries.push_back({key, where, from_json_at(value, where, depth + 1)});
      }
      break;
    case nlohmann::json::value_t::array:
      node->kind = NodeKind::kList;
      for (const auto& value : json) {
        node->items.push_back(from_json_at(value, where, depth + 1));
      }
      break;
    case nlohmann::json::value_t::string:
      node->kind = NodeKind::kScalar;
      node->text = json.get_ref<const std::string&>();
      node->quoted = true;
      break;
    case nlohmann::json::value_t::null:
    case nlohmann::json::value_t::discarded:
    case nlohmann::json::value_t::binary:
      break;
    case nlohmann::json::value_t::number_float:
      node->kind = NodeKind::kScalar;
      node->text = std::isfinite(json.get<double>()) ? json.dump() : "not finite";
      break;
    default:
      node->kind = NodeKind::kScalar;
      node->text = json.dump();
  }
  return node;
}

}  // namespace

const Node::Entry* Node::find(std::string_view key) const {
  for (const Entry& entry : entries) {
    if (entry.key == key) return &entry;
  }
  return nullptr;
}

NodePtr from_json(const nlohmann::json& json, const Location& where) {
  return from_json_at(json, where, 1);
}

nlohmann::json to_json(const Node& node) {
  switch (node.kind) {
    case NodeKind::kNull:
      return nullptr;
    case NodeKind::kList: {
      nlohmann::json result = nlohmann::json::array();
      for (const NodePtr& item : node.items) result.push_back(to_json(*item));
      return result;
    }
    case NodeKind::kMap: {
      nlohmann::json result = nlohmann::json::object();
      for (const Node::Entry& entry : node.entries) result[entry.key] = to_json(*entry.value);
      return result;
    }
    case NodeKind::kScalar:
      break;
  }
  if (const auto value = as_boolean(node)) return *value;
  if (const auto value = as_integer(node)) return *value;
  if (const auto value = as_number(node)) return *value;
  return node.text;
}

NodePtr make_scalar(std::string text, const Location& where) {
  auto node = std::make_shared<Node>();
  node->kind = NodeKind::kScalar;
  node->where = where;
  node->text = std::move(text);
  return node;
}

std::optional<std::size_t> item_index(const NodePtr& list, std::string_view word) {
  if (!list || list->kind != NodeKind::kList) return std::nullopt;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
  const bool whole = error == std::errc() && end == word.data() + word.size();
  if (!whole || index >= list->items.size()) return std::nullopt;
  return index;
}

NodePtr with_value(const NodePtr& root, std::string_view dotted_path, NodePtr value) {
  const std::size_t dot = dotted_path.find('.');
  const std::string_view key = dotted_path.substr(0, dot);
  if (const auto index = item_index(root, key)) {
    auto list = std::make_shared<Node>(*root);
    NodePtr& item = list->items[*index];
    item = dot == std::string_view::npos
               ? std::move(value)
               : with_value(item, dotted_path.substr(dot + 1), std::move(value));
    return list;
  }
  auto copy = std::make_shared<Node>();
  copy->kind = NodeKind::kMap;
  copy->where = value->where;
  if (root && root->kind == NodeKind::kMap) *copy = *root;

  const Node::Entry* old = copy->find(key);
  if (dot != std::string_view::npos) {
    value = with_value(old ? old->value : nullptr, dotted_path.substr(dot + 1), std::move(value));
  }
  for (Node::Entry& entry : copy->entries) {
    if (entry.key == key) {
      entry.where = value->where;
      entry.value = std::move(value);
      return copy;
    }
  }
  const Location where = value->where;
  copy->entries.push_back({std::string(key), where, std::move(value)});
  return copy;
}

std::optional<double> as_number(const Node& node) {
  if (node.kind != NodeKind::kScalar || node.quoted) return std::nullopt;
  const std::string_view text = without_plus(node.text);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

std::optional<long long> as_integer(const Node& node) {
  if (node.kind != NodeKind::kScalar || node.quoted) return std::nullopt;
  const std::string_view text = without_plus(node.text);
  long long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<bool> as_boolean(const Node& node) {
  if (node.kind != NodeKind::kScalar || node.quoted) return std::nullopt;
  if (node.text == "true") return true;
  if (node.text == "false") return false;
  return std::nullopt;
}

std::string describe(const Node& node) {
  switch (node.kind) {
    case NodeKind::kNull:
      return "nothing";
    case NodeKind::kList:
      return "a list of " + std::to_string(node.items.size());
    case NodeKind::kMap:
      return "a map";
    case NodeKind::kScalar:
      break;
  }
  if (as_number(node) || as_boolean(node)) return printable(node.text);
  return std::string("'").append(printable(node.text)).append("' (text)");
}

}  // namespace gaitd::daemon

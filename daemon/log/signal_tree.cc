// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/signal_tree.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>

namespace gaitd::daemon {

namespace {

// Protobuf reserves the field numbers 19000 to 19999; kMaxSignals keeps clear of them.
static_assert(kMaxSignals < 19000);

std::string sanitise(std::string_view text) {
  std::string identifier;
  if (std::isalpha(static_cast<unsigned char>(text.front())) == 0) identifier += 'n';
  for (const char c : text) {
    identifier += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return identifier;
}

std::string pascal_case(std::string_view identifier) {
  std::string name;
  bool upper = true;
  for (const char c : identifier) {
    if (c == '_') {
      upper = true;
      continue;
    }
    name += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    upper = false;
  }
  return name;
}

std::string upper_case(std::string name) {
  for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
}

// The names inside one message. Protobuf wants them different, and for JSON different even without
// underscores and case.
class Scope {
 public:
  std::string claim(const std::string& name) {
    std::string unique = name;
    for (int i = 2; !used_.insert(key(unique)).second; ++i) unique = name + "_" + std::to_string(i);
    return unique;
  }

  bool has(const std::string& name) const { return used_.count(key(name)) != 0; }

 private:
  static std::string key(const std::string& name) {
    std::string key;
    for (const char c : name) {
      if (c != '_') key += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return key;
  }

  std::set<std::string> used_;
};

void insert(const std::string& name, int signal, SignalNode* node) {
  std::string_view path = name;
  while (true) {
    const std::size_t slash = path.find('/');
    const std::string_view segment = path.substr(0, slash);
    const bool leaf = slash == std::string_view::npos;
    const auto found =
        std::find_if(node->children.begin(), node->children.end(), [&](const SignalNode& child) {
          return child.segment == segment && (child.signal >= 0) == leaf;
        });
    if (found == node->children.end()) {
      node = &node->children.emplace_back();
      node->segment = segment;
    } else {
      node = &*found;
    }
    if (leaf) break;
    path.remove_prefix(slash + 1);
  }
  node->signal = signal;
}

void name_fields(const SignalTable& table, SignalNode* node) {
  Scope scope;
  // Values first: `tick` keeps its name beside the group of `tick/total_us`.
  for (SignalNode& child : node->children) {
    if (child.signal >= 0) child.field = scope.claim(sanitise(child.segment));
  }
  const Scope values = scope;
  for (SignalNode& child : node->children) {
    if (child.signal >= 0) continue;
    const std::string field = sanitise(child.segment);
    child.field = scope.claim(values.has(field) ? field + "_group" : field);
  }
  int number = 0;
  for (SignalNode& child : node->children) {
    child.number = ++number;
    if (child.signal < 0) {
      child.type = scope.claim(pascal_case(child.field) + "Group");
      name_fields(table, &child);
      continue;
    }
    const SignalDescription& signal = table[static_cast<std::size_t>(child.signal)];
    if (signal.kind != SignalDescription::Kind::kEnumeration) continue;
    child.type = scope.claim(pascal_case(child.field) + "Enum");
    // Values of enumerations share the scope of the message, so they carry the name of the field.
    for (const std::string& word : signal.words) {
      child.values.push_back(scope.claim(upper_case(child.field + "_" + sanitise(word))));
    }
  }
}

}  // namespace

SignalNode build_signal_tree(const SignalTable& table) {
  SignalNode root;
  for (std::size_t i = 0; i < table.size(); ++i) {
    insert(table[i].name, static_cast<int>(i), &root);
  }
  name_fields(table, &root);
  return root;
}

}  // namespace gaitd::daemon

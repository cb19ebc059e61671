// SPDX-License-Identifier: Apache-2.0
// YAML text to a tree of nodes. Works on the parser's events, so that nesting, aliases and size are
// refused while reading and not after.
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <istream>
#include <map>
#include <sstream>
#include <unordered_map>

#include "daemon/config/node.h"
#include "daemon/config/utf8.h"
#include "gaitd/sdk/bounds.h"

namespace gaitd::daemon {
namespace {

// Ends the parse; what was wrong is in the issues already.
struct GiveUp {};

class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::string name, Issues* issues) : name_(std::move(name)), issues_(issues) {}

  NodePtr root() const { return root_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add_leaf(make(NodeKind::kNull, mark), anchor);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    auto node = make(NodeKind::kScalar, mark);
    node->text = value;
    node->quoted = tag == "!" || tag == "tag:yaml.org,2002:str";
    if (!node->quoted && !tag.empty() && tag != "?") refuse_tag(mark, tag);
    add_leaf(std::move(node), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) {
      give_up(mark, "an alias refers to a value that contains it; write the value out");
    }
    count(mark, found->second.size);
    add(found->second.node, mark);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(NodeKind::kList, mark, tag, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(NodeKind::kMap, mark, tag, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Frame {
    std::shared_ptr<Node> node;
    YAML::anchor_t anchor = 0;
    std::size_t count_before = 0;
    bool has_key = false;
    bool drop_value = false;  // of a duplicate key
    std::string key;
    Location key_where;
    std::unordered_map<std::string, int> lines;  // of the keys of a map
  };
  struct Anchored {
    NodePtr node;
    std::size_t size = 1;
  };

  Location at(const YAML::Mark& mark) const { return {name_, mark.line + 1}; }

  [[noreturn]] void give_up(const YAML::Mark& mark, const std::string& message) {
    issues_->add_text(at(mark), "", message);
    throw GiveUp{};
  }

  void refuse_tag(const YAML::Mark& mark, const std::string& tag) {
    issues_->add_text(at(mark), "",
                      "expected a value without a tag, got the tag '" + tag + "'; remove it");
  }

  void count(const YAML::Mark& mark, std::size_t nodes) {
    count_ += nodes;
    if (count_ > bounds::kYamlValues) {
      give_up(mark, "expected at most " + std::to_string(bounds::kYamlValues) +
                        " values with every alias expanded, got more; split or shorten the file");
    }
  }

  std::shared_ptr<Node> make(NodeKind kind, const YAML::Mark& mark) {
    count(mark, 1);
    auto node = std::make_shared<Node>();
    node->kind = kind;
    node->where = at(mark);
    return node;
  }

  void add_leaf(std::shared_ptr<Node> node, YAML::anchor_t anchor) {
    if (anchor) anchors_[anchor] = {node, 1};
    YAML::Mark mark;
    mark.line = node->where.line - 1;
    add(std::move(node), mark);
  }

  void open(NodeKind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    if (static_cast<int>(stack_.size()) >= bounds::kYamlDepth) {
      give_up(mark, "expected at most " + std::to_string(bounds::kYamlDepth) +
                        " levels of nesting, got more; flatten the file");
    }
    if (!tag.empty() && tag != "?" && tag != "!") refuse_tag(mark, tag);
    Frame frame;
    frame.count_before = count_;
    frame.node = make(kind, mark);
    frame.anchor = anchor;
    stack_.push_back(std::move(frame));
  }

  void close() {
    Frame frame = std::move(stack_.back());
    stack_.pop_back();
    if (frame.anchor) anchors_[frame.anchor] = {frame.node, count_ - frame.count_before};
    YAML::Mark mark;
    mark.line = frame.node->where.line - 1;
    add(std::move(frame.node), mark);
  }

  void add(NodePtr node, const YAML::Mark& mark) {
    if (stack_.empty()) {
      root_ = std::move(node);
      return;
    }
    Frame& frame = stack_.back();
    if (frame.node->kind == NodeKind::kList) {
      frame.node->items.push_back(std::move(node));
    } else if (!frame.has_key) {
      take_key(&frame, *node, mark);
    } else {
      if (!frame.drop_value) {
        frame.node->entries.push_back({frame.key, frame.key_where, std::move(node)});
      }
      frame.has_key = false;
    }
  }

  void take_key(Frame* frame, const Node& node, const YAML::Mark& mark) {
    frame->has_key = true;
    frame->drop_value = false;
    frame->key = node.text;
    frame->key_where = at(mark);
    if (node.kind != NodeKind::kScalar) {
      issues_->add(frame->key_where, "", "a key of one word", describe(node),
                   "write the key as plain text");
      frame->drop_value = true;
      return;
    }
    if (frame->key.size() > bounds::kYamlKey) {
      give_up(mark, "expected a key of at most " + std::to_string(bounds::kYamlKey) +
                        " characters, got " + std::to_string(frame->key.size()) +
                        "; write a ': ' after the key");
    }
    const auto [first, is_new] = frame->lines.try_emplace(frame->key, frame->key_where.line);
    if (is_new) return;
    issues_->add_text(frame->key_where, frame->key,
                      "the key is there twice, first in line " + std::to_string(first->second) +
                          "; remove one of the two");
    frame->drop_value = true;
  }

  std::string name_;
  Issues* issues_;
  NodePtr root_;
  std::vector<Frame> stack_;
  std::map<YAML::anchor_t, Anchored> anchors_;
  std::size_t count_ = 0;
};

void refuse_size(const std::string& name, std::uintmax_t size, Issues* issues) {
  issues->add({name, 0}, "", "at most " + std::to_string(bounds::kYamlBytes) + " bytes",
              std::to_string(size), "split the file");
}

}  // namespace

NodePtr parse_yaml(std::string_view text, const std::string& name, Issues* issues) {
  if (text.size() > bounds::kYamlBytes) {
    refuse_size(name, text.size(), issues);
    return nullptr;
  }
  // The parser would take some of it for the end of the file.
  if (const std::size_t at = find_no_text(text); at != std::string_view::npos) {
    const auto line =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    char byte[8];
    std::snprintf(byte, sizeof byte, "0x%02x", static_cast<unsigned char>(text[at]));
    issues->add({name, static_cast<int>(line) + 1}, "", "text in UTF-8",
                std::string("the byte ") + byte,
                "save the file as UTF-8 text without control characters");
    return nullptr;
  }
  TreeBuilder builder(name, issues);
  try {
    std::istringstream stream{std::string(text)};
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder) || !builder.root()) {
      issues->add({name, 0}, "", "a YAML document", "nothing", "write the keys of its schema");
      return nullptr;
    }
    TreeBuilder second(name, issues);
    if (parser.HandleNextDocument(second)) {
      issues->add(second.root() ? second.root()->where : Location{name, 0}, "", "one YAML document",
                  "a second one", "remove the '---' and what follows");
      return nullptr;
    }
  } catch (const GiveUp&) {
    return nullptr;
  } catch (const YAML::Exception& e) {
    issues->add_text({name, e.mark.is_null() ? 0 : e.mark.line + 1}, "",
                     "not YAML: " + e.msg + "; correct the line or the one before it");
    return nullptr;
  } catch (const std::exception& e) {
    issues->add_text({name, 0}, "", std::string("not YAML: ") + e.what());
    return nullptr;
  }
  return builder.root();
}

NodePtr load_yaml_file(const std::string& file, Issues* issues) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::is_regular_file(status)) {
    issues->add({file, 0}, "", "a file",
                std::filesystem::exists(status) ? "something else" : "nothing there",
                "correct the path");
    return nullptr;
  }
  const auto size = std::filesystem::file_size(file, error);
  if (!error && size > bounds::kYamlBytes) {
    refuse_size(file, size, issues);
    return nullptr;
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    issues->add_text({file, 0}, "", "cannot be read; check its permissions");
    return nullptr;
  }
  return read_yaml(stream, file, issues);
}

NodePtr read_yaml(std::istream& in, const std::string& name, Issues* issues) {
  std::string text(bounds::kYamlBytes + 1, '\0');  // one more tells that there is more
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad()) {
    issues->add_text({name, 0}, "", "cannot be read to its end; try again");
    return nullptr;
  }
  return parse_yaml(text, name, issues);
}

}  // namespace gaitd::daemon

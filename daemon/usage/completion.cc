// SPDX-License-Identifier: Apache-2.0
#include "daemon/usage/completion.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <iostream>

namespace gaitd::usage {
namespace {

// The present command and those it is in: its options hold with theirs (fallthrough).
const CLI::Option* find_option(const CLI::App* app, const std::string& word) {
  for (; app != nullptr; app = app->get_parent()) {
    if (const CLI::Option* option = app->get_option_no_throw(word)) return option;
  }
  return nullptr;
}

const CLI::App* find_command(const CLI::App& app, const std::string& word) {
  for (const CLI::App* command : visible_commands(app)) {
    if (command->get_name() == word) return command;
  }
  return nullptr;
}

bool takes_files(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.find("FILE") != std::string::npos || type.find("FOLDER") != std::string::npos;
}

bool is_option(const std::string& word) { return word.size() > 1 && word[0] == '-'; }

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

// Where the words before the last one have led.
struct Place {
  const CLI::App* app;
  std::size_t positional = 0;            // values that it has already
  const CLI::Option* waiting = nullptr;  // for its value
  std::string joined{};                  // "KEY=", the part of the value that is a word of its own
};

Place walk(const CLI::App& app, const std::vector<std::string>& words) {
  Place place{&app};
  const CLI::Option* taken = nullptr;  // whose value the word before was
  const auto continues = [&](std::size_t i) { return taken != nullptr && words[i] == "="; };
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    const std::string& word = words[i];
    if (continues(i)) {  // and of that of --option KEY=value
      place.waiting = taken;
      place.joined = words[i - 1] + "=";
      taken = nullptr;
      continue;
    }
    taken = nullptr;
    if (place.waiting != nullptr) {
      if (word == "=") continue;  // bash makes a word of the = of --option=value
      if (place.joined.empty()) taken = place.waiting;
      place.waiting = nullptr;
      place.joined.clear();
    } else if (is_option(word)) {
      const std::string name = word.substr(0, word.find('='));
      const CLI::Option* option = find_option(place.app, name);
      const bool takes_value = option != nullptr && option->get_items_expected_max() > 0;
      if (takes_value && name == word) place.waiting = option;
    } else if (const CLI::App* command = find_command(*place.app, word)) {
      place = {command};
    } else {
      ++place.positional;
    }
  }
  if (!words.empty() && continues(words.size() - 1)) {
    place.waiting = taken;
    place.joined = words[words.size() - 2] + "=";
  }
  return place;
}

class Collector {
 public:
  // `words`: the command line, the last of which begins with `prefix` or is the "=" before it.
  Collector(std::string prefix, const std::vector<std::string>& words, const ValueSources& sources)
      : prefix_(std::move(prefix)), words_(words), sources_(sources) {}

  void add(const std::string& word, const std::string& description) {
    if (word.starts_with(prefix_)) {
      result_.candidates.push_back({word, first_line(description)});
    }
  }
  // `before`: what stands in the same word before the value; `joined`: what of the value stands in
  // the words before.
  void add_values(const CLI::Option& option, const std::string& before,
                  const std::string& joined = "") {
    for (const std::string& word : fixed_words(option)) add(before + word, "");
    if (const auto source = sources_.find(&option); source != sources_.end()) {
      const std::size_t last = words_.empty() ? 0 : words_.size() - 1;
      for (const std::string& word : source->second({words_.begin(), words_.begin() + last})) {
        if (word.starts_with(joined)) add(before + word.substr(joined.size()), "");
      }
    }
    result_.files = takes_files(option);
  }
  void add_options(const CLI::App* app) {
    for (; app != nullptr; app = app->get_parent()) {
      for (const CLI::Option* option : visible_options(*app)) {
        for (const std::string& name : option->get_lnames()) {
          add("--" + name, option->get_description());
        }
      }
    }
  }
  Completion take() { return std::move(result_); }

 private:
  std::string prefix_;
  const std::vector<std::string>& words_;
  const ValueSources& sources_;
  Completion result_;
};

// The n-th positional; the last one takes all that follow if it may be repeated.
const CLI::Option* positional_at(const CLI::App& app, std::size_t n) {
  const CLI::Option* last = nullptr;
  for (const CLI::Option* option : visible_options(app)) {
    if (!option->get_positional()) continue;
    if (n-- == 0) return option;
    last = option;
  }
  return last != nullptr && last->get_items_expected_max() > 1 ? last : nullptr;
}

}  // namespace

std::vector<const CLI::Option*> visible_options(const CLI::App& app) {
  std::vector<const CLI::Option*> options;
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_group().empty()) options.push_back(option);
  }
  return options;
}

std::vector<const CLI::App*> visible_commands(const CLI::App& app) {
  std::vector<const CLI::App*> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!command->get_group().empty()) commands.push_back(command);
  }
  return commands;
}

std::vector<std::string> fixed_words(const CLI::Option& option) {
  // The type name of an option with CLI::IsMember ends in ":{one,two}".
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}', begin);
  if (begin == std::string::npos || end == std::string::npos) return {};
  std::vector<std::string> words = CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
  for (std::string& word : words) CLI::detail::trim(word);
  return words;
}

Completion complete(const CLI::App& app, const std::vector<std::string>& words,
                    const ValueSources& sources) {
  const std::string last = words.empty() ? "" : words.back();
  const Place place = walk(app, words);
  if (place.waiting != nullptr) {
    Collector collector(last == "=" ? "" : last, words, sources);
    collector.add_values(*place.waiting, "", place.joined);
    return collector.take();
  }
  Collector collector(last, words, sources);
  const std::size_t equals = last.find('=');
  if (is_option(last) && equals != std::string::npos) {
    const CLI::Option* option = find_option(place.app, last.substr(0, equals));
    if (option != nullptr) collector.add_values(*option, last.substr(0, equals + 1));
  } else if (!last.empty() && last[0] == '-') {
    collector.add_options(place.app);
  } else {
    for (const CLI::App* command : visible_commands(*place.app)) {
      collector.add(command->get_name(), command->get_description());
    }
    const CLI::Option* positional = positional_at(*place.app, place.positional);
    if (positional != nullptr) collector.add_values(*positional, "");
  }
  return collector.take();
}

std::string completion_lines(const CLI::App& app, const std::vector<std::string>& words,
                             const ValueSources& sources) {
  const Completion completion = complete(app, words, sources);
  std::string lines;
  for (const Completion::Candidate& candidate : completion.candidates) {
    lines += candidate.word + "\t" + candidate.description + "\n";
  }
  if (completion.files) lines += ":files\n";
  return lines;
}

bool answer_hidden_request(int argc, char** argv, const CLI::App& app, const ValueSources& sources,
                           const std::function<std::string()>& man_page) {
  const std::string request = argc > 1 ? argv[1] : "";
  if (request == "__man") {
    std::cout << man_page();
  } else if (request == "__complete") {
    std::cout << completion_lines(app, {argv + 2, argv + argc}, sources);
  } else {
    return false;
  }
  return true;
}

}  // namespace gaitd::usage

// SPDX-License-Identifier: Apache-2.0
#include "cli/help.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

#include "cli/table.h"
#include "cli/terminal.h"
#include "daemon/usage/completion.h"

namespace gaitd::cli {
namespace {

constexpr std::size_t kNames = 24;      // columns of the names
constexpr std::size_t kMostWords = 40;  // characters of the words to choose from
constexpr std::size_t kUsual = 80;      // where there is no terminal
constexpr std::size_t kWidest = 100;    // a longer line is hard to read

struct Group {
  const char* title;
  std::vector<const char*> commands;
};

const std::vector<Group>& groups() {
  static const std::vector<Group> kGroups = {
      {"Command the robot",
       {"status", "watch",  "view",  "arm",   "disarm", "estop", "reset",    "mode",
        "walk",   "steps",  "drive", "goto",  "teleop", "pose",  "handhold", "payload",
        "pause",  "resume", "stop",  "abort", "tare",   "map"}},
      {"Play scenarios", {"run", "campaign", "compare", "sim"}},
      {"Read logs", {"report", "log", "doctor"}},
      {"Set up", {"robot", "param", "plugin", "joint", "calibrate", "completion"}}};
  return kGroups;
}

// By the name of a command as one types it.
const std::map<std::string, const char*>& examples() {
  static const std::map<std::string, const char*> kExamples = {
      {"status", "gaitctl status"},
      {"watch", "gaitctl watch --interval 0.5"},
      {"view", "gaitctl view --open"},
      {"arm", "gaitctl arm"},
      {"disarm", "gaitctl disarm"},
      {"estop", "gaitctl estop"},
      {"reset", "gaitctl reset"},
      {"mode", "gaitctl mode walk-straight"},
      {"walk", "gaitctl walk --steps 6 --length 0.3"},
      {"steps", "gaitctl steps footsteps.yaml --replace"},
      {"drive", "gaitctl drive --forward 0.3 --turn 0.2 --for 5"},
      {"goto", "gaitctl goto 2.0 -0.5 1.57"},
      {"map put", "gaitctl map put blocks.yaml"},
      {"map save", "gaitctl map save seen.yaml"},
      {"map clear", "gaitctl map clear"},
      {"teleop", "gaitctl teleop"},
      {"pose pelvis", "gaitctl pose pelvis --z -0.05 --pitch 0.1 --duration 2"},
      {"pose chest", "gaitctl pose chest --yaw 0.3 --duration 2"},
      {"pose arm", "gaitctl pose arm left --joint l_arm_elx=1.2 --joint l_arm_shz=0.3"},
      {"pose hand", "gaitctl pose hand left --frame pelvis --x 0.5 --y 0.3 --z 0.2 --duration 2"},
      {"handhold take", "gaitctl handhold take right --normal 0,1,0 --force 150"},
      {"handhold release", "gaitctl handhold release right"},
      {"payload estimate", "gaitctl payload estimate --link l_hand"},
      {"payload set", "gaitctl payload set --link utorso --mass 10 --com 0.35,0,0.2"},
      {"payload clear", "gaitctl payload clear"},
      {"pause", "gaitctl pause"},
      {"resume", "gaitctl resume"},
      {"stop", "gaitctl stop"},
      {"abort", "gaitctl abort"},
      {"tare", "gaitctl tare"},
      {"run", "gaitctl run flat-0.35 turn --set seed=2 --log logs/"},
      {"campaign", "gaitctl campaign push-map.yaml -o pushes --jobs 4"},
      {"campaign merge", "gaitctl campaign merge shard-1 shard-2 -o merged"},
      {"campaign report", "gaitctl campaign report pushes -o pushes.html"},
      {"campaign tune", "gaitctl campaign tune sim/campaigns/tune-pushes.yaml -o tuned"},
      {"compare", "gaitctl compare push-bent-forward -- a.yaml b.yaml"},
      {"sim push", "gaitctl sim push --link utorso --force 0,200,0 --duration 0.1"},
      {"sim load", "gaitctl sim load --link utorso --mass 10 --com 0.35,0,0.2"},
      {"sim reset", "gaitctl sim reset"},
      {"report", "gaitctl report walk.mcap slower.mcap -o walks.html"},
      {"log info", "gaitctl log info walk.mcap"},
      {"log export", "gaitctl log export walk.mcap --signals 'time,icp/*' -o walk.csv"},
      {"log replay", "gaitctl log replay walk.mcap --set toe_off.variant=never"},
      {"doctor", "gaitctl doctor walk.mcap"},
      {"param list", "gaitctl param list 'gait.*'"},
      {"param get", "gaitctl param get gait.swing_height"},
      {"param set", "gaitctl param set gait.swing_height 0.12"},
      {"param reference", "gaitctl param reference"},
      {"plugin list", "gaitctl plugin list"},
      {"plugin swap", "gaitctl plugin swap toe_off never"},
      {"plugin rollback", "gaitctl plugin rollback toe_off"},
      {"plugin new", "gaitctl plugin new toe_off mine -o mine"},
      {"plugin check", "gaitctl plugin check build/toe_off/mine.so"},
      {"joint list", "gaitctl joint list"},
      {"joint test", "gaitctl joint test l_leg_kny --amplitude 0.05"},
      {"calibrate", "gaitctl calibrate --simulate -o measured.yaml"},
      {"robot init", "gaitctl robot init my-robot.urdf -o my-robot"},
      {"completion", "gaitctl completion bash"}};
  return kExamples;
}

void add_examples(CLI::App* app, const std::string& before) {
  for (const CLI::App* visible : usage::visible_commands(*app)) {
    CLI::App* command = app->get_subcommand(visible->get_name());
    const std::string name = before + command->get_name();
    if (const auto example = examples().find(name); example != examples().end()) {
      const std::string footer = command->get_footer();
      command->footer(footer + (footer.empty() ? "" : "\n") + "Example:\n  " + example->second);
    }
    add_examples(command, name + " ");
  }
}

std::size_t help_columns() {
  const std::size_t columns = output_columns();
  return columns == 0 ? kUsual : std::clamp(columns, kNames + 16, kWidest);
}

// Lines that follow each other as one paragraph; those that begin with a blank stay as they are.
std::string filled(const std::string& text, std::size_t columns) {
  std::string out;
  std::string paragraph;
  const auto end_paragraph = [&] {
    if (paragraph.empty()) return;
    for (const std::string& line : wrapped(paragraph, columns)) out += line + "\n";
    paragraph.clear();
  };
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool stays = line.empty() || line.front() == ' ';
    if (stays || line == "Example:") end_paragraph();
    if (stays || line == "Example:") {
      out += line + "\n";
    } else {
      paragraph += (paragraph.empty() ? "" : " ") + line;
    }
  }
  end_paragraph();
  return out;
}

}  // namespace

HelpFormatter::HelpFormatter() : columns_(help_columns()) {}

std::string HelpFormatter::entry(const std::string& name, const std::string& meaning) const {
  const std::string left = "  " + name;
  std::string out = left;
  std::size_t at = left.size();
  for (const std::string& line : wrapped(meaning, columns_ - kNames)) {
    if (at + 2 > kNames + 1) {
      out += "\n";
      at = 0;
    }
    out += std::string(kNames - at, ' ') + line;
    at = columns_;  // whatever follows begins a line
  }
  return out + "\n";
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  return entry(make_option_name(option, is_positional) + make_option_opts(option),
               make_option_desc(option));
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  if (option->get_type_size() == 0) return "";
  std::string words;
  for (const std::string& word : usage::fixed_words(*option)) {
    words += (words.empty() ? "" : "|") + word;
  }
  const std::string type = option->get_type_name();
  const std::string name = type.substr(0, type.find(':'));
  const bool many = words.size() > kMostWords;
  const std::string value = !words.empty() && !many ? words : name == "TEXT" ? "VALUE" : name;
  const bool repeated = option->get_expected_max() == CLI::detail::expected_max_vector_size;
  // Of a positional the name says it already, unless there are words to choose from; many are in
  // the description.
  const bool named = option->get_positional() && (words.empty() || many);
  return (named || value.empty() ? "" : " " + value) + (repeated ? " ..." : "");
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  const std::string text = option->get_default_str();
  std::string words;
  for (const std::string& word : usage::fixed_words(*option)) {
    words += (words.empty() ? "" : ", ") + word;
  }
  words = words.size() > kMostWords ? "; one of " + words : "";
  return option->get_description() + words + (option->get_required() ? "; required" : "") +
         (text.empty() ? "" : "; default " + text);
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  return entry(command->get_name(), command->get_description());
}

std::string HelpFormatter::make_description(const CLI::App* command) const {
  return filled(command->get_description(), columns_);
}

std::string HelpFormatter::make_footer(const CLI::App* command) const {
  return filled(command->get_footer(), columns_);
}

void add_help(CLI::App* app) {
  for (const Group& group : groups()) {
    for (const char* command : group.commands) app->get_subcommand(command)->group(group.title);
  }
  add_examples(app, "");
}

}  // namespace gaitd::cli

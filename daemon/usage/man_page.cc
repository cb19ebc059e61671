// SPDX-License-Identifier: Apache-2.0
#include "daemon/usage/man_page.h"

#include <CLI/CLI.hpp>
#include <cctype>
#include <sstream>

#include "daemon/usage/completion.h"

namespace gaitd::usage {
namespace {

// Text as roff shows it: no character of it is a command of roff.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '`':
        out += "\\(ga";
        break;
      case '^':
        out += "\\(ha";
        break;
      case '~':
        out += "\\(ti";
        break;
      default:
        out += c;
    }
  }
  return out.starts_with('.') ? "\\&" + out : out;
}

std::string bold(const std::string& text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + escaped(text) + "\\fR"; }

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

// "left|right", or the name of the value.
std::string value_name(const CLI::Option& option) {
  std::string words;
  for (const std::string& word : fixed_words(option)) words += (words.empty() ? "" : "|") + word;
  if (!words.empty()) return words;
  const std::string type = option.get_type_name();
  const std::string name = type.substr(0, type.find(':'));
  return name == "TEXT" ? "VALUE" : name;
}

// "-o, --output FILE" or the name of a positional.
std::string option_head(const CLI::Option& option) {
  if (option.get_positional()) {
    const std::string repeated = option.get_items_expected_max() > 1 ? "..." : "";
    return italic(option.get_name(true)) + repeated;
  }
  std::string head;
  for (const std::string& name : option.get_snames()) head += bold("-" + name) + ", ";
  for (const std::string& name : option.get_lnames()) head += bold("--" + name) + ", ";
  head.erase(head.size() - 2);
  if (option.get_type_size() > 0) head += " " + italic(value_name(option));
  return head;
}

// Options that are needed come without brackets.
std::string synopsis_of(const CLI::App& app) {
  std::string out;
  for (const CLI::Option* option : visible_options(app)) {
    const bool help = option == app.get_help_ptr();
    if (help) continue;
    out += option->get_required() ? " " + option_head(*option) : " [" + option_head(*option) + "]";
  }
  return out;
}

std::string options_of(const CLI::App& app) {
  std::string out;
  for (const CLI::Option* option : visible_options(app)) {
    if (option == app.get_help_ptr() && app.get_parent() != nullptr) continue;
    out += ".TP\n" + option_head(*option) + "\n" + escaped(option->get_description()) + ".\n";
  }
  return out;
}

// `text` in paragraphs; see ManText::Section.
std::string prose(const std::string& text) {
  std::string out;
  std::istringstream lines(text);
  bool verbatim = false;
  for (std::string line; std::getline(lines, line);) {
    const bool now_verbatim = line.starts_with("    ");
    if (now_verbatim != verbatim) out += now_verbatim ? ".PP\n.nf\n.RS 4\n" : ".RE\n.fi\n";
    verbatim = now_verbatim;
    const std::size_t tab = line.find('\t');
    if (verbatim) {
      out += escaped(line.substr(4)) + "\n";
    } else if (line.empty()) {
      out += ".PP\n";
    } else if (tab != std::string::npos) {
      out += ".TP\n" + bold(line.substr(0, tab)) + "\n" + escaped(line.substr(tab + 1)) + "\n";
    } else {
      out += escaped(line) + "\n";
    }
  }
  if (verbatim) out += ".RE\n.fi\n";
  return out;
}

std::string as_it_is(const std::string& text) {
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) out += escaped(line) + "\n";
  return out;
}

void add_commands(const CLI::App& app, const std::string& before, std::string* out) {
  for (const CLI::App* command : visible_commands(app)) {
    const std::string name = before + command->get_name();
    // Also one that does something by itself.
    if (visible_commands(*command).empty() || command->get_require_subcommand_min() == 0) {
      *out += ".SS " + bold(name) + synopsis_of(*command) + "\n";
      *out += escaped(command->get_description()) + ".\n" + options_of(*command);
      if (!command->get_footer().empty()) {
        *out += ".PP\n.nf\n" + as_it_is(command->get_footer()) + ".fi\n";
      }
    }
    add_commands(*command, name + " ", out);
  }
}

}  // namespace

std::string man_page(const CLI::App& app, const ManText& text) {
  const bool commands = !visible_commands(app).empty();
  std::string out = ".\\\" Made by " + text.name + " itself; do not edit.\n";
  out += ".TH " + upper(text.name) + " " + text.section + " \"\" \"gaitd " + text.version +
         "\" \"gaitd\"\n.SH NAME\n" + escaped(text.name) + " \\- " + escaped(text.summary) + "\n";
  out += ".SH SYNOPSIS\n" + bold(text.name) + synopsis_of(app) +
         (commands ? " " + italic("COMMAND") : "") + "\n";
  out += ".SH DESCRIPTION\n" + prose(text.description);
  out += ".SH OPTIONS\n" + options_of(app);
  if (commands) {
    out += ".SH COMMANDS\n";
    add_commands(app, "", &out);
  }
  for (const ManText::Section& section : text.sections) {
    out += ".SH " + section.title + "\n" + prose(section.text);
  }
  return out;
}

}  // namespace gaitd::usage

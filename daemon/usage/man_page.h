// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace gaitd::usage {

/// What a manual page says beyond the definition of the options.
struct ManText {
  std::string name;     ///< of the program
  std::string section;  ///< "1", "8"
  std::string version;
  std::string summary;      ///< one line
  std::string description;  ///< paragraphs separated by empty lines
  struct Section {
    std::string title;  ///< in capitals
    std::string text;   ///< paragraphs; "TERM<tab>text" lines make a list; lines that begin with
                        ///< four blanks stay as they are
  };
  std::vector<Section> sections;  ///< behind options and commands, in order
};

/// The manual page in roff (man macros): name, synopsis, description, every visible option and
/// command of `app` with its options, then the sections of `text`.
std::string man_page(const CLI::App& app, const ManText& text);

}  // namespace gaitd::usage

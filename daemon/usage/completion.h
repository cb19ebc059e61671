// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace gaitd::usage {

/// Values that an option or positional can take, known only when asked: names of files, say.
/// `words` stand before the value.
using ValueSource = std::function<std::vector<std::string>(const std::vector<std::string>& words)>;
using ValueSources = std::map<const CLI::Option*, ValueSource>;

/// What may stand at the end of a command line.
struct Completion {
  struct Candidate {
    std::string word;
    std::string description;  ///< one line, may be empty
  };
  std::vector<Candidate> candidates;
  bool files = false;  ///< names of files too
};

/// Completes the last of `words`, which are those behind the name of the program up to the cursor;
/// the last may be empty. Everything comes from the definition of `app`: subcommands, options,
/// fixed words (CLI::IsMember), files where the name of a value holds FILE or FOLDER; and
/// `sources`.
Completion complete(const CLI::App& app, const std::vector<std::string>& words,
                    const ValueSources& sources);

/// The same as lines for the scripts below: word, tab, description; ":files" for files.
std::string completion_lines(const CLI::App& app, const std::vector<std::string>& words,
                             const ValueSources& sources);

/// The script that makes a shell ask a program with `__complete`, for gaitctl and gaitd alike; ""
/// if the shell is not among kShells.
inline constexpr std::string_view kShells[] = {"bash", "zsh", "fish"};
std::string completion_script(std::string_view shell);

/// Answers `PROGRAM __complete WORD...` and `PROGRAM __man` on standard output: what the scripts
/// and the build ask of a program, before its command line is parsed. False if it is neither.
bool answer_hidden_request(int argc, char** argv, const CLI::App& app, const ValueSources& sources,
                           const std::function<std::string()>& man_page);

/// The visible options and commands of an app, those with a group.
std::vector<const CLI::Option*> visible_options(const CLI::App& app);
std::vector<const CLI::App*> visible_commands(const CLI::App& app);

/// The fixed words of an option, from CLI::IsMember; empty if it takes any value.
std::vector<std::string> fixed_words(const CLI::Option& option);

}  // namespace gaitd::usage

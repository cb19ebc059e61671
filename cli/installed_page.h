// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace gaitd::cli {

/// A page that was built with gaitd, share/gaitd/NAME.html beside this program.
struct InstalledPage {
  std::string file;
  std::string text;  ///< empty: there is none
};
InstalledPage installed_page(const std::string& name);

/// As it may stand inside a <script>.
std::string script_text(const nlohmann::json& data);

/// The page NAME that shows `data`, a script_text. Empty: what is installed is not `title`, and
/// *error says so.
std::string page_with_data(const std::string& name, const std::string& title,
                           const std::string& data, std::string* error);

}  // namespace gaitd::cli

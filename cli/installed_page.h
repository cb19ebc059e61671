// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace gaitd::cli {

/// A page that was built with gaitd, share/gaitd/NAME.html beside this program.
struct InstalledPage {
  std::string file;
  std::string text;  ///< empty: there is none
};
InstalledPage installed_page(const std::string& name);

}  // namespace gaitd::cli

// SPDX-License-Identifier: Apache-2.0
#include "cli/installed_page.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "cli/whole_file.h"

namespace gaitd::cli {
namespace {

constexpr std::string_view kPlaceholder = "\"GAITD_DATA\"";

}  // namespace

InstalledPage installed_page(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path file = program.parent_path().parent_path() / "share/gaitd" / (name + ".html");
  return {file.string(), read_file(file)};
}

std::string script_text(const nlohmann::json& data) {
  const std::string text = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return safe;
}

std::string page_with_data(const std::string& name, const std::string& title,
                           const std::string& data, std::string* error) {
  auto [file, page] = installed_page(name);
  const std::size_t place = page.find(kPlaceholder);
  if (place == std::string::npos) {
    *error = file + ": expected " + title + ", got " + (page.empty() ? "no file" : "another file") +
             "; gaitd was built without it: install npm and build again";
    return "";
  }
  return page.replace(place, kPlaceholder.size(), data);
}

}  // namespace gaitd::cli

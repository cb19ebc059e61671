// SPDX-License-Identifier: Apache-2.0
#include "cli/link_options.h"

#include <CLI/CLI.hpp>
#include <array>
#include <cstdlib>

#include "cli/ask.h"
#include "cli/completion_values.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

// "1,2.5,-3" as three numbers; an error text for CLI11 otherwise.
std::string read_vector(const std::string& text, std::array<double, 3>* out) {
  const char* at = text.c_str();
  for (std::size_t i = 0; i < 3; ++i) {
    char* end = nullptr;
    (*out)[i] = std::strtod(at, &end);
    const char expected = i < 2 ? ',' : '\0';
    if (end == at || *end != expected) return "expected X,Y,Z (three numbers), got " + text;
    at = end + 1;
  }
  return "";
}

const CLI::Validator kVector(
    [](std::string& text) {
      std::array<double, 3> ignored;
      return read_vector(text, &ignored);
    },
    "", "");

json vector_json(const std::string& text) {
  std::array<double, 3> values{};
  read_vector(text, &values);
  return values;
}

}  // namespace

CLI::Option* add_link(CLI::App* command, Context* context, const std::shared_ptr<json>& params,
                      const std::string& description) {
  auto* link = command->add_option_function<std::string>(
      "--link", [params](const std::string& value) { (*params)["link"] = value; }, description);
  context->values[link] = [](const auto&) { return link_names(); };
  return link;
}

CLI::Option* add_vector(CLI::App* command, const std::string& option,
                        const std::shared_ptr<json>& params, const std::string& key,
                        const std::string& description) {
  return command
      ->add_option_function<std::string>(
          option, [params, key](const std::string& value) { (*params)[key] = vector_json(value); },
          description)
      ->type_name("X,Y,Z")
      ->check(kVector);
}

void add_load(CLI::App* command, Context* context, const std::shared_ptr<json>& params) {
  add_link(command, context, params, "Link that carries it")->required();
  add_number(command, "--mass", params, "/mass", "Mass, kg")->required();
  add_vector(command, "--com", params, "com",
             "Its centre of mass in the frame of the link, m, as X,Y,Z; the origin if left out");
}

}  // namespace gaitd::cli

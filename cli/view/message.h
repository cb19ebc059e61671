// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace gaitd::cli {

/// What goes to browsers: made once, however many get it.
using Message = std::shared_ptr<const std::string>;

inline Message message_of(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}
inline Message text_of(const nlohmann::json& message) {
  return message_of(message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace gaitd::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/server/json_shape.h"
#include "gaitd/sdk/bounds.h"

namespace gaitd::cli {

/// What goes to browsers: made once, however many get it.
using Message = std::shared_ptr<const std::string>;

inline Message message_of(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}
inline Message text_of(const nlohmann::json& message) {
  return message_of(message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

/// What came from a browser; discarded if it is no JSON, or nested so deeply that to copy it could
/// take all of the stack. gaitd takes nothing that deep either.
inline nlohmann::json parse_message(std::string_view text) {
  if (daemon::json_shape(text).deepest > bounds::kRequestDepth) {
    return nlohmann::json::value_t::discarded;
  }
  return nlohmann::json::parse(text, nullptr, false);
}

}  // namespace gaitd::cli

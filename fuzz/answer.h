// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "fuzz/require.h"

namespace gaitd::fuzz {

// What a client reads must be one line of JSON-RPC, and an error must say what is wrong.
inline void check_answer(const std::string& line) {
  require(line.find('\n') == std::string::npos, "an answer is one line");
  const nlohmann::json answer = nlohmann::json::parse(line, nullptr, false);
  require(answer.is_object() || answer.is_array(), "an answer is JSON");
  for (const auto& one : answer.is_array() ? answer : nlohmann::json::array({answer})) {
    require(one.contains("result") != one.contains("error"), "a result or an error");
    if (!one.contains("error")) continue;
    require(!one["error"]["message"].get<std::string>().empty(), "an error has a reason");
  }
}

}  // namespace gaitd::fuzz

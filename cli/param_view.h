// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace gaitd::cli {

/// The result of param.list, param.get or param.set for people; "" if it is none.
std::string param_text(const std::string& method, const nlohmann::json& result);

}  // namespace gaitd::cli

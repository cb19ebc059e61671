// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/parameter_methods.h"

#include <string>
#include <utility>

#include "gaitd/sdk/bounds.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;

RpcError invalid(const char* method, const std::string& what) {
  return {rpc_code::kInvalidParams, std::string(method) + ": " + what};
}

// The one text that params hold under `key`; nothing else may be there. Null params: "".
bool read_text(const json& params, const char* key, std::string* out) {
  if (params.empty()) return true;
  if (!params.is_object() || params.size() != 1) return false;
  const auto found = params.find(key);
  if (found == params.end() || !found->is_string()) return false;
  *out = found->get<std::string>();
  return true;
}

RpcResult list(const LiveParameters& parameters, const json& params) {
  std::string glob;
  if (!read_text(params, "match", &glob) || glob.size() > bounds::kParameterGlob) {
    return invalid("param.list", "expected {\"match\": a glob like \"gait.*\", at most " +
                                     std::to_string(bounds::kParameterGlob) +
                                     " characters} or no params");
  }
  json rows = json::array();
  for (int i : parameters.match(glob)) rows.push_back(parameters.describe(i));
  if (!rows.empty()) return json{{"parameters", std::move(rows)}};
  std::string error;
  if (parameters.find(glob, &error) >= 0) error = "nothing matches " + glob;
  return invalid("param.list", error);
}

RpcResult get(const LiveParameters& parameters, const json& params) {
  std::string name;
  if (!read_text(params, "name", &name) || name.empty()) {
    return invalid("param.get", R"(expected {"name": a parameter})");
  }
  std::string error;
  const int index = parameters.find(name, &error);
  if (index < 0) return invalid("param.get", error);
  return parameters.describe(index);
}

void set(const LiveParameters& parameters, CommandBridge* bridge, const json& params,
         const Caller& caller, Respond respond) {
  std::string error;
  auto command = parameters.parse_set(params, &error);
  if (!command) return respond(invalid("param.set", error));
  const LiveParameters::Row& row = parameters.row(command->parameter_index);
  if (is_guarded(row.key) && caller.role < Role::kAdminister) {
    return respond(no_right("param.set " + row.key, Role::kAdminister, caller));
  }
  bridge->submit(*command, caller, [&row, respond = std::move(respond)](RpcResult result) {
    if (auto* done = std::get_if<json>(&result)) {
      (*done)["name"] = row.key;
      (*done)["unit"] = row.declared.unit;
      for (const char* key : {"old", "value"}) {
        (*done)[key] = parameter_value(row.declared, (*done)[key].get<double>());
      }
    }
    respond(std::move(result));
  });
}

}  // namespace

void add_parameter_methods(Methods* methods, CommandBridge* bridge,
                           const LiveParameters* parameters) {
  methods->add("param.list", [parameters](const json& p) { return list(*parameters, p); });
  methods->add("param.get", [parameters](const json& p) { return get(*parameters, p); });
  methods->add_async("param.set",
                     [parameters, bridge](const json& p, const Caller& caller, Respond respond) {
                       set(*parameters, bridge, p, caller, std::move(respond));
                     });
}

}  // namespace gaitd::daemon

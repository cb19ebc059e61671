// SPDX-License-Identifier: Apache-2.0
// What refusals look like. Whatever a client does wrong, it is told what was wrong and what would
// be right: each message has the marks of one of these rows.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>

namespace gaitd::storm {

struct RefusalRow {
  int code;
  std::initializer_list<std::string_view> marks;  // all of them, in this order
};

inline const RefusalRow kRefusals[] = {
    // The line or the request.
    {-32700, {"not JSON: ", "; expected one JSON object or array per line"}},
    {-32700, {"the connection ended within a request; end it with a newline"}},
    {-32600, {"invalid request: ", "; expected {\"jsonrpc\": \"2.0\""}},
    {-32600, {"invalid request: ", "stands twice in one object; leave one of them out"}},
    {-32600, {"invalid request: a batch of ", ", expected 1 to "}},
    {-32600, {"invalid request: nested deeper than ", " levels"}},
    {-32600, {"invalid request: longer than ", " bytes; the connection is closed"}},
    {-32601, {"no method \"", "\"; there is: "}},
    // Parameters: key, what was expected, what came.
    {-32602, {": expected ", ", got "}},
    {-32602, {": unknown key; ", ""}},
    {-32602, {": takes no params, got "}},
    {-32602, {"param.", ": expected {"}},
    {-32602, {"param.", ": no such parameter; "}},
    {-32602, {"param.", "; nothing was changed"}},
    {-32602, {"param.", "restart: "}},
    {-32602, {"param.list: nothing matches "}},
    // The state of the robot, and what its legs can do.
    {-32000, {"footstep ", " expected"}},
    {-32000, {"walk: ", " expected"}},
    {-32000, {"walk: ", " must be "}},
    {-32000, {"walk: ", "gaitctl mode "}},
    {-32000, {"drive: ", "; ", "gaitctl "}},
    {-32000, {"steps: ", " expected"}},
    {-32000, {"steps: ", "gaitctl mode "}},
    {-32000, {" footsteps: the queue has room for ", "; send fewer, or wait"}},
    {-32000, {"a fault is latched; ", "gaitctl reset"}},
    {-32000, {"the robot is not standing yet; ", "gaitctl arm"}},
    {-32000, {"arm: ", "; ", "gaitctl "}},
    {-32000, {"disarm: ", "; ", "gaitctl "}},
    {-32000, {"sim push: ", "; "}},
    {-32000, {" can only be changed while the robot stands: ", "; "}},
    {-32000, {" can only be set while the robot stands, ", " expected: ", "; "}},
    {-32002,
     {"busy: ", " commands of this connection wait for the control thread already; send fewer "}},
    {-32002, {"busy: ", " clients are connected already; "}},
    {-32002, {"busy: gaitd has no file descriptor left; "}},
};

inline bool names_its_reason(int code, std::string_view message) {
  return std::any_of(std::begin(kRefusals), std::end(kRefusals), [&](const RefusalRow& row) {
    std::size_t at = 0;
    for (const std::string_view mark : row.marks) {
      const std::size_t found = message.find(mark, at);
      if (found == std::string_view::npos) return false;
      at = found + mark.size();
    }
    return row.code == code;
  });
}

}  // namespace gaitd::storm

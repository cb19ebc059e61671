// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <optional>
#include <string>

#include "cli/view/web_server.h"

namespace gaitd::cli {

using HttpRequest = boost::beast::http::request<boost::beast::http::empty_body>;
using HttpResponse = boost::beast::http::response<boost::beast::http::string_body>;

/// What becomes of a request: an answer, or with a role a WebSocket.
struct Handshake {
  HttpResponse answer;
  std::optional<daemon::Role> role;
  std::string protocol;  ///< subprotocol that was agreed on
};

/// Host, origin and token are looked at here and nowhere else.
Handshake receive(const HttpRequest& request, WebContent* content, bool tls);

}  // namespace gaitd::cli

// SPDX-License-Identifier: Apache-2.0
#include "cli/view/handshake.h"

#include <boost/beast/http/field.hpp>
#include <boost/beast/http/status.hpp>
#include <boost/beast/http/verb.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <string_view>

namespace gaitd::cli {
namespace {

namespace http = boost::beast::http;

std::string_view text(boost::beast::string_view view) { return {view.data(), view.size()}; }

HttpResponse answer(const HttpRequest& request, http::status status, std::string body) {
  HttpResponse response(status, request.version());
  response.set(http::field::server, "gaitctl view");
  response.set(http::field::content_type, "text/plain; charset=utf-8");
  response.set(http::field::cache_control, "no-store");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.keep_alive(request.keep_alive());
  response.body() = std::move(body);
  response.prepare_payload();
  return response;
}

// A browser cannot set headers of a WebSocket: its token comes as a subprotocol "token.HEX", that
// of other programs as ?token=HEX or a header.
std::string token_of(const HttpRequest& request) {
  constexpr std::string_view kBearer = "Bearer ";
  const std::string_view header = text(request[http::field::authorization]);
  if (header.starts_with(kBearer)) return std::string(header.substr(kBearer.size()));
  for (const auto protocol : http::token_list(request[http::field::sec_websocket_protocol])) {
    if (text(protocol).starts_with("token.")) return std::string(text(protocol).substr(6));
  }
  const std::string_view target = text(request.target());
  const std::size_t query = target.find("token=");
  if (query == std::string_view::npos || target.find('?') > query) return "";
  return std::string(target.substr(query + 6, target.find('&', query) - query - 6));
}

}  // namespace

Handshake receive(const HttpRequest& request, WebContent* content, bool tls) {
  const Access& access = content->access();
  const std::string_view host = text(request[http::field::host]);
  const std::string_view origin = text(request[http::field::origin]);
  const std::string target(text(request.target()));
  const std::string path = target.substr(0, target.find('?'));
  const auto refuse = [&](http::status status, const std::string& why) {
    return Handshake{answer(request, status, why + "\n"), std::nullopt, {}};
  };
  if (!Access::is_own_host(host)) {
    return refuse(http::status::misdirected_request,
                  "this is not the host that was asked for; use the address that gaitctl view "
                  "printed");
  }
  if (!access.allows_origin(origin, host, tls)) {
    return refuse(http::status::forbidden,
                  "a page of another origin may not connect; --origin allows one");
  }
  const std::string token = token_of(request);
  if (boost::beast::websocket::is_upgrade(request)) {
    const auto role = access.role_of(token);
    if (!role) {
      return refuse(http::status::unauthorized,
                    "no valid token; use the address that gaitctl view printed");
    }
    const std::string offered(text(request[http::field::sec_websocket_protocol]));
    std::string protocol = content->choose_protocol(path, offered);
    if (protocol.empty()) return refuse(http::status::bad_request, "no such WebSocket");
    return {{}, role, std::move(protocol)};
  }
  if (request.method() != http::verb::get && request.method() != http::verb::head) {
    return refuse(http::status::method_not_allowed, "only GET");
  }
  const WebAnswer page = content->get(path, token);
  Handshake result;
  result.answer =
      answer(request, static_cast<http::status>(page.status), page.body ? *page.body : "");
  result.answer.set(http::field::content_type, page.type);
  if (!page.policy.empty()) result.answer.set("Content-Security-Policy", page.policy);
  if (request.method() == http::verb::head) result.answer.body().clear();
  return result;
}

}  // namespace gaitd::cli

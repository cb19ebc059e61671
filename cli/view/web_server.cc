// SPDX-License-Identifier: Apache-2.0
#include "cli/view/web_server.h"

#include <cerrno>
#include <utility>

#include "cli/view/web_session.h"

namespace gaitd::cli {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using boost::system::error_code;
using tcp = asio::ip::tcp;

}  // namespace

bool WebServer::listen(const ListenAddress& address, std::string* error) {
  const tcp::endpoint endpoint(asio::ip::make_address(address.address), address.port);
  error_code failed;
  acceptor_.open(endpoint.protocol(), failed);
  if (!failed) acceptor_.set_option(asio::socket_base::reuse_address(true), failed);
  if (!failed) acceptor_.bind(endpoint, failed);
  if (!failed) acceptor_.listen(asio::socket_base::max_listen_connections, failed);
  if (failed) {
    *error = "cannot listen on " + address.address + ":" + std::to_string(address.port) + ": " +
             failed.message() +
             (failed.value() == EADDRINUSE
                  ? "; another `gaitctl view` may run there: use it, or choose another port with "
                    "--listen"
                  : "; choose another address with --listen");
    return false;
  }
  accept();
  return true;
}

void WebServer::stop() {
  error_code ignored;
  acceptor_.close(ignored);
  retry_.cancel();
}

void WebServer::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (!acceptor_.is_open()) return;
    if (error) {  // no descriptor is free, say
      retry_.expires_after(std::chrono::milliseconds(100));
      retry_.async_wait([this](error_code) {
        if (acceptor_.is_open()) accept();
      });
      return;
    }
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    if (*connections_ < kConnections) {
      ++*connections_;
      std::shared_ptr<void> place(nullptr, [count = connections_](void*) { --*count; });
      if (tls_ != nullptr) {
        std::make_shared<WebSession<beast::ssl_stream<beast::tcp_stream>>>(
            beast::ssl_stream<beast::tcp_stream>(std::move(socket), *tls_), content_,
            std::move(place))
            ->start();
      } else {
        std::make_shared<WebSession<beast::tcp_stream>>(beast::tcp_stream(std::move(socket)),
                                                        content_, std::move(place))
            ->start();
      }
    }
    accept();
  });
}

}  // namespace gaitd::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "cli/live/message.h"
#include "cli/view/access.h"

namespace gaitd::cli {

/// What a GET asks for and gets.
struct WebAnswer {
  unsigned status = 404;
  std::string type = "text/plain; charset=utf-8";
  Message body;
  std::string policy;  ///< Content-Security-Policy
};

/// The WebSocket of a browser.
class ViewerSocket {
 public:
  virtual ~ViewerSocket() = default;
  virtual void send(Message message, bool binary) = 0;
  /// Messages, and their bytes, that the browser has not taken yet.
  virtual std::size_t waiting() const = 0;
  virtual std::size_t waiting_bytes() const = 0;
  virtual void close(const std::string& reason) = 0;
};

/// Who is at the other end of it, once it is open.
struct WebPeer {
  virtual ~WebPeer() = default;
  virtual void on_message(std::string_view text, bool binary) = 0;
  virtual void on_end() = 0;
};

/// What the server shows. All on the thread of the io_context.
class WebContent {
 public:
  virtual ~WebContent() = default;
  virtual const Access& access() const = 0;
  /// `token`: of the Authorization header; empty: none.
  virtual WebAnswer get(std::string_view path, std::string_view token) = 0;
  /// The subprotocol to agree on out of those that the client offers; empty: none fits.
  virtual std::string choose_protocol(std::string_view path, std::string_view offered) = 0;
  virtual std::shared_ptr<WebPeer> open(daemon::Role role, const std::string& protocol,
                                        std::shared_ptr<ViewerSocket> socket) = 0;
};

/// HTTP and WebSocket on one port, with TLS where `tls` is given. Foreign hosts, foreign origins
/// and WebSockets without a token are refused before anything is read from them.
class WebServer {
 public:
  static constexpr int kConnections = 256;

  WebServer(boost::asio::io_context* io, WebContent* content, boost::asio::ssl::context* tls)
      : io_(io), content_(content), tls_(tls), acceptor_(*io), retry_(*io) {}
  /// False with the reason: the port is taken, ... Port 0: any; port() tells which.
  bool listen(const ListenAddress& address, std::string* error);
  unsigned short port() const { return acceptor_.local_endpoint().port(); }
  void stop();

 private:
  void accept();

  boost::asio::io_context* io_;
  WebContent* content_;
  boost::asio::ssl::context* tls_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer retry_;
  std::shared_ptr<int> connections_ = std::make_shared<int>(0);
};

}  // namespace gaitd::cli

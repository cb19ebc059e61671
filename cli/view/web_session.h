// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/view/handshake.h"
#include "cli/view/web_server.h"

namespace gaitd::cli {

/// The WebSocket of one browser, over TCP or TLS.
template <class Stream>
class WebSocketSession : public ViewerSocket,
                         public std::enable_shared_from_this<WebSocketSession<Stream>> {
 public:
  WebSocketSession(Stream stream, std::shared_ptr<void> place)
      : socket_(std::move(stream)), place_(std::move(place)), patience_(socket_.get_executor()) {}

  /// `protocol`: agreed subprotocol; empty: none was asked for.
  void start(const HttpRequest& request, WebContent* content, daemon::Role role,
             const std::string& protocol) {
    namespace websocket = boost::beast::websocket;
    hold_little();
    socket_.set_option(websocket::stream_base::timeout{
        std::chrono::seconds(10), std::chrono::seconds(20), true});  // pings find who has gone
    socket_.set_option(websocket::stream_base::decorator([protocol](auto& response) {
      if (!protocol.empty()) response.set("Sec-WebSocket-Protocol", protocol);
    }));
    socket_.read_message_max(kLongestMessage);
    socket_.auto_fragment(false);
    socket_.async_accept(request, [self = this->shared_from_this(), content, role,
                                   protocol](boost::system::error_code error) {
      if (error) return;
      self->peer_ = content->open(role, protocol, self);
      self->read();
    });
  }

  void send(Message message, bool binary) override {
    if (closing_) return;
    waiting_bytes_ += message->size();
    output_.push_back({std::move(message), binary});
    if (output_.size() == 1) write();
  }
  std::size_t waiting() const override { return output_.size(); }
  std::size_t waiting_bytes() const override { return waiting_bytes_; }
  void close(const std::string& reason) override {
    if (std::exchange(closing_, true)) return;
    reason_ = reason.substr(0, 100);
    if (output_.empty()) {
      say_goodbye();
    } else {
      output_.erase(output_.begin() + 1, output_.end());  // the first is being written
      waiting_bytes_ = output_.front().first->size();
    }
    // Who takes nothing takes no goodbye either.
    patience_.expires_after(kGoodbye);
    patience_.async_wait([weak = this->weak_from_this()](boost::system::error_code error) {
      const auto self = weak.lock();
      if (self && !error) boost::beast::get_lowest_layer(self->socket_).close();
    });
  }

 private:
  static constexpr std::size_t kLongestMessage = 64u << 10;  // bytes, from a browser
  static constexpr auto kGoodbye = std::chrono::seconds(3);
  static constexpr int kUnsent = 16 << 10;     // bytes
  static constexpr int kOnTheWay = 128 << 10;  // bytes

  // What the kernel keeps for a slow network is old when it arrives; what waits here can be left
  // out.
  void hold_little() {
    const int fd = boost::beast::get_lowest_layer(socket_).socket().native_handle();
    setsockopt(fd, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsent, sizeof(kUnsent));
    setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &kOnTheWay, sizeof(kOnTheWay));
  }

  void read() {
    socket_.async_read(buffer_, [self = this->shared_from_this()](boost::system::error_code error,
                                                                  std::size_t size) {
      if (error) return self->end();
      const auto data = self->buffer_.data();
      self->peer_->on_message({static_cast<const char*>(data.data()), size},
                              self->socket_.got_binary());
      self->buffer_.consume(size);
      self->read();
    });
  }
  void write() {
    socket_.binary(output_.front().second);
    socket_.async_write(
        boost::asio::buffer(*output_.front().first),
        [self = this->shared_from_this()](boost::system::error_code error, std::size_t size) {
          self->waiting_bytes_ -= size;
          self->output_.pop_front();
          if (error) return;  // the read ends too
          if (!self->output_.empty()) return self->write();
          if (self->closing_) self->say_goodbye();
        });
  }
  void say_goodbye() {
    namespace websocket = boost::beast::websocket;
    socket_.async_close(websocket::close_reason(websocket::close_code::policy_error, reason_),
                        [self = this->shared_from_this()](boost::system::error_code) {});
  }
  void end() {
    patience_.cancel();
    if (const auto peer = std::exchange(peer_, nullptr)) peer->on_end();
  }

  boost::beast::websocket::stream<Stream> socket_;
  std::shared_ptr<void> place_;  // among the connections
  boost::beast::flat_buffer buffer_;
  std::deque<std::pair<Message, bool>> output_;
  std::size_t waiting_bytes_ = 0;
  bool closing_ = false;
  std::string reason_;
  boost::asio::steady_timer patience_;  // with whoever is told to go
  std::shared_ptr<WebPeer> peer_;
};

/// One connection until it is answered, or becomes a WebSocket.
template <class Stream>
class WebSession : public std::enable_shared_from_this<WebSession<Stream>> {
 public:
  WebSession(Stream stream, WebContent* content, std::shared_ptr<void> place)
      : stream_(std::move(stream)), content_(content), place_(std::move(place)) {}

  void start() {
    lowest().expires_after(kPatience);
    if constexpr (kTls) {
      stream_.async_handshake(boost::asio::ssl::stream_base::server,
                              [self = this->shared_from_this()](boost::system::error_code error) {
                                if (!error) self->read();
                              });
    } else {
      read();
    }
  }

 private:
  static constexpr bool kTls = !std::is_same_v<Stream, boost::beast::tcp_stream>;
  static constexpr auto kPatience =
      std::chrono::seconds(10);  // for a request, and to take its answer

  auto& lowest() { return boost::beast::get_lowest_layer(stream_); }

  void read() {
    parser_.emplace();
    parser_->body_limit(0);
    parser_->header_limit(8192);
    lowest().expires_after(kPatience);
    boost::beast::http::async_read(
        stream_, buffer_, *parser_,
        [self = this->shared_from_this()](boost::system::error_code error, std::size_t) {
          if (!error) self->handle(self->parser_->release());
        });
  }

  void handle(const HttpRequest& request) {
    Handshake handshake = receive(request, content_, kTls);
    if (!handshake.role) return write(std::move(handshake.answer));
    lowest().expires_never();  // the WebSocket has timeouts of its own
    auto socket = std::make_shared<WebSocketSession<Stream>>(std::move(stream_), place_);
    socket->start(request, content_, *handshake.role, handshake.protocol);
  }

  void write(HttpResponse response) {
    response_ = std::move(response);
    boost::beast::http::async_write(
        stream_, response_,
        [self = this->shared_from_this()](boost::system::error_code error, std::size_t) {
          if (!error && self->response_.keep_alive()) return self->read();
          self->finish();
        });
  }
  void finish() {
    boost::system::error_code ignored;
    lowest().socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  }

  Stream stream_;
  WebContent* content_;
  std::shared_ptr<void> place_;  // among the connections
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> parser_;
  HttpResponse response_;
};

}  // namespace gaitd::cli

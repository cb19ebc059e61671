// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "cli/live/gaitd_link.h"
#include "cli/live/live_source.h"
#include "cli/live/rpc_relay.h"
#include "cli/view/foxglove_channels.h"
#include "cli/view/foxglove_client.h"
#include "cli/view/recorder.h"
#include "cli/view/viewer.h"
#include "cli/view/web_server.h"

namespace gaitd::cli {

/// What `gaitctl view` serves: the page, the live stream for every viewer, the reports of
/// recordings. All on the thread of its io_context.
class LiveView : public WebContent {
 public:
  LiveView(boost::asio::io_context* io, const std::string& socket, Access access, std::string page,
           std::string log_folder);

  void start() { source_.start(); }
  void stop();

  // WebContent
  const Access& access() const override { return access_; }
  WebAnswer get(std::string_view path, std::string_view token) override;
  std::string choose_protocol(std::string_view path, std::string_view offered) override;
  std::shared_ptr<WebPeer> open(daemon::Role role, const std::string& protocol,
                                std::shared_ptr<ViewerSocket> socket) override;

 private:
  class Peer;
  class FoxglovePeer;
  void record(bool on);
  void on_robot();
  void on_frame(const LiveFrame& frame);
  void on_event(const daemon::Event& event);
  void show_channels();
  // All signals while somebody records or Foxglove is there.
  void choose_signals();
  void send_all(const Message& message);
  void tell_viewers();
  void tell_recording(const Recorder::End* end, const std::string& error);
  void begin_recording();

  Access access_;
  Message page_;
  GaitdConnector connector_;
  LiveSource source_;
  Recorder recorder_;
  std::set<std::shared_ptr<Viewer>> viewers_;
  std::set<std::shared_ptr<FoxgloveClient>> foxgloves_;
  std::unique_ptr<FoxgloveChannels> channels_;
  Message robot_;                    // what a new viewer is told first
  std::vector<std::size_t> places_;  // of the signals of the page in a frame
  bool wants_recording_ = false;
  double recording_since_ = 0.0;  // s
  double newest_time_ = 0.0;      // s
};

/// The page of this installation. Empty with the reason where there is none.
std::string live_page(std::string* error);

}  // namespace gaitd::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cli/live/live_source.h"
#include "daemon/log/records_codec.h"
#include "daemon/log/signal_codec.h"
#include "daemon/telemetry/message_sink.h"
#include "daemon/telemetry/scene_topics.h"

namespace gaitd::cli {

/// The channels of a log, live: signals, scene, transforms, joint states and events, in the
/// messages that the log holds, so that one layout shows both.
class FoxgloveChannels : private daemon::MessageSink {
 public:
  /// Gets each message with the number of its channel; `once`: it is not said again.
  using OnMessage = std::function<void(std::uint16_t channel, std::uint64_t time_ns,
                                       std::string_view data, bool once)>;

  /// `robot`: answer of robot.describe; `table`: signals of the frames that will come.
  FoxgloveChannels(const nlohmann::json& robot, const daemon::SignalTable& table,
                   OnMessage on_message);
  ~FoxgloveChannels() override;

  /// As `advertise` of the protocol lists them.
  const nlohmann::json& list() const { return list_; }
  void add(const LiveFrame& frame);
  void add(const daemon::Event& event);
  /// Says again what is said once: for a client that has just come.
  void begin_again();

 private:
  std::uint16_t add_schema(const std::string& name, const std::string& encoding,
                           const std::string& data) override;
  std::uint16_t add_channel(std::uint16_t schema, const std::string& topic,
                            const std::string& message_encoding,
                            const std::map<std::string, std::string>& metadata) override;
  std::string& begin_message(std::uint16_t channel, std::uint64_t time_ns) override;
  void end_message() override;

  struct Schema {
    std::string name, encoding, data;
  };
  OnMessage on_message_;
  daemon::SignalCodec codec_;
  daemon::RecordsCodec records_;
  std::vector<Schema> schemas_;
  nlohmann::json list_ = nlohmann::json::array();
  std::uint16_t signals_ = 0;
  std::uint16_t events_ = 0;
  std::unique_ptr<daemon::SceneTopics> scene_;  // null where the robot cannot be drawn
  std::size_t width_;                           // signals of a frame
  std::string message_;
  std::uint16_t channel_ = 0;
  std::uint64_t time_ns_ = 0;
  bool once_ = false;
};

}  // namespace gaitd::cli

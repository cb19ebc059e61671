// SPDX-License-Identifier: Apache-2.0
#include "cli/view/foxglove_channels.h"

#include <utility>

#include "cli/live/robot_metadata.h"
#include "daemon/log/log_format.h"
#include "daemon/server/base64.h"
#include "daemon/telemetry/log_writer.h"
#include "daemon/telemetry/signal_schema.h"

namespace gaitd::cli {
FoxgloveChannels::FoxgloveChannels(const nlohmann::json& robot, const daemon::SignalTable& table,
                                   OnMessage on_message)
    : on_message_(std::move(on_message)), codec_(table), width_(table.size()) {
  signals_ = FoxgloveChannels::add_channel(
      FoxgloveChannels::add_schema(daemon::kSignalsMessage, "protobuf",
                                   daemon::signal_schema(table)),
      daemon::kSignalsTopic, "protobuf", {});
  events_ = FoxgloveChannels::add_channel(
      FoxgloveChannels::add_schema(daemon::kEventMessage, "protobuf", daemon::records_schema()),
      daemon::kEventsTopic, "protobuf", {});
  scene_ = daemon::SceneTopics::create(log_metadata_of(robot), table);
  if (scene_) scene_->add_channels(this);
}

FoxgloveChannels::~FoxgloveChannels() = default;

void FoxgloveChannels::add(const LiveFrame& frame) {
  if (frame.values.size() != width_) return;
  const std::uint64_t time_ns = daemon::to_nanoseconds(frame.time);
  once_ = false;
  codec_.append(frame.values, &begin_message(signals_, time_ns));
  end_message();
  if (!scene_) return;
  once_ = !scene_->begun();  // robot and terrain
  scene_->write(time_ns, frame.values, this);
}

void FoxgloveChannels::add(const daemon::Event& event) {
  once_ = true;
  records_.append_event(event, &begin_message(events_, daemon::to_nanoseconds(event.time)));
  end_message();
}

void FoxgloveChannels::begin_again() {
  if (scene_) scene_->begin_again();
}

std::uint16_t FoxgloveChannels::add_schema(const std::string& name, const std::string& encoding,
                                           const std::string& data) {
  schemas_.push_back({name, encoding, daemon::base64(data)});
  return static_cast<std::uint16_t>(schemas_.size());
}

std::uint16_t FoxgloveChannels::add_channel(std::uint16_t schema, const std::string& topic,
                                            const std::string& message_encoding,
                                            const std::map<std::string, std::string>&) {
  const auto id = static_cast<std::uint16_t>(list_.size() + 1);
  const Schema& of = schemas_[schema - 1u];
  list_.push_back({{"id", id},
                   {"topic", topic},
                   {"encoding", message_encoding},
                   {"schemaName", of.name},
                   {"schemaEncoding", of.encoding},
                   {"schema", of.data}});
  return id;
}

std::string& FoxgloveChannels::begin_message(std::uint16_t channel, std::uint64_t time_ns) {
  channel_ = channel;
  time_ns_ = time_ns;
  message_.clear();
  return message_;
}

void FoxgloveChannels::end_message() { on_message_(channel_, time_ns_, message_, once_); }

}  // namespace gaitd::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace gaitd::daemon {

// Where messages with a schema go: a log file, or the clients of a live stream.
class MessageSink {
 public:
  virtual ~MessageSink() = default;
  virtual std::uint16_t add_schema(const std::string& name, const std::string& encoding,
                                   const std::string& data) = 0;
  virtual std::uint16_t add_channel(std::uint16_t schema, const std::string& topic,
                                    const std::string& message_encoding,
                                    const std::map<std::string, std::string>& metadata) = 0;
  // Starts a message and returns the buffer to append its data to; end_message() completes it.
  virtual std::string& begin_message(std::uint16_t channel, std::uint64_t time_ns) = 0;
  virtual void end_message() = 0;
};

}  // namespace gaitd::daemon

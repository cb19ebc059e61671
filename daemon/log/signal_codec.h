// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/log/signal.h"

namespace gaitd::daemon {

struct SignalNode;

// Protobuf messages of the signals of a tick. Every field is always there and has a constant width,
// so all messages of a table are equal but for the bytes of the values: encoding copies a template
// and puts the values in their places.
class SignalCodec {
 public:
  // The table must be valid.
  explicit SignalCodec(const SignalTable& table);

  std::size_t message_size() const { return template_.size(); }

  // One value per signal, in table order.
  void append(std::span<const double> values, std::string* out) const;

  // The message has the size and, outside its values, the bytes that append() gives.
  bool matches(std::string_view message) const;

  // Of a message that matches.
  double value(std::string_view message, std::size_t signal) const;

 private:
  struct Place {
    std::size_t offset = 0;  // of the value in the message
    SignalDescription::Kind kind = SignalDescription::Kind::kReal;
    int words = 0;
  };

  std::string encode(const SignalTable& table, const SignalNode& node, std::size_t offset);

  std::vector<Place> places_;  // by signal
  std::string template_;
  std::vector<std::pair<std::size_t, std::size_t>> fixed_;  // offset, size: between the values
};

}  // namespace gaitd::daemon

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "daemon/log/event.h"
#include "gaitd/abi/types.h"

namespace gaitd::daemon {

inline constexpr char kSensorsMessage[] = "gaitd.telemetry.Sensors";
inline constexpr char kEventMessage[] = "gaitd.telemetry.Event";

// Sensors and events as the protobuf messages of records.proto. Keeps its messages from one call to
// the next, so as to allocate little; one object per thread.
class RecordsCodec {
 public:
  RecordsCodec();
  ~RecordsCodec();
  RecordsCodec(const RecordsCodec&) = delete;
  RecordsCodec& operator=(const RecordsCodec&) = delete;

  // Counts beyond the maxima of the struct are taken as the maxima.
  void append_sensors(const GaitdSensors& sensors, std::string* out);

  // Every double comes back bit by bit; what the counts do not cover is zero. False if the bytes
  // are no such message or hold more joints, IMUs or feet than the struct.
  bool parse_sensors(std::string_view bytes, GaitdSensors* sensors);

  void append_event(const Event& event, std::string* out);
  bool parse_event(std::string_view bytes, Event* event);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The serialised FileDescriptorSet of records.proto.
std::string records_schema();

}  // namespace gaitd::daemon

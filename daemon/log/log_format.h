// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

namespace gaitd::daemon {

// Names inside a log file, shared by writer and reader.
inline constexpr char kSignalsTopic[] = "/gaitd/signals";
inline constexpr char kSensorsTopic[] = "/gaitd/sensors";
inline constexpr char kEventsTopic[] = "/gaitd/events";
inline constexpr char kStartMetadata[] = "gaitd";    // given when the file is opened
inline constexpr char kEndMetadata[] = "gaitd.end";  // given when it is closed
inline constexpr char kTableKey[] = "signal_table";  // of the metadata of the signals channel
inline constexpr char kLayoutKey[] = "layout";
inline constexpr char kLayoutVersion[] = "1";

using LogMetadata = std::map<std::string, std::string>;

}  // namespace gaitd::daemon

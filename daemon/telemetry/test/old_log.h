// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "daemon/log/bytes.h"
#include "daemon/log/crc32.h"
#include "daemon/log/mcap_format.h"

namespace gaitd::daemon {

// The bytes of a finished log as they were written before there were seals.
inline std::string without_seals(const std::string& bytes) {
  constexpr std::size_t kEnd = mcap::kRecordHeaderSize + 8 + 8 + 4 + 8;  // footer and magic
  std::string old = bytes.substr(0, mcap::kMagic.size());
  std::size_t at = old.size();
  for (bool data = true; data;) {
    ByteReader head(std::string_view(bytes).substr(at, mcap::kRecordHeaderSize));
    const auto opcode = head.take<std::uint8_t>();
    const std::size_t size = mcap::kRecordHeaderSize + head.take<std::uint64_t>();
    std::string record = bytes.substr(at, size);
    data = opcode != mcap::kDataEnd;
    if (!data) std::memset(record.data() + mcap::kRecordHeaderSize, 0, 4);  // no checksum
    if (opcode != mcap::kSeal) old += record;
    at += size;
  }
  // Every offset in the summary is another one now; a reader of ours looks at none but this.
  std::string summary = bytes.substr(at, bytes.size() - kEnd - at);
  put(summary, static_cast<std::uint8_t>(mcap::kFooter));
  put(summary, std::uint64_t{20});
  put(summary, static_cast<std::uint64_t>(old.size()));
  put(summary, std::uint64_t{0});
  put(summary, crc32(summary));
  return old + summary + std::string(mcap::kMagic);
}

}  // namespace gaitd::daemon

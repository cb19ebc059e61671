// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/log/input_file.h"
#include "daemon/log/mcap_format.h"

namespace gaitd::daemon {

// A record of our own that follows every record outside the chunks, and every chunk with its
// message indexes: the checksum of all bytes since the end of the seal before. A file that was cut
// off is covered up to its last seal, and damage is found at its place. Readers of MCAP skip
// records of applications.
struct Seal {
  std::uint64_t start = 0;   // of what it covers, byte of the file; the end is the seal itself
  std::uint32_t before = 0;  // checksum of the file up to `start`
  std::uint32_t after = 0;   // checksum of the file up to the seal
};

inline constexpr std::uint64_t kSealContentSize = 8 + 4 + 4 + 4;  // bytes, without the head
inline constexpr std::uint64_t kSealSize = mcap::kRecordHeaderSize + kSealContentSize;

std::string encode_seal(const Seal& seal);  // the content of the record

// Nothing if these bytes are no content of a seal, or of a damaged one: it has a checksum itself.
std::optional<Seal> parse_seal(std::string_view content);

// The first sound seal at or after a byte of the file.
struct FoundSeal {
  std::uint64_t offset = 0;
  Seal seal;
};
std::optional<FoundSeal> find_seal(const InputFile& file, std::uint64_t from);

// Checksum of bytes of the file, going on from `so_far`. Nothing if they are not all there.
std::optional<std::uint32_t> file_crc32(const InputFile& file, std::uint64_t begin,
                                        std::uint64_t end, std::uint32_t so_far);

}  // namespace gaitd::daemon

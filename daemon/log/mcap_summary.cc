// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/mcap_summary.h"

#include "daemon/log/bytes.h"
#include "daemon/log/mcap_format.h"
#include "daemon/log/seal.h"

namespace gaitd::daemon {

namespace {

constexpr std::uint64_t kFooterContent = 8 + 8 + 4;
constexpr std::uint64_t kFooterSize = mcap::kRecordHeaderSize + kFooterContent;

void read_counts(std::string_view content, McapSummary* summary) {
  ByteReader reader(content);
  reader.take_bytes(8 + 2 + 4 + 4 + 4 + 4 + 8 + 8);  // totals and times
  ByteReader counts(reader.take_string());
  while (counts.ok() && !counts.rest().empty()) {
    const auto channel = counts.take<std::uint16_t>();
    summary->message_counts[channel] = counts.take<std::uint64_t>();
  }
}

}  // namespace

std::optional<McapSummary> read_summary(const InputFile& file, std::string* error) {
  const std::uint64_t end = mcap::kMagic.size() + kFooterSize;
  std::string footer;
  if (file.size() < end || !file.read(file.size() - end, end, &footer) ||
      !footer.ends_with(mcap::kMagic)) {
    *error = "the file does not end as a finished one does";
    return std::nullopt;
  }
  ByteReader reader(footer);
  const auto opcode = reader.take<std::uint8_t>();
  const auto length = reader.take<std::uint64_t>();
  const auto start = reader.take<std::uint64_t>();
  reader.take<std::uint64_t>();  // where the offsets of the summary stand
  const auto checksum = reader.take<std::uint32_t>();
  const std::uint64_t stop = file.size() - mcap::kMagic.size() - sizeof(checksum);
  const bool plausible = opcode == mcap::kFooter && length == kFooterContent && start < stop &&
                         stop - start <= kMaxMcapRecord;
  if (!plausible || file_crc32(file, start, stop, 0) != checksum) {
    *error = "the summary at the end of the file is damaged";
    return std::nullopt;
  }
  std::string bytes;
  if (!file.read(start, file.size() - end - start, &bytes)) return std::nullopt;
  McapSummary summary;
  ByteReader records(bytes);
  while (!records.rest().empty()) {
    const auto kind = records.take<std::uint8_t>();
    const std::string_view content = records.take_bytes(records.take<std::uint64_t>());
    if (!records.ok()) break;
    if (kind == mcap::kStatistics) read_counts(content, &summary);
    if (kind != mcap::kChannel) continue;
    if (auto channel = parse_channel(content)) summary.channels.push_back(std::move(*channel));
  }
  return summary;
}

}  // namespace gaitd::daemon

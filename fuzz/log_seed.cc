// SPDX-License-Identifier: Apache-2.0
// Writes the seeds of target `log` into a folder: small logs, without checksums, so that a changed
// byte gets past them to what reads the records, and one with all of them.
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "daemon/log/mcap_format.h"
#include "daemon/telemetry/log_writer.h"
#include "daemon/telemetry/test/old_log.h"

namespace gaitd::daemon {
namespace {

using Kind = SignalDescription::Kind;

SignalTable small_table() {
  return {{"time", "s", Kind::kReal, {}},
          {"tick", "", Kind::kInteger, {}},
          {"gait/phase", "", Kind::kEnumeration, {"stand", "transfer", "swing"}},
          {"toe_off/active", "", Kind::kBoolean, {}},
          {"joint/knee/position", "rad", Kind::kReal, {}}};
}

void write_log(const std::string& file, McapCompression compression) {
  LogWriter writer(small_table());
  std::string error;
  McapOptions options;
  options.compression = compression;
  options.chunk_bytes = 400;
  if (!writer.open(file, {{"robot", "atlas"}}, options, &error)) {
    std::fprintf(stderr, "%s\n", error.c_str());
    return;
  }
  const auto sensors = std::make_unique<GaitdSensors>();
  sensors->size = sizeof(GaitdSensors);
  sensors->joint_count = 1;
  for (int tick = 0; tick < 6; ++tick) {
    const double time = 0.001 * tick;
    const double values[] = {time, 1.0 * tick, 1.0 * (tick % 3), 1.0 * (tick % 2), 0.1 * tick};
    writer.write_tick(tick, time, values, tick % 2 == 0 ? sensors.get() : nullptr);
    if (tick != 3) continue;
    writer.write_event(
        {.tick = tick, .time = time, .kind = "dropout", .text = R"({"ticks":2,"events":0})"});
  }
  writer.close({{"realtime_factor", "5.5"}});
}

void clear_checksums(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes = without_seals({std::istreambuf_iterator<char>(in), {}});
  std::uint64_t length = 0;
  for (std::size_t at = mcap::kMagic.size(); at + mcap::kRecordHeaderSize < bytes.size();
       at += mcap::kRecordHeaderSize + length) {
    std::memcpy(&length, bytes.data() + at + 1, sizeof(length));
    constexpr std::size_t kChecksum = 8 + 8 + 8;  // after two times and the size
    if (bytes[at] == mcap::kChunk) {
      std::memset(bytes.data() + at + mcap::kRecordHeaderSize + kChecksum, 0, 4);
    }
  }
  std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace
}  // namespace gaitd::daemon

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: fuzz_log_seed FOLDER\n");
    return 2;
  }
  using namespace gaitd::daemon;
  const std::filesystem::path folder(argv[1]);
  for (const auto& [name, compression] : {std::pair("plain.mcap", McapCompression::kNone),
                                          std::pair("zstd.mcap", McapCompression::kZstd)}) {
    const std::string file = (folder / name).string();
    write_log(file, compression);
    clear_checksums(file);
    if (compression == McapCompression::kNone) {
      write_log((folder / "sealed.mcap").string(), compression);
    }
  }
  return 0;
}

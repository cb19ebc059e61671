// SPDX-License-Identifier: Apache-2.0
#include "cli/test/sample_log.h"

#include <gtest/gtest.h>

#include "daemon/telemetry/log_writer.h"

namespace gaitd::cli {

void write_sample_log(const std::string& path, double com_z) {
  using Kind = daemon::SignalDescription::Kind;
  const daemon::SignalTable table = {
      {"time", "s", Kind::kReal, {}},
      {"gait/phase", "", Kind::kEnumeration, {"stand", "transfer", "swing"}},
      {"com/z", "m", Kind::kReal, {}}};
  daemon::LogWriter writer(table);
  std::string error;
  ASSERT_TRUE(writer.open(path, {}, {}, &error)) << error;
  for (int tick = 0; tick < 1000; ++tick) {
    const double time = 0.001 * tick;
    const double values[] = {time, 0.0, com_z};
    writer.write_tick(tick, time, values, nullptr);
  }
  ASSERT_TRUE(writer.close()) << writer.error();
}

}  // namespace gaitd::cli

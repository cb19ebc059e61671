// SPDX-License-Identifier: Apache-2.0
#include "daemon/parameters/reference.h"

#include <gtest/gtest.h>

#include "gaitd/sdk/layer.h"

namespace gaitd::daemon {
namespace {

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

constexpr std::array<GaitdParameter, 2> kTable = {
    sdk::real_parameter("gain", "1/s", 0, 1e5, 2.5, "of a | b"),
    sdk::boolean_parameter("eager", true, "whether it hurries"),
};

PluginEntry entry(const char* variant) {
  PluginEntry e;
  e.layer = GAITD_LAYER_STEP_ADJUSTER;
  e.variant = variant;
  e.descriptor = sdk::make_descriptor(GAITD_LAYER_STEP_ADJUSTER, variant, "1.0.0", 1.0, kTable);
  return e;
}

TEST(Reference, HasATableForEachScopeAndVariant) {
  LiveParameters all;
  PluginEntry refused = entry("broken");
  refused.descriptor.reset();
  add_all_parameters({entry("one"), entry("two"), refused}, &all);
  const std::string text = parameter_reference(all);
  for (const DaemonScope& scope : daemon_scopes()) {
    EXPECT_HAS(text, "\n## " + std::string(scope.name) + ": ");
  }
  EXPECT_HAS(text, "\n## step_adjuster: one\n");
  EXPECT_HAS(text, "\n## step_adjuster: two\n");
  EXPECT_EQ(text.find("broken"), std::string::npos);
  EXPECT_HAS(text,
             "\n| `step_adjuster.gain` | tuning | 1/s | 0..1e+05 | 2.5 | at once | of a \\| b |\n"
             "| `step_adjuster.eager` | tuning |  | true, false | true | at once | whether it "
             "hurries |\n");
  EXPECT_HAS(text, "| `safety.ready_duration` | porting | s | 0.1..60 | 3 | at rest: ");
}

TEST(Reference, NumbersAreAsShortAsTheyCanBe) {
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(shortest(1.0), "1");
  EXPECT_EQ(shortest(1.0 / 3.0), "0.3333333333333333");
}

}  // namespace
}  // namespace gaitd::daemon

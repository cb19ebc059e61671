// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/telemetry/log_writer.h"
#include "daemon/verdict/verdict.h"

namespace gaitd::daemon {

// A made-up walk: 0.5 s standing, `steps` times 0.1 s transfer and 0.2 s swing, the right foot
// first, 0.1 s transfer, 0.5 s standing. Everything is perfect unless a test disturbs it.
class SyntheticRun {
 public:
  explicit SyntheticRun(int steps) : steps_(steps) {
    const std::vector<std::string> contact = {"none", "toe", "full"};
    add("time", "s");
    add("tick", "", SignalDescription::Kind::kInteger);
    add("tick/total_us", "us");
    add("safety/faults", "", SignalDescription::Kind::kInteger);
    enumeration("gait/phase", {"stand", "transfer", "swing"});
    enumeration("gait/support", {"left", "right", "both"});
    add("gait/step_index", "", SignalDescription::Kind::kInteger);
    add("gait/closing", "", SignalDescription::Kind::kBoolean);
    add("toe_off/active", "", SignalDescription::Kind::kBoolean);
    enumeration("wbc/status", {"solved", "max_iterations"});
    add("wbc/iterations", "", SignalDescription::Kind::kInteger);
    for (const char* name : {"icp/x", "icp/y", "icp/desired/x", "icp/desired/y", "pelvis/z",
                             "foot/left/z", "foot/right/z", "truth/pelvis/x", "truth/pelvis/y",
                             "truth/pelvis/z", "truth/foot/left/slip", "truth/foot/right/slip"}) {
      add(name, "m");
    }
    for (const char* name : {"truth/pelvis/roll", "truth/pelvis/pitch", "truth/pelvis/yaw",
                             "joint/l_knee/position", "joint/r_knee/position"}) {
      add(name, "rad");
    }
    for (const char* name : {"joint/l_knee/torque_desired", "joint/r_knee/torque_desired",
                             "joint/arm/torque_desired"}) {
      add(name, "N m");
    }
    for (const char* name : {"drive/step/forward", "drive/step/lateral", "drive/step/turn"}) {
      add(name, "m/s");
    }
    for (const char* name : {"truth/foot/left/side_force", "truth/foot/right/side_force"}) {
      add(name, "N");
    }
    enumeration("foot/left/contact", contact);
    enumeration("foot/right/contact", contact);
  }

  // Called for every tick, after the perfect values were set.
  std::function<void(SyntheticRun&, int tick)> disturb;

  std::vector<Event> events;

  LogMetadata metadata = {
      {"joints",
       R"([{"name": "l_knee", "effort_limit": 100}, {"name": "r_knee", "effort_limit": 100},
                     {"name": "arm", "effort_limit": 10}])"},
      {"legs", R"({"left": {"knee": "l_knee", "knee_bend_sign": 1, "joints": ["l_knee"]},
                   "right": {"knee": "r_knee", "knee_bend_sign": -1, "joints": ["r_knee"]}})"},
      {"fault_bits", R"({"fall": 3})"}};

  LogMetadata end = {{"realtime_factor", "4.5"}};  // metadata of the end

  int ticks() const { return 500 + 300 * steps_ + 100 + 500; }
  int transfer_start(int step) const { return 500 + 300 * (step - 1); }  // of step k, from 1
  int swing_start(int step) const { return transfer_start(step) + 100; }

  double& at(const std::string& name) {
    const int signal = find_signal(table_, name);
    EXPECT_GE(signal, 0) << name;
    return values_.at(static_cast<std::size_t>(signal));
  }
  void remove(const std::string& name) {
    std::erase_if(table_, [&](const SignalDescription& signal) { return signal.name == name; });
  }

  Verdict judge(const Expectations& expectations) {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    const std::string path = testing::TempDir() + "gaitd_verdict_" + test->name() + ".mcap";
    std::remove(path.c_str());
    std::string error;
    {
      LogWriter writer(table_);
      EXPECT_TRUE(writer.open(path, metadata, {}, &error)) << error;
      for (int tick = 0; tick < ticks(); ++tick) {
        set_perfect(tick);
        if (disturb) disturb(*this, tick);
        writer.write_tick(tick, 0.001 * tick, values_, nullptr);
      }
      for (const Event& event : events) writer.write_event(event);
      EXPECT_TRUE(writer.close(end));
    }
    const auto log = LogReader::open(path, &error);
    EXPECT_NE(log, nullptr) << error;
    return log == nullptr ? Verdict{} : compute_verdict(*log, expectations);
  }

 private:
  void add(const std::string& name, const std::string& unit,
           SignalDescription::Kind kind = SignalDescription::Kind::kReal) {
    table_.push_back({name, unit, kind, {}});
  }
  void enumeration(const std::string& name, const std::vector<std::string>& words) {
    table_.push_back({name, "", SignalDescription::Kind::kEnumeration, words});
  }
  void set(const std::string& name, double value) {
    if (find_signal(table_, name) >= 0) at(name) = value;
  }

  void set_perfect(int tick) {
    values_.assign(table_.size(), 0.0);
    set("time", 0.001 * tick);
    set("tick", tick);
    set("tick/total_us", 100 + tick % 10);
    set("pelvis/z", 1.0);
    set("truth/pelvis/z", 1.0);
    set("gait/support", 2);
    set("foot/left/contact", 2);
    set("foot/right/contact", 2);
    set("wbc/iterations", 1 + tick % 3);
    const int walked = tick - 500;
    if (walked < 0 || walked >= 300 * steps_ + 100) return;
    const int step = walked / 300 + 1;
    const bool swing = step <= steps_ && walked % 300 >= 100;
    set("gait/phase", swing ? 2 : 1);
    set("gait/step_index", std::min(step, steps_));
    set("gait/closing", step >= steps_ ? 1 : 0);
    set("toe_off/active", !swing && step > 1 && step <= steps_ && walked % 300 >= 50 ? 1 : 0);
    if (!swing) return;
    const bool left_supports = step % 2 == 1;
    set("gait/support", left_supports ? 0 : 1);
    set(left_supports ? "foot/right/contact" : "foot/left/contact", 0);
    set(left_supports ? "joint/l_knee/position" : "joint/r_knee/position",
        left_supports ? 0.2 : -0.3);
    set(left_supports ? "joint/r_knee/position" : "joint/l_knee/position", 1.4);
  }

  int steps_;
  SignalTable table_;
  std::vector<double> values_;
};

}  // namespace gaitd::daemon

// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/status_report.h"

#include <gtest/gtest.h>

namespace gaitd::daemon {
namespace {

using nlohmann::json;

// As the status is after tick 7, which knows of no stop.
json walking() { return {{"tick", 7}, {"state", "walking"}, {"faults", json::array()}}; }

TEST(ShowEstop, WithoutAStopNothingChanges) {
  const EstopFlag estop;
  json status = walking();
  show_estop(estop, &status);
  EXPECT_EQ(status, walking());
}

TEST(ShowEstop, TheFaultShowsAsSoonAsTheFlagIsSet) {
  EstopFlag estop;
  estop.take(7);
  estop.raise();
  json status = walking();
  show_estop(estop, &status);
  EXPECT_EQ(status["faults"], json({"estop"}));
  EXPECT_EQ(status["state"], "walking");  // which it is, until the control thread comes to it
}

TEST(ShowEstop, TheStateShowsAsSoonAsTheStopIsTaken) {
  EstopFlag estop;
  estop.raise();
  estop.take(8);  // the tick that is under way
  json status = walking();
  status["faults"] = {"sensors"};
  show_estop(estop, &status);
  EXPECT_EQ(status["faults"], json({"sensors", "estop"}));
  EXPECT_EQ(status["state"], "fault");
}

TEST(ShowEstop, ASecondStopAddsNothing) {
  EstopFlag estop;
  estop.raise();
  estop.take(6);
  estop.raise();
  json status = {{"tick", 7}, {"state", "fault"}, {"faults", {"estop"}}};
  const json before = status;
  show_estop(estop, &status);
  EXPECT_EQ(status, before);
}

TEST(ShowEstop, AfterTheTickThatTookItTheTickCounts) {
  EstopFlag estop;
  estop.raise();
  estop.take(7);
  json status = {{"tick", 9}, {"state", "disarmed"}, {"faults", json::array()}};  // after a reset
  const json before = status;
  show_estop(estop, &status);
  EXPECT_EQ(status, before);
}

TEST(ShowEstop, BeforeTheFirstTickToo) {
  EstopFlag estop;
  estop.raise();
  estop.take(0);
  json status = {{"tick", nullptr}, {"state", nullptr}, {"faults", json::array()}};
  show_estop(estop, &status);
  EXPECT_EQ(status["faults"], json({"estop"}));
  EXPECT_EQ(status["state"], "fault");
}

}  // namespace
}  // namespace gaitd::daemon

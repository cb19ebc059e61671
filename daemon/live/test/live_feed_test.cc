// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/live_feed.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <thread>

#include "daemon/live/subscription.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;
using Kind = SignalDescription::Kind;

SignalTable table() {
  return {{"time", "s", Kind::kReal, {}},
          {"pelvis/x", "m", Kind::kReal, {}},
          {"pelvis/y", "m", Kind::kReal, {}},
          {"gait/phase", "", Kind::kEnumeration, {"stand", "swing"}},
          {"safety/faults", "", Kind::kInteger, {}}};
}

class FakeStream : public Stream {
 public:
  bool open() const override { return open_; }
  std::size_t unread() const override { return unread_; }
  void send(std::string line) override {
    const std::scoped_lock lock(mutex_);
    lines_.push_back(json::parse(line)["params"]);
  }
  std::vector<json> lines() const {
    const std::scoped_lock lock(mutex_);
    return lines_;
  }
  // Waits for so many lines.
  std::vector<json> wait(std::size_t count) const {
    for (int i = 0; i < 10000 && lines().size() < count; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return lines();
  }
  std::atomic<bool> open_{true};
  std::atomic<std::size_t> unread_{0};

 private:
  mutable std::mutex mutex_;
  std::vector<json> lines_;
};

class Feed : public testing::Test {
 protected:
  Feed() {
    feed_.add_methods(&methods_);
    telemetry_.start();
    feed_.start();
  }
  // tick: pelvis/x is its number.
  void tick() {
    TickSlot* slot = telemetry_.begin_tick();
    slot->tick = ++tick_;
    slot->time = 0.001 * static_cast<double>(tick_);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double values[] = {slot->time, static_cast<double>(tick_), nan, 1.0, 5.0};
    std::copy(std::begin(values), std::end(values), slot->values.begin());
    telemetry_.commit();
  }
  json call(const std::string& method, const json& params,
            const std::shared_ptr<FakeStream>& stream, std::uint64_t connection = 1) {
    Caller caller{.connection = connection, .role = Role::kObserve};
    caller.stream = stream;
    json answer;
    (*methods_.find(method))(params, caller, [&](const RpcResult& result) {
      const auto* error = std::get_if<RpcError>(&result);
      answer = error ? json{{"error", error->message}} : std::get<json>(result);
    });
    return answer;
  }
  json subscribe(const json& params, const std::shared_ptr<FakeStream>& stream) {
    return call("telemetry.subscribe", params, stream);
  }

  Telemetry telemetry_{table(), {.input_text = {}, .on_event = [this](const Event& event) {
                                   feed_.publish(event);
                                 }}};
  LiveFeed feed_{&telemetry_};
  Methods methods_;
  std::shared_ptr<FakeStream> stream_ = std::make_shared<FakeStream>();
  std::int64_t tick_ = 0;
};

TEST_F(Feed, SendsWhatWasAskedForWithNamesAndUnitsFirst) {
  const json header =
      subscribe({{"signals", {"gait/*", "pelvis/?", "safety/*"}}, {"rate", 100}}, stream_);
  EXPECT_EQ(header["rate"], 100.0);
  ASSERT_EQ(header["signals"].size(), 4u);
  EXPECT_EQ(header["signals"][0], (json{{"name", "pelvis/x"}, {"kind", "real"}, {"unit", "m"}}));
  EXPECT_EQ(header["signals"][2]["words"], (json{"stand", "swing"}));
  tick();
  const auto lines = stream_->wait(1);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0],
            (json{{"tick", 1}, {"time", 0.001}, {"lost", 0}, {"values", {1.0, nullptr, 1, 5}}}));
}

TEST_F(Feed, ATickIsSentOnceAndTheNewestOne) {
  subscribe({{"signals", {"pelvis/x"}}, {"rate", 50}}, stream_);
  for (int i = 0; i < 7; ++i) tick();
  stream_->wait(1);
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  const auto lines = stream_->lines();
  ASSERT_LE(lines.size(), 2u);  // the thread may have woken between two ticks
  EXPECT_EQ(lines.back()["tick"], 7);
}

TEST_F(Feed, ASlowReaderLosesFramesAndIsToldHowManyNobodyElseNotices) {
  const auto other = std::make_shared<FakeStream>();
  subscribe({{"signals", {"pelvis/x"}}, {"rate", 200}}, stream_);
  call("telemetry.subscribe", {{"signals", {"pelvis/x"}}, {"rate", 200}}, other, 2);
  tick();
  stream_->wait(1);
  stream_->unread_ = LiveFeed::kUnread + 1;
  std::size_t frames = other->wait(1).size();
  for (int i = 0; i < 3; ++i) {
    tick();
    frames = other->wait(frames + 1).size();
  }
  EXPECT_EQ(stream_->lines().size(), 1u);
  stream_->unread_ = 0;
  tick();
  const auto lines = stream_->wait(2);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[1]["lost"], 3);
  for (const json& line : other->lines()) EXPECT_EQ(line["lost"], 0);
}

TEST_F(Feed, EventsComeToThoseWhoAskForThem) {
  const auto other = std::make_shared<FakeStream>();
  subscribe({{"signals", {"time"}}, {"events", true}}, stream_);
  call("telemetry.subscribe", {{"signals", {"time"}}}, other, 2);
  telemetry_.record_event(EventKind::kFault, 3, 0.003, R"({"fault":"estop"})");
  const auto lines = stream_->wait(1);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0], (json{{"tick", 3},
                            {"time", 0.003},
                            {"kind", "fault"},
                            {"lost", 0},
                            {"text", {{"fault", "estop"}}}}));
  EXPECT_TRUE(other->lines().empty());
}

TEST_F(Feed, ANewSubscriptionReplacesAndAnEndedOneIsSilent) {
  subscribe({{"signals", {"pelvis/x"}}, {"rate", 200}}, stream_);
  subscribe({{"signals", {"safety/faults"}}, {"rate", 200}}, stream_);
  tick();
  EXPECT_EQ(stream_->wait(1)[0]["values"], json{5});
  EXPECT_EQ(call("telemetry.unsubscribe", nullptr, stream_), (json{{"ended", true}}));
  EXPECT_EQ(call("telemetry.unsubscribe", nullptr, stream_), (json{{"ended", false}}));
  const auto before = stream_->lines().size();
  tick();
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_EQ(stream_->lines().size(), before);
}

TEST_F(Feed, AClientThatHasGoneIsForgotten) {
  subscribe({{"signals", {"*"}}, {"rate", 200}}, stream_);
  stream_->open_ = false;
  for (int i = 0; i < 1000 && stream_.use_count() > 1; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_EQ(stream_.use_count(), 1);
}

TEST_F(Feed, StoppedItTakesNobody) {
  feed_.stop();
  EXPECT_TRUE(subscribe({{"signals", {"*"}}}, stream_).contains("error"));
}

TEST(Subscription, EveryMistakeIsSaid) {
  const auto error = [](const json& params) { return read_subscription(params, table()).error; };
  EXPECT_NE(error(nullptr).find("expected an object"), std::string::npos);
  EXPECT_NE(error(json::object()).find("signals: missing"), std::string::npos);
  EXPECT_NE(error({{"signals", "time"}}).find("expected a list"), std::string::npos);
  EXPECT_NE(error({{"signals", json::array()}}).find("expected a list"), std::string::npos);
  EXPECT_NE(error({{"signals", {1}}}).find("expected globs"), std::string::npos);
  EXPECT_NE(error({{"signals", {"pelvis/w"}}}).find("no signal \"pelvis/w\""), std::string::npos);
  EXPECT_NE(error({{"signals", {"*"}}, {"rate", 0}}).find("from 0.1 to 200"), std::string::npos);
  EXPECT_NE(error({{"signals", {"*"}}, {"rate", "x"}}).find("from 0.1 to 200"), std::string::npos);
  EXPECT_NE(error({{"signals", {"*"}}, {"events", 1}}).find("true or false"), std::string::npos);
  EXPECT_NE(error({{"signals", {"*"}}, {"speed", 1}}).find("speed: unknown"), std::string::npos);
}

TEST(Subscription, GlobsWithoutASignalAreToldInTheAnswer) {
  const auto answer = [](const json& signals) {
    const SubscriptionRequest request = read_subscription({{"signals", signals}}, table());
    EXPECT_EQ(request.error, "");  // another robot may have them
    return subscription_header(request, table());
  };
  EXPECT_EQ(answer({"arm/*", "pelvis/*", "hand/?"})["unmatched"], json({"arm/*", "hand/?"}));
  EXPECT_FALSE(answer({"pelvis/*"}).contains("unmatched"));
}

TEST(Subscription, WhatWouldLoadTheProcessorIsRefused) {
  SignalTable large;
  for (int i = 0; i < 3000; ++i) large.push_back({"s" + std::to_string(i), "", Kind::kReal, {}});
  EXPECT_EQ(read_subscription({{"signals", {"*"}}, {"rate", 100}}, large).error, "");
  EXPECT_NE(read_subscription({{"signals", {"*"}}, {"rate", 101}}, large)
                .error.find("3000 signals go at most 100 times a second"),
            std::string::npos);
}

TEST(Subscription, NumbersKeepSinglePrecision) {
  const SignalTable signals = table();
  const std::vector<std::size_t> places = {1, 2, 4};
  const std::vector<double> values = {0.0, 1.0 / 3.0, 1e300, 0.0, 4294967296.0};
  const json frame =
      json::parse(frame_line(signals, places, values, 1'000'000'007, 1000000.007, 2))["params"];
  EXPECT_EQ(frame["tick"], 1'000'000'007);
  EXPECT_EQ(frame["time"], 1000000.007);
  EXPECT_NEAR(frame["values"][0].get<double>(), 1.0 / 3.0, 1e-7);
  EXPECT_EQ(frame["values"][1], 1e300);
  EXPECT_EQ(frame["values"][2], 4294967296);
}

}  // namespace
}  // namespace gaitd::daemon

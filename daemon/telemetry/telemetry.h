// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/log/event.h"
#include "daemon/log/signal.h"
#include "daemon/telemetry/log_rotation.h"
#include "gaitd/abi/types.h"

namespace gaitd::daemon {

struct Command;
struct Input;  // daemon/telemetry/input.h

// Where the control thread writes one tick.
struct TickSlot {
  std::int64_t tick = 0;
  double time = 0.0;                // s, tick clock
  std::span<double> values;         // in table order
  GaitdSensors* sensors = nullptr;  // never null
};

struct TelemetryOptions {
  double period = 0.001;      // s, of the tick
  double ring_seconds = 2.0;  // what the ring of ticks holds
  std::size_t ring_events = 1024;
  double poll_period = 0.002;  // s, sleep of the telemetry thread when there is nothing to do
  // The text of an input; called on the telemetry thread. Without one inputs are not recorded.
  std::function<std::string(const Input&)> input_text;
  // Gets every event on its way to the log, in the order in which the log has them; called on the
  // telemetry thread, so late while the disk stands still.
  std::function<void(const Event&)> on_event;
};

inline constexpr std::size_t kMaxEventText = 480;  // bytes, of an event from the control thread

// Carries ticks and events from the control thread to the log file and to status queries. The
// control thread only touches wait-free buffers whose memory exists and is touched beforehand; a
// thread of its own empties the rings into the log. That thread alone touches the disk, and it
// holds no lock then: however long the disk takes, every function here but close() answers at once.
// Works without a log file too.
class Telemetry {
 public:
  // The table must be valid (validate_signal_table).
  Telemetry(SignalTable table, const TelemetryOptions& options);
  ~Telemetry();  // closes
  Telemetry(const Telemetry&) = delete;
  Telemetry& operator=(const Telemetry&) = delete;

  // [main] Opens the log, before start(). False with `error`: what, where and what to do.
  bool open_log(const std::string& path, const LogMetadata& metadata, const McapOptions& options,
                std::string* error, const LogLimits& limits = {});

  // [main] Starts the thread, of ordinary priority.
  void start();

  // [rt] The next slot to fill. Values keep what an earlier tick left there: fill all. commit()
  // hands the slot over; false if the ring is full: status queries see the tick, the log lacks it,
  // and it is counted as a dropout.
  TickSlot* begin_tick() noexcept;
  bool commit() noexcept;

  // [rt] False if the ring was full, and counted. Text beyond kMaxEventText is cut off and marked.
  bool push_event(EventKind kind, std::int64_t tick, double time, std::string_view text) noexcept;

  // [rt] What replay needs of a command. False if the ring was full, and counted as an event.
  bool push_input(std::int64_t tick, double time, const Command& command, int parameter_owner,
                  int parameter_place) noexcept;

  // [control thread, outside the guarded section] In lockstep, before each tick: sleeps until the
  // next tick and `events` events are certain to find room, so that nothing is ever dropped. False
  // if the thread is not running, so that waiting is of no use, or `stop` has become true.
  bool wait_for_space(std::size_t events = 64, const std::atomic<bool>* stop = nullptr);

  // [any thread but rt] An event of any length. Ordered by its tick when read, not by its call.
  // While more than kMaxPending wait for the disk it is dropped, and counted.
  static constexpr std::size_t kMaxPending = 4096;
  void record_event(EventKind kind, std::int64_t tick, double time, std::string text);

  // [any thread but rt] The newest tick, and its number. False before the first one.
  bool latest(std::vector<double>& values, std::int64_t* tick = nullptr) const;

  // [any thread but rt] Number of the newest tick that latest() gives, or a later one; -1 before
  // the first. Ticks count on when a simulation is reset.
  std::int64_t newest_tick() const noexcept;

  // [any thread but rt] In table order the largest values within the last one to two seconds of
  // the signals below "tick/"; NaN for the others and before the first tick.
  std::vector<double> recent_maxima() const;

  const SignalTable& table() const;
  double period() const;  // s, of the tick
  // Ticks, events that found the ring full.
  std::uint64_t dropouts() const noexcept;
  std::uint64_t event_dropouts() const noexcept;

  // [any thread but rt] Of the log.
  struct LogStatus {
    std::string file;  // that is being written; the last one
    int part = 0;      // its number, from 1; 0: there is no log
    bool open = false;
    std::string error;        // the last one; if `open`, the log goes on in a file after it
    std::uint64_t ticks = 0;  // over all files
    std::uint64_t bytes = 0;
    std::uint64_t lost = 0;   // ticks that were given to a file that could not be written
    std::size_t waiting = 0;  // ticks that are not written yet
    double stalled = 0.0;     // s that the disk has been at one operation
  };
  LogStatus log_status() const;

  // [main, after the last commit] Writes all that is left, stops the thread and completes the file
  // with `metadata`. False with `error` if the log is not complete.
  bool close(const LogMetadata& metadata = {}, std::string* error = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitd::daemon

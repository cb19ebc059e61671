// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/telemetry.h"

#include <pthread.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <deque>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>

#include "daemon/telemetry/input.h"
#include "daemon/telemetry/latest_values.h"
#include "daemon/telemetry/recent_maximum.h"
#include "daemon/telemetry/ring.h"

namespace gaitd::daemon {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kFlushPeriod = std::chrono::seconds(1);
constexpr auto kWaitForSpace = std::chrono::microseconds(100);

struct EventSlot {
  EventKind kind = EventKind::kNote;
  bool truncated = false;
  std::uint16_t size = 0;
  std::int64_t tick = 0;
  double time = 0.0;
  std::array<char, kMaxEventText> text{};
};

constexpr std::size_t kInputs = 128;  // commands that wait for the telemetry thread

std::int64_t now_ns() { return std::chrono::nanoseconds(Clock::now().time_since_epoch()).count(); }

std::size_t ring_ticks(const TelemetryOptions& options) {
  return static_cast<std::size_t>(std::max(2.0, std::ceil(options.ring_seconds / options.period)));
}

}  // namespace

struct Telemetry::Impl {
  Impl(SignalTable signals, const TelemetryOptions& telemetry_options)
      : table(std::move(signals)),
        options(telemetry_options),
        tick_ring(ring_ticks(options)),
        event_ring(std::max<std::size_t>(2, options.ring_events)),
        input_ring(kInputs),
        values(tick_ring.capacity() * table.size()),
        sensors(tick_ring.capacity()),
        slots(tick_ring.capacity()),
        event_slots(event_ring.capacity()),
        inputs(input_ring.capacity()),
        newest(table.size() + 1),
        log(table) {
    for (std::size_t i = 0; i < table.size(); ++i) {
      if (table[i].name.starts_with("tick/")) recent.emplace_back(i);
    }
    for (std::size_t i = 0; i < slots.size(); ++i) {
      slots[i].values = std::span(values).subspan(i * table.size(), table.size());
      slots[i].sensors = &sensors[i];
    }
  }

  void run();
  bool drain();
  void drain_events();
  bool drain_ticks();
  void report_dropouts();
  void tell_log_status();
  template <class Operation>
  void on_disk(Operation operation);

  const SignalTable table;
  const TelemetryOptions options;

  // Control thread and telemetry thread.
  RingIndexes tick_ring;
  RingIndexes event_ring;
  RingIndexes input_ring;
  std::vector<double> values;
  std::vector<GaitdSensors> sensors;
  std::vector<TickSlot> slots;
  std::vector<EventSlot> event_slots;
  std::vector<Input> inputs;
  std::atomic<std::uint64_t> dropouts{0};
  std::atomic<std::uint64_t> event_dropouts{0};
  std::atomic<bool> running{false};
  std::atomic<bool> stopping{false};

  // Control thread and any other.
  struct Recent {
    explicit Recent(std::size_t signal) : signal(signal) {}
    std::size_t signal;
    RecentMaximum maximum;  // control thread
    std::atomic<double> value{std::numeric_limits<double>::quiet_NaN()};
  };
  LatestValues newest;  // in table order, then the number of the tick
  std::deque<Recent> recent;
  std::atomic<std::int64_t> newest_tick{-1};
  TickSlot unlogged;  // where a tick goes that finds the ring full
  GaitdSensors unlogged_sensors{};
  TickSlot* slot = nullptr;  // that is being filled

  // Telemetry thread, while it runs.
  RotatingLog log;

  // Telemetry thread and any other but the control thread.
  std::atomic<std::int64_t> disk_since{0};  // ns, steady clock, of the operation under way; 0: none
  mutable std::mutex status_mutex;          // never held while the disk works
  LogStatus status;
  std::mutex pending_mutex;
  std::vector<Event> pending;

  std::thread thread;
};

// Whatever may wait for the disk.
template <class Operation>
void Telemetry::Impl::on_disk(Operation operation) {
  disk_since.store(now_ns(), std::memory_order_relaxed);
  operation();
  disk_since.store(0, std::memory_order_relaxed);
}

void Telemetry::Impl::run() {
  pthread_setname_np(pthread_self(), "gaitd-telemetry");
  auto last_flush = Clock::now();
  while (!stopping.load(std::memory_order_acquire)) {
    const bool busy = drain();
    if (Clock::now() - last_flush >= kFlushPeriod) {
      report_dropouts();
      on_disk([this] {
        log.writer().flush();
        log.next_file_if_due();
      });
      tell_log_status();
      last_flush = Clock::now();
    }
    if (!busy) std::this_thread::sleep_for(std::chrono::duration<double>(options.poll_period));
  }
  drain();
}

void Telemetry::Impl::tell_log_status() {
  LogStatus now{log.file(),          log.part(),          log.writer().is_open(), log.error(),
                log.ticks_written(), log.bytes_written(), log.ticks_lost()};
  const std::scoped_lock lock(status_mutex);
  status = std::move(now);
}

// False if there was no tick.
bool Telemetry::Impl::drain() {
  drain_events();
  return drain_ticks();
}

void Telemetry::Impl::drain_events() {
  std::vector<Event> batch;
  {
    const std::scoped_lock lock(pending_mutex);
    batch.swap(pending);
  }
  for (; !event_ring.empty(); event_ring.release()) {
    const EventSlot& slot = event_slots[event_ring.read_slot()];
    batch.push_back({.tick = slot.tick,
                     .time = slot.time,
                     .kind = event_kind_name(slot.kind),
                     .text = std::string(slot.text.data(), slot.size),
                     .truncated = slot.truncated});
  }
  for (; !input_ring.empty(); input_ring.release()) {
    const Input& input = inputs[input_ring.read_slot()];
    if (!options.input_text) continue;
    batch.push_back({.tick = input.tick,
                     .time = input.time,
                     .kind = event_kind_name(EventKind::kInput),
                     .text = options.input_text(input),
                     .truncated = false});
  }
  if (batch.empty()) return;
  if (options.on_event) {
    for (const Event& event : batch) options.on_event(event);
  }
  on_disk([&] {
    for (const Event& event : batch) log.writer().write_event(event);
  });
  tell_log_status();
}

bool Telemetry::Impl::drain_ticks() {
  if (tick_ring.empty()) return false;
  // One round of the ring at most, so that events get their turn.
  for (std::size_t i = 0; i < tick_ring.capacity() && !tick_ring.empty(); ++i) {
    const TickSlot& slot = slots[tick_ring.read_slot()];
    on_disk([&] { log.writer().write_tick(slot.tick, slot.time, slot.values, slot.sensors); });
    tick_ring.release();
  }
  tell_log_status();
  return true;
}

void Telemetry::Impl::report_dropouts() {
  log.set_dropouts(dropouts.load(std::memory_order_relaxed),
                   event_dropouts.load(std::memory_order_relaxed));
}

Telemetry::Telemetry(SignalTable table, const TelemetryOptions& options)
    : impl_(std::make_unique<Impl>(std::move(table), options)) {}

Telemetry::~Telemetry() { close(); }

bool Telemetry::open_log(const std::string& path, const LogMetadata& metadata,
                         const McapOptions& options, std::string* error, const LogLimits& limits) {
  const bool opened = impl_->log.open(path, metadata, options, limits, error);
  impl_->tell_log_status();
  return opened;
}

void Telemetry::start() {
  if (impl_->thread.joinable()) return;
  impl_->stopping.store(false);
  impl_->running.store(true);
  impl_->thread = std::thread([impl = impl_.get()] { impl->run(); });
}

TickSlot* Telemetry::begin_tick() noexcept {
  Impl& impl = *impl_;
  impl.slot = impl.tick_ring.free() > 0 ? &impl.slots[impl.tick_ring.write_slot()] : nullptr;
  if (impl.slot != nullptr) return impl.slot;
  impl.unlogged.values = impl.newest.next().first(impl.table.size());
  impl.unlogged.sensors = &impl.unlogged_sensors;
  return &impl.unlogged;
}

bool Telemetry::commit() noexcept {
  Impl& impl = *impl_;
  const bool logged = impl.slot != nullptr;
  const TickSlot& slot = logged ? *impl.slot : impl.unlogged;
  for (Impl::Recent& one : impl.recent) {
    one.maximum.add(slot.time, slot.values[one.signal]);
    one.value.store(one.maximum.value(), std::memory_order_relaxed);
  }
  if (logged) std::copy(slot.values.begin(), slot.values.end(), impl.newest.next().begin());
  impl.newest.next().back() = static_cast<double>(slot.tick);
  impl.newest.publish();
  impl.newest_tick.store(slot.tick, std::memory_order_release);
  if (logged) {
    impl.tick_ring.commit();
  } else {
    impl.dropouts.fetch_add(1, std::memory_order_relaxed);
  }
  return logged;
}

bool Telemetry::push_event(EventKind kind, std::int64_t tick, double time,
                           std::string_view text) noexcept {
  Impl& impl = *impl_;
  if (impl.event_ring.free() == 0) {
    impl.event_dropouts.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  EventSlot& slot = impl.event_slots[impl.event_ring.write_slot()];
  slot.kind = kind;
  slot.tick = tick;
  slot.time = time;
  slot.size = static_cast<std::uint16_t>(std::min(text.size(), kMaxEventText));
  slot.truncated = text.size() > kMaxEventText;
  std::copy_n(text.data(), slot.size, slot.text.data());
  impl.event_ring.commit();
  return true;
}

bool Telemetry::push_input(std::int64_t tick, double time, const Command& command,
                           int parameter_owner, int parameter_place) noexcept {
  Impl& impl = *impl_;
  if (impl.input_ring.free() == 0) {
    impl.event_dropouts.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  Input& input = impl.inputs[impl.input_ring.write_slot()];
  input.tick = tick;
  input.time = time;
  input.command = command;
  input.parameter_owner = parameter_owner;
  input.parameter_place = parameter_place;
  impl.input_ring.commit();
  return true;
}

bool Telemetry::wait_for_space(std::size_t events, const std::atomic<bool>* stop) {
  Impl& impl = *impl_;
  const std::size_t wanted = std::min(events, impl.event_ring.capacity());
  while (impl.tick_ring.free() == 0 || impl.event_ring.free() < wanted ||
         impl.input_ring.free() < std::min(events, impl.input_ring.capacity())) {
    if (!impl.running.load(std::memory_order_acquire)) return false;
    if (stop != nullptr && stop->load(std::memory_order_relaxed)) return false;
    std::this_thread::sleep_for(kWaitForSpace);
  }
  return impl.running.load(std::memory_order_acquire);
}

void Telemetry::record_event(EventKind kind, std::int64_t tick, double time, std::string text) {
  const std::scoped_lock lock(impl_->pending_mutex);
  if (impl_->pending.size() >= kMaxPending) {
    impl_->event_dropouts.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  impl_->pending.push_back(
      {.tick = tick, .time = time, .kind = event_kind_name(kind), .text = std::move(text)});
}

bool Telemetry::latest(std::vector<double>& values, std::int64_t* tick) const {
  if (!impl_->newest.copy(values)) return false;
  if (tick != nullptr) *tick = static_cast<std::int64_t>(values.back());
  values.pop_back();
  return true;
}

std::int64_t Telemetry::newest_tick() const noexcept {
  return impl_->newest_tick.load(std::memory_order_acquire);
}

std::vector<double> Telemetry::recent_maxima() const {
  std::vector<double> maxima(impl_->table.size(), std::nan(""));
  for (const Impl::Recent& one : impl_->recent) {
    maxima[one.signal] = one.value.load(std::memory_order_relaxed);
  }
  return maxima;
}

const SignalTable& Telemetry::table() const { return impl_->table; }

double Telemetry::period() const { return impl_->options.period; }

std::uint64_t Telemetry::dropouts() const noexcept {
  return impl_->dropouts.load(std::memory_order_relaxed);
}

std::uint64_t Telemetry::event_dropouts() const noexcept {
  return impl_->event_dropouts.load(std::memory_order_relaxed);
}

Telemetry::LogStatus Telemetry::log_status() const {
  LogStatus status;
  {
    const std::scoped_lock lock(impl_->status_mutex);
    status = impl_->status;
  }
  status.waiting = impl_->tick_ring.used();
  const std::int64_t since = impl_->disk_since.load(std::memory_order_relaxed);
  if (since != 0) status.stalled = std::max(0.0, 1e-9 * static_cast<double>(now_ns() - since));
  return status;
}

bool Telemetry::close(const LogMetadata& metadata, std::string* error) {
  Impl& impl = *impl_;
  impl.stopping.store(true, std::memory_order_release);
  if (impl.thread.joinable()) impl.thread.join();
  impl.running.store(false, std::memory_order_release);
  while (impl.drain()) {
  }
  impl.report_dropouts();
  const bool complete = impl.log.close(metadata) && impl.log.ticks_lost() == 0;
  impl.tell_log_status();
  if (error != nullptr) *error = impl.log.error();
  return complete;
}

}  // namespace gaitd::daemon

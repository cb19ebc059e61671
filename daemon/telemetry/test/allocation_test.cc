// SPDX-License-Identifier: Apache-2.0
// Replaces operator new of this test program, to see that the side of the control thread never
// touches the heap.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "daemon/telemetry/telemetry.h"
#include "daemon/telemetry/test/fixture.h"

namespace {

thread_local bool counting = false;
thread_local int allocations = 0;

void* allocate(std::size_t size) {
  if (counting) ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return std::malloc(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace gaitd::daemon {
namespace {

TEST(Telemetry, TheControlThreadNeverAllocates) {
  const SignalTable table = sample_table();
  Telemetry telemetry(table, {.ring_seconds = 0.1, .ring_events = 16});
  telemetry.start();
  const std::vector<double> values = sample_values(table, 1);
  const std::string text(1000, 'x');
  counting = true;
  for (int tick = 0; tick < 5000; ++tick) {  // overflows too
    if (TickSlot* slot = telemetry.begin_tick()) {
      slot->tick = tick;
      slot->time = 0.001 * tick;
      std::copy(values.begin(), values.end(), slot->values.begin());
      telemetry.commit();
    }
    telemetry.push_event(EventKind::kNote, tick, 0.0, text);
  }
  counting = false;
  EXPECT_EQ(allocations, 0);
  EXPECT_GT(telemetry.event_dropouts(), 0u);
}

}  // namespace
}  // namespace gaitd::daemon

// SPDX-License-Identifier: Apache-2.0
#include "contact_memory.h"

#include <algorithm>

namespace gaitd::sim {

void ContactMemory::begin_step() {
  for (Entry& entry : entries_) entry.touched = false;
}

int ContactMemory::touch(uint64_t key) {
  for (size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].key != key) continue;
    entries_[i].touched = true;
    return static_cast<int>(i);
  }
  Entry fresh;
  fresh.key = key;
  fresh.touched = true;
  entries_.push_back(fresh);
  return static_cast<int>(entries_.size()) - 1;
}

void ContactMemory::end_step() {
  std::erase_if(entries_, [](const Entry& entry) { return !entry.touched; });
}

}  // namespace gaitd::sim

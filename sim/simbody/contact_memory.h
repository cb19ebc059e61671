// SPDX-License-Identifier: Apache-2.0
// What a contact remembers from one plant step to the next.
#ifndef GAITD_SIM_CONTACT_MEMORY_H_
#define GAITD_SIM_CONTACT_MEMORY_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace gaitd::sim {

enum class ContactKind : uint64_t { kPoint = 0, kEdge = 1, kEdgeEnd = 2, kSphere = 3 };

// Names one feature of the robot against one feature of the terrain.
constexpr uint64_t contact_key(ContactKind kind, int owner, int solid, int part) {
  return static_cast<uint64_t>(kind) << 60 | static_cast<uint64_t>(owner) << 40 |
         static_cast<uint64_t>(solid + 1) << 16 | static_cast<uint64_t>(part);
}

class ContactMemory {
 public:
  struct Entry {
    uint64_t key = 0;
    int choice = -1;                                       // face or direction of exit
    Eigen::Vector3d deflection = Eigen::Vector3d::Zero();  // m, W: tangential, from its anchor
    bool touched = false;
  };

  void clear() { entries_.clear(); }
  void begin_step();
  // The entry of `key`, made if there is none (then choice is -1). Indices hold until end_step.
  int touch(uint64_t key);
  // Forgets whatever was not touched in this step. Indices from touch() are void afterwards.
  void end_step();

  Entry& entry(int index) { return entries_[static_cast<size_t>(index)]; }

 private:
  std::vector<Entry> entries_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_CONTACT_MEMORY_H_

// SPDX-License-Identifier: Apache-2.0
// The three ways to get the robot from its built-in walking, and to give it back.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "service.h"
#include "settings.h"

namespace gaitd::unitree {

// Calls that the services of the robot know.
namespace api {
inline constexpr int kCheckMode = 1001, kSelectMode = 1002, kReleaseMode = 1003;
inline constexpr int kToUser = 7110, kToInternal = 7111;
inline constexpr int kInternalLast = 0, kInternalPassive = 1;
}  // namespace api

class ControlHandover {
 public:
  // `foreign`: takes what others command since the last call, and says how much that was.
  // `damp`: sends one command that damps. `stop`: somebody wants the end.
  ControlHandover(const Settings& settings, DdsNode* node, std::function<int()> foreign,
                  std::function<void()> damp, const std::atomic<bool>& stop);

  // The topic that the robot listens to, once taken.
  static const char* topic(Control control);
  // An empty text, or why the robot cannot be had and what to do. Waits some seconds at most.
  std::string take();
  // An empty text, or what went wrong.
  std::string give_back();

 private:
  std::string release();
  std::string wait_for_silence();

  Settings settings_;
  std::function<int()> foreign_;
  std::function<void()> damp_;
  const std::atomic<bool>& stop_;
  std::unique_ptr<Service> switcher_, sport_;
  std::string former_;  // mode of the built-in walking
  bool user_ = false;
};

}  // namespace gaitd::unitree

// SPDX-License-Identifier: Apache-2.0
// What goes wrong with the fake G1, and its services.
#include <cstring>
#include <nlohmann/json.hpp>

#include "cli/fake_g1/fake_g1.h"
#include "control.h"
#include "remote.h"

namespace gaitd::cli::g1 {

void FakeG1::apply(const Fault& fault) {
  const double until = fault.value > 0 ? now() + fault.value : 0;
  const auto whole = static_cast<int>(fault.value);
  Motor* motor = nullptr;
  const int index = unitree::wire_index(fault.target);
  if (index >= 0) motor = &motors_[static_cast<size_t>(index)];
  switch (fault.kind) {
    case FaultKind::kSilent:
      silent_ = true;
      silent_until_ = until;
      break;
    case FaultKind::kStuck:
      stuck_ = true;
      break;
    case FaultKind::kCrc:
      crc_wrong_ = true;
      crc_every_ = whole;
      break;
    case FaultKind::kNan:
      motor->nan = true;
      break;
    case FaultKind::kMachine:
      machine_ = whole;
      break;
    case FaultKind::kFrame:
      frame_ = 1;
      break;
    case FaultKind::kRestart:
      tick_shift_ = static_cast<uint32_t>(1000 * now());
      break;
    case FaultKind::kError:
      motor->error = static_cast<uint32_t>(fault.value);
      break;
    case FaultKind::kHot:
      motor->winding = whole;
      break;
    case FaultKind::kOff:
      motor->off = true;
      break;
    case FaultKind::kRemote:
      keys_ = fault.target == "L2+B"   ? unitree::kL2 | unitree::kB
              : fault.target == "L1+A" ? unitree::kL1 | unitree::kA
                                       : unitree::kSelect;
      keys_until_ = until;
      break;
    case FaultKind::kWriter:
      writer_ = true;
      writer_until_ = until;
      break;
    case FaultKind::kTwin:
      if (twin_ == 0) {
        twin_ = node_.writer(unitree::kLowState, unitree_hg_msg_dds__LowState__desc);
      }
      break;
    case FaultKind::kTorso:
      torso_silent_ = true;
      break;
    case FaultKind::kFeet:
      feet_silent_ = true;
      break;
    case FaultKind::kBattery:
      charge_ = whole;
      break;
    case FaultKind::kLose:
      lose_every_ = whole;
      break;
    case FaultKind::kDeaf:
      deaf_ = true;
      deaf_until_ = until;
      break;
  }
}

void FakeG1::apply_due_faults() {
  if (hung_) return;
  const double time = static_cast<double>(moving_) * options_.period;
  for (const Fault& fault : pending_) {
    if (time < fault.time) continue;
    fault_cycle_ = static_cast<int64_t>(cycle_);
    event("fault " + fault.target);
    apply(fault);
  }
  std::erase_if(pending_, [time](const Fault& fault) { return time >= fault.time; });
}

void FakeG1::end_due_faults() {
  const auto over = [this](double* until) {
    if (*until == 0 || now() < *until) return false;
    *until = 0;
    return true;
  };
  if (over(&silent_until_)) silent_ = false;
  if (over(&keys_until_)) keys_ = 0;
  if (over(&writer_until_)) writer_ = false;
  if (over(&deaf_until_)) deaf_ = false;
}

void FakeG1::answer_services() {
  for (int i = 0; i < 2; ++i) {
    const bool sport = i == 1;
    void* sample = nullptr;  // on loan: it has texts
    dds_sample_info_t info;
    while (dds_take(requests_[i], &sample, &info, 1, 1) > 0) {
      const auto& request = *static_cast<const unitree::Request*>(sample);
      // The built-in walking answers for sport, so nobody does once it is gone.
      const bool answers = info.valid_data && (!sport || !options_.mode.empty());
      if (answers) {
        std::string data;
        unitree::Response response;
        std::memset(&response, 0, sizeof(response));
        response.header.identity = request.header.identity;
        response.header.status.code =
            answer(request.header.identity.api_id, request.parameter, sport, &data);
        response.data = data.data();
        dds_write(answers_[i], &response);
      }
      dds_return_loan(requests_[i], &sample, 1);
      sample = nullptr;
    }
  }
}

int FakeG1::answer(int64_t api, const std::string& parameter, bool sport, std::string* data) {
  constexpr int kUnknown = 3203, kWrong = 7001;
  namespace calls = unitree::api;
  if (sport) {
    if (api != calls::kToUser && api != calls::kToInternal) return kUnknown;
    user_ = api == calls::kToUser;
    event(user_ ? "user control" : "internal control");
    return 0;
  }
  switch (api) {
    case calls::kCheckMode:
      *data = nlohmann::json({{"form", "0"}, {"name", options_.mode}}).dump();
      return 0;
    case calls::kReleaseMode:
      event("released " + options_.mode);
      options_.mode.clear();
      return 0;
    case calls::kSelectMode: {
      const auto text = nlohmann::json::parse(parameter, nullptr, false);
      if (!text.is_object() || !text.contains("name") || !text["name"].is_string()) return kWrong;
      options_.mode = text["name"].get<std::string>();
      event("selected " + options_.mode);
      return 0;
    }
    default:
      return kUnknown;
  }
}

}  // namespace gaitd::cli::g1

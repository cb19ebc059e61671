// SPDX-License-Identifier: Apache-2.0
#include "service.h"

#include <cstring>

#include "clock.h"

namespace gaitd::unitree {
namespace {

constexpr int kDepth = 10;
constexpr dds_duration_t kPoll = DDS_MSECS(5);

}  // namespace

Service::Service(DdsNode* node, const std::string& name)
    : requests_(node->writer(("rt/api/" + name + "/request").c_str(),
                             unitree_api_msg_dds__Request__desc)),
      answers_(node->reader(("rt/api/" + name + "/response").c_str(),
                            unitree_api_msg_dds__Response__desc, kDepth)) {}

bool Service::take_answer(int64_t id, int64_t api, Answer* answer) {
  void* sample = nullptr;  // on loan: it has texts
  dds_sample_info_t info;
  bool found = false;
  while (!found && dds_take(answers_, &sample, &info, 1, 1) > 0) {
    const auto& response = *static_cast<const Response*>(sample);
    if (info.valid_data && response.header.identity.id == id &&
        response.header.identity.api_id == api) {
      answer->code = response.header.status.code;
      answer->data = response.data;
      found = true;
    }
    dds_return_loan(answers_, &sample, 1);
    sample = nullptr;
  }
  return found;
}

Service::Answer Service::call(int64_t api, std::string parameter, double seconds) {
  const int64_t end = monotonic_ns() + static_cast<int64_t>(1e9 * seconds);
  while (matched_readers(requests_) == 0 || matched_writers(answers_) == 0) {
    if (monotonic_ns() > end) return {kNobody, ""};
    dds_sleepfor(kPoll);
  }
  Request request;
  std::memset(&request, 0, sizeof(request));
  request.header.identity.id = monotonic_ns();
  request.header.identity.api_id = api;
  request.parameter = parameter.data();
  if (dds_write(requests_, &request) < 0) return {kNobody, ""};
  Answer answer;
  while (!take_answer(request.header.identity.id, api, &answer)) {
    if (monotonic_ns() > end) return {kTimeout, ""};
    dds_sleepfor(kPoll);
  }
  return answer;
}

std::string service_error(int code) {
  const char* text = "an execution error";
  if (code == Service::kNobody) text = "nobody answers: the service is not running";
  if (code == Service::kTimeout) text = "no answer in time";
  if (code == 3203) text = "not implemented by this firmware";
  if (code == 7001) text = "wrong parameter";
  if (code == 7002) text = "busy";
  if (code == 7004) text = "unknown mode";
  return std::to_string(code) + ", " + text;
}

}  // namespace gaitd::unitree

// SPDX-License-Identifier: Apache-2.0
#include "dds_node.h"

#include <stdexcept>

namespace gaitd::unitree {
namespace {

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

constexpr dds_duration_t kBlocking = DDS_MSECS(5);

Qos qos_of(bool reliable, int depth) {
  Qos qos(dds_create_qos(), dds_delete_qos);
  dds_qset_reliability(qos.get(), reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       kBlocking);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  return qos;
}

dds_entity_t checked(dds_entity_t entity, const std::string& what) {
  if (entity < 0) throw std::runtime_error(what + ": " + dds_strretcode(-entity));
  return entity;
}

std::string configuration(const std::string& interface) {
  std::string text =
      "<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface name=\"" + interface +
      "\" priority=\"default\" multicast=\"default\"/></Interfaces>";
  if (interface != "lo") return text + "</General></Domain></CycloneDDS>";
  // Without multicast everybody asks the first ports of this machine.
  return text +
         "<AllowMulticast>false</AllowMulticast></General>"
         "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
         "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>"
         "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery></Domain></CycloneDDS>";
}

}  // namespace

DdsNode::DdsNode(int domain, const std::string& interface) {
  const std::string what = "DDS does not start on domain " + std::to_string(domain) +
                           " and interface " + interface + " (is it up, with an address?)";
  const auto id = static_cast<dds_domainid_t>(domain);
  domain_ = checked(dds_create_domain(id, configuration(interface).c_str()), what);
  participant_ = dds_create_participant(id, nullptr, nullptr);
  if (participant_ < 0) {
    dds_delete(domain_);
    checked(participant_, what);
  }
}

DdsNode::~DdsNode() {
  dds_delete(participant_);
  dds_delete(domain_);
}

dds_entity_t DdsNode::topic(const char* name, const dds_topic_descriptor_t& type) {
  return checked(dds_create_topic(participant_, &type, name, nullptr, nullptr), name);
}

dds_entity_t DdsNode::reader(const char* name, const dds_topic_descriptor_t& type, int depth,
                             bool others) {
  const Qos qos = qos_of(false, depth);
  if (others) dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return checked(dds_create_reader(participant_, topic(name, type), qos.get(), nullptr), name);
}

dds_entity_t DdsNode::writer(const char* name, const dds_topic_descriptor_t& type) {
  return checked(dds_create_writer(participant_, topic(name, type), qos_of(true, 1).get(), nullptr),
                 name);
}

dds_entity_t DdsNode::waitset() { return checked(dds_create_waitset(participant_), "waitset"); }

void DdsNode::attach(dds_entity_t waitset, dds_entity_t reader) {
  checked(dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS), "status mask");
  const dds_entity_t condition = checked(dds_create_readcondition(reader, DDS_ANY_STATE), "read");
  checked(dds_waitset_attach(waitset, condition, condition), "waitset");
}

bool take_sample(dds_entity_t reader, void* sample) {
  dds_sample_info_t info;
  while (dds_take(reader, &sample, &info, 1, 1) > 0) {
    if (info.valid_data) return true;
  }
  return false;
}

int matched_writers(dds_entity_t reader) {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(reader, &status);
  return static_cast<int>(status.current_count);
}

int matched_readers(dds_entity_t writer) {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(writer, &status);
  return static_cast<int>(status.current_count);
}

}  // namespace gaitd::unitree

// SPDX-License-Identifier: Apache-2.0
#include "ros2/dds.h"

#include <array>
#include <boost/asio/post.hpp>
#include <cstdlib>
#include <stdexcept>

namespace gaitd::ros2 {
namespace {

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

Qos qos_of(Profile profile) {
  Qos qos(dds_create_qos(), dds_delete_qos);
  const bool best_effort = profile == Profile::kSensorData || profile == Profile::kNewest;
  // A subscriber that does not read must not hold up an e-stop that comes on the same thread.
  constexpr dds_duration_t kNoWaiting = 0;
  dds_qset_reliability(
      qos.get(), best_effort ? DDS_RELIABILITY_BEST_EFFORT : DDS_RELIABILITY_RELIABLE, kNoWaiting);
  dds_qset_durability(qos.get(), profile == Profile::kLatched ? DDS_DURABILITY_TRANSIENT_LOCAL
                                                              : DDS_DURABILITY_VOLATILE);
  int depth = 10;
  if (profile == Profile::kSensorData) depth = 5;
  if (profile == Profile::kTransforms) depth = 100;
  if (profile == Profile::kLatched || profile == Profile::kNewest) depth = 1;
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  if (profile == Profile::kLatched) {
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, depth, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  return qos;
}

Entity checked(dds_entity_t handle, const std::string& what) {
  if (handle < 0) throw std::runtime_error(what + ": " + dds_strretcode(-handle));
  return Entity(handle);
}

// The settings of the user come after ours, over them. A sample that is larger than any of ours is
// not put together in memory.
std::string configuration(bool localhost) {
  std::string text =
      "<CycloneDDS><Domain Id=\"any\"><Internal><MaxSampleSize>16 MB</MaxSampleSize></Internal>";
  if (localhost) {
    text +=
        "<General><Interfaces><NetworkInterface address=\"127.0.0.1\"/></Interfaces>"
        "<AllowMulticast>false</AllowMulticast></General>"
        "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
        "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>"
        "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery>";
  }
  text += "</Domain></CycloneDDS>";
  const char* of_user = std::getenv("CYCLONEDDS_URI");
  if (!localhost && of_user != nullptr && *of_user != '\0') text.append(",").append(of_user);
  return text;
}

}  // namespace

std::unique_ptr<Participant> Participant::create(unsigned domain, bool localhost,
                                                 std::string* error) {
  auto participant = std::make_unique<Participant>();
  const auto failed = [&](dds_entity_t result) {
    *error = "DDS does not start on domain " + std::to_string(domain) + ": " +
             dds_strretcode(-result) +
             "; is there a network interface that is up, and is CYCLONEDDS_URI right? --localhost "
             "needs neither";
    return nullptr;
  };
  const dds_entity_t made = dds_create_domain(domain, configuration(localhost).c_str());
  if (made < 0) return failed(made);
  participant->domain_ = Entity(made);
  const dds_entity_t joined = dds_create_participant(domain, nullptr, nullptr);
  if (joined < 0) return failed(joined);
  participant->participant_ = Entity(joined);
  return participant;
}

Publisher::Publisher(const Participant& participant, const std::string& topic,
                     const dds_topic_descriptor_t& type, Profile profile) {
  topic_ = checked(dds_create_topic(participant.handle(), &type, topic.c_str(), nullptr, nullptr),
                   topic);
  writer_ = checked(
      dds_create_writer(participant.handle(), topic_.handle(), qos_of(profile).get(), nullptr),
      topic);
}

Subscriber::Subscriber(const Participant& participant, boost::asio::io_context* io,
                       const std::string& topic, const dds_topic_descriptor_t& type,
                       Profile profile, OnMessage on_message)
    : io_(io), on_message_(std::move(on_message)) {
  topic_ = checked(dds_create_topic(participant.handle(), &type, topic.c_str(), nullptr, nullptr),
                   topic);
  const std::unique_ptr<dds_listener_t, decltype(&dds_delete_listener)> listener(
      dds_create_listener(this), dds_delete_listener);
  dds_lset_data_available(listener.get(),
                          [](dds_entity_t, void* self) { static_cast<Subscriber*>(self)->poke(); });
  reader_ = checked(dds_create_reader(participant.handle(), topic_.handle(), qos_of(profile).get(),
                                      listener.get()),
                    topic);
}

Subscriber::~Subscriber() {
  reader_ = Entity();  // the listener is called no more
  *self_ = nullptr;
}

// On a thread of DDS. However many messages come, one visit is waiting.
void Subscriber::poke() {
  if (poked_.exchange(true)) return;
  boost::asio::post(*io_, [self = self_] {
    if (*self != nullptr) (*self)->take();
  });
}

void Subscriber::take() {
  poked_ = false;
  constexpr std::size_t kAtOnce = 16;
  std::array<void*, kAtOnce> samples{};
  std::array<dds_sample_info_t, kAtOnce> infos;
  const dds_return_t count =
      dds_take(reader_.handle(), samples.data(), infos.data(), kAtOnce, kAtOnce);
  for (dds_return_t i = 0; i < count; ++i) {
    if (infos[i].valid_data) on_message_(samples[i]);
  }
  if (count > 0) dds_return_loan(reader_.handle(), samples.data(), count);
}

int Subscriber::publishers() const {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(reader_.handle(), &status);
  return static_cast<int>(status.current_count);
}

}  // namespace gaitd::ros2

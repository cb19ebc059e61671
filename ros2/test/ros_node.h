// SPDX-License-Identifier: Apache-2.0
// What a node of ROS 2 on Fast DDS sees on a domain of this machine.
#pragma once

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <atomic>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

#include "ros_types.h"

namespace ros_node {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

/// A topic as its publisher or subscriber tells of it.
struct Endpoint {
  std::string type;
  bool reliable = false;
  bool transient_local = false;
};

class Node : private dds::DomainParticipantListener {
 public:
  explicit Node(unsigned domain) {
    dds::DomainParticipantQos qos;
    auto transport = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    transport->interfaceWhiteList.emplace_back("127.0.0.1");
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(transport);
    rtps::Locator_t peer;
    rtps::IPLocator::setIPv4(peer, 127, 0, 0, 1);
    qos.wire_protocol().builtin.initialPeersList.push_back(peer);
    participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(
        domain, qos, this, dds::StatusMask::none());
    if (participant_ == nullptr) throw std::runtime_error("Fast DDS does not start");
    publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  }
  ~Node() override {
    participant_->set_listener(nullptr);
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  std::map<std::string, Endpoint> publishers() const { return copy(publishers_); }
  std::map<std::string, Endpoint> subscribers() const { return copy(subscribers_); }

  template <class T>
  dds::Topic* topic(const std::string& name) {
    dds::TypeSupport(new ros_types::Type<T>).register_type(participant_);
    if (auto* known = participant_->lookup_topicdescription(name)) {
      return static_cast<dds::Topic*>(known);
    }
    return participant_->create_topic(name, T::kName, dds::TOPIC_QOS_DEFAULT);
  }
  template <class T>
  dds::DataWriter* advertise(const std::string& name, bool reliable = true) {
    dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
    qos.reliability().kind =
        reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
    qos.history().depth = 10;
    return publisher_->create_datawriter(topic<T>(name), qos);
  }
  dds::Subscriber* subscriber() { return subscriber_; }

 private:
  using Endpoints = std::map<std::string, Endpoint>;

  template <class Info>
  void add(Endpoints* endpoints, const Info& info) {
    const std::lock_guard lock(mutex_);
    (*endpoints)[info.topicName().to_string()] = {
        info.typeName().to_string(), info.m_qos.m_reliability.kind == dds::RELIABLE_RELIABILITY_QOS,
        info.m_qos.m_durability.kind == dds::TRANSIENT_LOCAL_DURABILITY_QOS};
  }
  void on_publisher_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryInfo&& info) override {
    if (info.status == rtps::WriterDiscoveryInfo::DISCOVERED_WRITER) add(&publishers_, info.info);
  }
  void on_subscriber_discovery(dds::DomainParticipant*, rtps::ReaderDiscoveryInfo&& info) override {
    if (info.status == rtps::ReaderDiscoveryInfo::DISCOVERED_READER) {
      add(&subscribers_, info.info);
    }
  }
  Endpoints copy(const Endpoints& endpoints) const {
    const std::lock_guard lock(mutex_);
    return endpoints;
  }

  dds::DomainParticipant* participant_ = nullptr;
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
  mutable std::mutex mutex_;
  Endpoints publishers_, subscribers_;
};

/// Keeps the newest message of a topic.
template <class T>
class Subscription : private dds::DataReaderListener {
 public:
  Subscription(Node* node, const std::string& name, bool latched = false) {
    dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind =
        latched ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
    qos.history().depth = latched ? 1 : 10;
    reader_ = node->subscriber()->create_datareader(node->topic<T>(name), qos, this);
    if (reader_ == nullptr) throw std::runtime_error("no reader of " + name);
  }
  ~Subscription() override { reader_->set_listener(nullptr); }
  Subscription(const Subscription&) = delete;
  Subscription& operator=(const Subscription&) = delete;

  int count() const { return count_; }
  T newest() const {
    const std::lock_guard lock(mutex_);
    return newest_;
  }

 private:
  void on_data_available(dds::DataReader* reader) override {
    T message;
    dds::SampleInfo info;
    while (reader->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      const std::lock_guard lock(mutex_);
      newest_ = message;
      ++count_;
    }
  }

  dds::DataReader* reader_ = nullptr;
  std::atomic<int> count_{0};
  mutable std::mutex mutex_;
  T newest_;
};

}  // namespace ros_node

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace gaitd::ros2 {

/// Qualities of service, as the profiles of ROS 2 of these names have them.
enum class Profile {
  kDefault,     ///< reliable, volatile, the last 10
  kSensorData,  ///< best effort, volatile, the last 5
  kTransforms,  ///< reliable, volatile, the last 100
  kLatched,     ///< reliable, transient local, the last
  kNewest,      ///< best effort, volatile, the last: takes messages of every publisher
};

/// An entity of DDS, deleted with all that is below it.
class Entity {
 public:
  Entity() = default;
  explicit Entity(dds_entity_t handle) : handle_(handle) {}
  ~Entity() { reset(); }
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    if (this != &other) {
      reset();
      handle_ = std::exchange(other.handle_, 0);
    }
    return *this;
  }
  dds_entity_t handle() const { return handle_; }

 private:
  void reset() {
    if (handle_ > 0) dds_delete(std::exchange(handle_, 0));
  }
  dds_entity_t handle_ = 0;
};

/// A participant of a domain.
class Participant {
 public:
  /// `localhost`: nothing leaves this machine. Else the network and CYCLONEDDS_URI decide. Null
  /// with the reason where there is no network that can be used.
  static std::unique_ptr<Participant> create(unsigned domain, bool localhost, std::string* error);
  dds_entity_t handle() const { return participant_.handle(); }

 private:
  Entity domain_;
  Entity participant_;
};

/// Publishes one topic. Waits for nobody: what a reliable subscriber does not take is dropped.
class Publisher {
 public:
  /// Throws std::runtime_error if DDS refuses.
  Publisher(const Participant& participant, const std::string& topic,
            const dds_topic_descriptor_t& type, Profile profile);
  void write(const void* message) { dds_write(writer_.handle(), message); }

 private:
  Entity topic_;
  Entity writer_;
};

/// Receives one topic on the thread of an io_context.
class Subscriber {
 public:
  using OnMessage = std::function<void(const void* message)>;
  /// Throws std::runtime_error if DDS refuses.
  Subscriber(const Participant& participant, boost::asio::io_context* io, const std::string& topic,
             const dds_topic_descriptor_t& type, Profile profile, OnMessage on_message);
  ~Subscriber();
  Subscriber(const Subscriber&) = delete;
  Subscriber& operator=(const Subscriber&) = delete;

  int publishers() const;  ///< that are matched

 private:
  void poke();
  void take();

  boost::asio::io_context* io_;
  OnMessage on_message_;
  std::atomic<bool> poked_{false};
  std::shared_ptr<Subscriber*> self_ = std::make_shared<Subscriber*>(this);
  Entity topic_;
  Entity reader_;
};

}  // namespace gaitd::ros2

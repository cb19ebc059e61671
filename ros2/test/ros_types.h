// SPDX-License-Identifier: Apache-2.0
// Messages of ROS 2 for Fast DDS, written down a second time and by hand from the .msg files of
// ROS, so that a mistake in ../idl does not meet itself.
#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <array>
#include <cstdint>
#include <exception>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <string>
#include <vector>

namespace ros_types {

using eprosima::fastcdr::Cdr;

struct Time {
  static constexpr auto fields = [](auto& f, auto& m) { f(m.sec), f(m.nanosec); };
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};
struct Header {
  static constexpr auto fields = [](auto& f, auto& m) { f(m.stamp), f(m.frame_id); };
  Time stamp;
  std::string frame_id;
};
struct String {
  static constexpr char kName[] = "std_msgs::msg::dds_::String_";
  static constexpr auto fields = [](auto& f, auto& m) { f(m.data); };
  std::string data;
};
struct Bool {
  static constexpr char kName[] = "std_msgs::msg::dds_::Bool_";
  static constexpr auto fields = [](auto& f, auto& m) { f(m.data); };
  bool data = false;
};
struct Clock {
  static constexpr char kName[] = "rosgraph_msgs::msg::dds_::Clock_";
  static constexpr auto fields = [](auto& f, auto& m) { f(m.clock); };
  Time clock;
};
struct Vector3 {  // and Point
  static constexpr auto fields = [](auto& f, auto& m) { f(m.x), f(m.y), f(m.z); };
  double x = 0.0, y = 0.0, z = 0.0;
};
struct Quaternion {
  static constexpr auto fields = [](auto& f, auto& m) { f(m.x), f(m.y), f(m.z), f(m.w); };
  double x = 0.0, y = 0.0, z = 0.0, w = 0.0;
};
struct Twist {
  static constexpr char kName[] = "geometry_msgs::msg::dds_::Twist_";
  static constexpr auto fields = [](auto& f, auto& m) { f(m.linear), f(m.angular); };
  Vector3 linear, angular;
};
struct WrenchStamped {
  static constexpr char kName[] = "geometry_msgs::msg::dds_::WrenchStamped_";
  static constexpr auto fields = [](auto& f, auto& m) { f(m.header), f(m.force), f(m.torque); };
  Header header;
  Vector3 force, torque;
};
struct TransformStamped {
  static constexpr auto fields = [](auto& f, auto& m) {
    f(m.header), f(m.child_frame_id), f(m.translation), f(m.rotation);
  };
  Header header;
  std::string child_frame_id;
  Vector3 translation;
  Quaternion rotation;
};
struct TFMessage {
  static constexpr char kName[] = "tf2_msgs::msg::dds_::TFMessage_";
  static constexpr auto fields = [](auto& f, auto& m) { f(m.transforms); };
  std::vector<TransformStamped> transforms;
};
struct JointState {
  static constexpr char kName[] = "sensor_msgs::msg::dds_::JointState_";
  static constexpr auto fields = [](auto& f, auto& m) {
    f(m.header), f(m.name), f(m.position), f(m.velocity), f(m.effort);
  };
  Header header;
  std::vector<std::string> name;
  std::vector<double> position, velocity, effort;
};
struct Odometry {
  static constexpr char kName[] = "nav_msgs::msg::dds_::Odometry_";
  static constexpr auto fields = [](auto& f, auto& m) {
    f(m.header), f(m.child_frame_id), f(m.position), f(m.orientation), f(m.pose_covariance),
        f(m.twist), f(m.twist_covariance);
  };
  Header header;
  std::string child_frame_id;
  Vector3 position;
  Quaternion orientation;
  std::array<double, 36> pose_covariance{};
  Twist twist;
  std::array<double, 36> twist_covariance{};
};
struct KeyValue {
  static constexpr auto fields = [](auto& f, auto& m) { f(m.key), f(m.value); };
  std::string key, value;
};
struct DiagnosticStatus {
  static constexpr auto fields = [](auto& f, auto& m) {
    f(m.level), f(m.name), f(m.message), f(m.hardware_id), f(m.values);
  };
  std::uint8_t level = 0;
  std::string name, message, hardware_id;
  std::vector<KeyValue> values;
};
struct DiagnosticArray {
  static constexpr char kName[] = "diagnostic_msgs::msg::dds_::DiagnosticArray_";
  static constexpr auto fields = [](auto& f, auto& m) { f(m.header), f(m.status); };
  Header header;
  std::vector<DiagnosticStatus> status;
};

template <class T>
concept Message = requires {
  T::fields;
};

struct Reader {
  Cdr& cdr;
  template <class T>
  void operator()(T& value) {
    if constexpr (Message<T>) {
      T::fields(*this, value);
    } else {
      cdr.deserialize(value);
    }
  }
  template <class T>
  void operator()(std::vector<T>& values) {
    std::uint32_t count = 0;
    cdr.deserialize(count);
    if (count > 10000) throw std::length_error("a sequence of " + std::to_string(count));
    values.resize(count);
    for (T& value : values) (*this)(value);
  }
};

struct Writer {
  Cdr& cdr;
  template <class T>
  void operator()(const T& value) {
    if constexpr (Message<T>) {
      T::fields(*this, value);
    } else {
      cdr.serialize(value);
    }
  }
};

/// A type for Fast DDS. Only messages without sequences are written.
template <Message T>
class Type : public eprosima::fastdds::dds::TopicDataType {
 public:
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;

  Type() {
    setName(T::kName);
    m_typeSize = 1u << 20;  // bytes
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, Payload* payload) override {
    eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->max_size);
    Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
    payload->encapsulation = CDR_LE;
    cdr.serialize_encapsulation();
    Writer writer{cdr};
    if constexpr (!std::is_same_v<T, TFMessage> && !std::is_same_v<T, JointState> &&
                  !std::is_same_v<T, DiagnosticArray>) {
      writer(*static_cast<const T*>(data));
    }
    payload->length = static_cast<std::uint32_t>(cdr.getSerializedDataLength());
    return true;
  }
  bool deserialize(Payload* payload, void* data) override {
    try {
      eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->length);
      Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
      cdr.read_encapsulation();
      Reader reader{cdr};
      reader(*static_cast<T*>(data));
      return true;
    } catch (const std::exception&) {
      return false;
    }
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void*) override {
    return [] { return 4096u; };
  }
  void* createData() override { return new T; }
  void deleteData(void* data) override { delete static_cast<T*>(data); }
  bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
};

}  // namespace ros_types

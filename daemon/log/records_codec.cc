// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/records_codec.h"

#include <google/protobuf/descriptor.pb.h>

#include <algorithm>

#include "records.pb.h"

namespace gaitd::daemon {

struct RecordsCodec::Impl {
  telemetry::Sensors sensors;
  telemetry::Event event;
};

namespace {

template <class Message>
void put_info(const GaitdSignalInfo& info, Message* message) {
  message->set_stamp_ns(info.stamp_ns);
  message->set_age(info.age);
  message->set_sequence(info.sequence);
  message->set_valid(info.valid);
}

template <class Message>
void take_info(const Message& message, GaitdSignalInfo* info) {
  info->stamp_ns = message.stamp_ns();
  info->age = message.age();
  info->sequence = message.sequence();
  info->valid = message.valid();
}

void put_vector(const double (&values)[3], telemetry::Vector* vector) {
  vector->set_x(values[0]);
  vector->set_y(values[1]);
  vector->set_z(values[2]);
}

void take_vector(const telemetry::Vector& vector, double (&values)[3]) {
  values[0] = vector.x();
  values[1] = vector.y();
  values[2] = vector.z();
}

std::size_t utf8_length(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first < 0xE0) return 2;
  if (first >= 0xE0 && first < 0xF0) return 3;
  if (first >= 0xF0 && first < 0xF5) return 4;
  return 0;
}

// Protobuf refuses to read text that is not UTF-8, such as one cut off inside a character: what
// does not belong becomes a question mark. (Three- and four-byte forms that UTF-8 forbids count as
// bad.)
std::string make_utf8(std::string text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    const std::size_t length = utf8_length(byte(i));
    bool valid = length > 0 && i + length <= text.size();
    for (std::size_t k = 1; valid && k < length; ++k) valid = (byte(i + k) & 0xC0) == 0x80;
    if (valid && length >= 3) {
      const unsigned second = byte(i + 1);
      const unsigned first = byte(i);
      valid = !(first == 0xE0 && second < 0xA0) && !(first == 0xED && second >= 0xA0) &&
              !(first == 0xF0 && second < 0x90) && !(first == 0xF4 && second >= 0x90);
    }
    if (!valid) text[i] = '?';
    i += valid ? length : 1;
  }
  return text;
}

void put_imu(const GaitdImuSensor& imu, telemetry::ImuSensor* message) {
  put_info(imu.info, message);
  message->set_orientation_valid(imu.has_orientation);
  telemetry::Quaternion* orientation = message->mutable_orientation();
  orientation->set_x(imu.orientation[0]);
  orientation->set_y(imu.orientation[1]);
  orientation->set_z(imu.orientation[2]);
  orientation->set_w(imu.orientation[3]);
  put_vector(imu.angular_rate, message->mutable_angular_rate());
  put_vector(imu.specific_force, message->mutable_specific_force());
}

void take_imu(const telemetry::ImuSensor& message, GaitdImuSensor* imu) {
  take_info(message, &imu->info);
  imu->has_orientation = message.orientation_valid();
  imu->orientation[0] = message.orientation().x();
  imu->orientation[1] = message.orientation().y();
  imu->orientation[2] = message.orientation().z();
  imu->orientation[3] = message.orientation().w();
  take_vector(message.angular_rate(), imu->angular_rate);
  take_vector(message.specific_force(), imu->specific_force);
}

}  // namespace

RecordsCodec::RecordsCodec() : impl_(std::make_unique<Impl>()) {}
RecordsCodec::~RecordsCodec() = default;

void RecordsCodec::append_sensors(const GaitdSensors& sensors, std::string* out) {
  telemetry::Sensors& message = impl_->sensors;
  message.Clear();
  message.set_tick(sensors.tick);
  message.set_time(sensors.time);
  for (int i = 0; i < std::clamp<int>(sensors.joint_count, 0, GAITD_MAX_JOINTS); ++i) {
    telemetry::JointSensor* joint = message.add_joints();
    put_info(sensors.joints[i].info, joint);
    joint->set_position(sensors.joints[i].position);
    joint->set_velocity(sensors.joints[i].velocity);
    joint->set_torque(sensors.joints[i].torque);
  }
  for (int i = 0; i < std::clamp<int>(sensors.imu_count, 0, GAITD_MAX_IMUS); ++i) {
    put_imu(sensors.imus[i], message.add_imus());
  }
  for (int i = 0; i < std::clamp<int>(sensors.foot_count, 0, GAITD_MAX_FEET); ++i) {
    telemetry::FootForceSensor* foot = message.add_feet();
    put_info(sensors.feet[i].info, foot);
    put_vector(sensors.feet[i].force, foot->mutable_force());
    put_vector(sensors.feet[i].moment, foot->mutable_moment());
  }
  message.AppendToString(out);
}

bool RecordsCodec::parse_sensors(std::string_view bytes, GaitdSensors* sensors) {
  telemetry::Sensors& message = impl_->sensors;
  *sensors = GaitdSensors{};
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return false;
  if (message.joints_size() > GAITD_MAX_JOINTS || message.imus_size() > GAITD_MAX_IMUS ||
      message.feet_size() > GAITD_MAX_FEET) {
    return false;
  }
  sensors->size = sizeof(GaitdSensors);
  sensors->tick = message.tick();
  sensors->time = message.time();
  sensors->joint_count = message.joints_size();
  sensors->imu_count = message.imus_size();
  sensors->foot_count = message.feet_size();
  for (int i = 0; i < message.joints_size(); ++i) {
    take_info(message.joints(i), &sensors->joints[i].info);
    sensors->joints[i].position = message.joints(i).position();
    sensors->joints[i].velocity = message.joints(i).velocity();
    sensors->joints[i].torque = message.joints(i).torque();
  }
  for (int i = 0; i < message.imus_size(); ++i) take_imu(message.imus(i), &sensors->imus[i]);
  for (int i = 0; i < message.feet_size(); ++i) {
    take_info(message.feet(i), &sensors->feet[i].info);
    take_vector(message.feet(i).force(), sensors->feet[i].force);
    take_vector(message.feet(i).moment(), sensors->feet[i].moment);
  }
  return true;
}

void RecordsCodec::append_event(const Event& event, std::string* out) {
  telemetry::Event& message = impl_->event;
  message.Clear();
  message.set_tick(event.tick);
  message.set_time(event.time);
  message.set_kind(make_utf8(event.kind));
  message.set_text(make_utf8(event.text));
  message.set_truncated(event.truncated);
  message.AppendToString(out);
}

bool RecordsCodec::parse_event(std::string_view bytes, Event* event) {
  telemetry::Event& message = impl_->event;
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return false;
  event->tick = message.tick();
  event->time = message.time();
  event->kind = message.kind();
  event->text = message.text();
  event->truncated = message.truncated();
  return true;
}

std::string records_schema() {
  google::protobuf::FileDescriptorSet set;
  telemetry::Sensors::descriptor()->file()->CopyTo(set.add_file());
  return set.SerializeAsString();
}

}  // namespace gaitd::daemon

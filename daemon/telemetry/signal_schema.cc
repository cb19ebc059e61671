// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/signal_schema.h"

#include <google/protobuf/descriptor.pb.h>

#include "daemon/log/signal_tree.h"

namespace gaitd::daemon {

namespace {

using google::protobuf::DescriptorProto;
using google::protobuf::EnumDescriptorProto;
using google::protobuf::FieldDescriptorProto;
using Kind = SignalDescription::Kind;

void add_enumeration(const SignalNode& node, DescriptorProto* message) {
  EnumDescriptorProto* enumeration = message->add_enum_type();
  enumeration->set_name(node.type);
  for (std::size_t i = 0; i < node.values.size(); ++i) {
    auto* value = enumeration->add_value();
    value->set_name(node.values[i]);
    value->set_number(static_cast<int>(i));
  }
}

FieldDescriptorProto::Type field_type(Kind kind) {
  switch (kind) {
    case Kind::kInteger:
      return FieldDescriptorProto::TYPE_SFIXED64;
    case Kind::kBoolean:
      return FieldDescriptorProto::TYPE_BOOL;
    case Kind::kEnumeration:
      return FieldDescriptorProto::TYPE_ENUM;
    case Kind::kReal:
      break;
  }
  return FieldDescriptorProto::TYPE_DOUBLE;
}

void fill_message(const SignalTable& table, const SignalNode& node, const std::string& full_name,
                  DescriptorProto* message) {
  for (const SignalNode& child : node.children) {
    FieldDescriptorProto* field = message->add_field();
    field->set_name(child.field);
    field->set_number(child.number);
    field->set_label(FieldDescriptorProto::LABEL_OPTIONAL);
    const std::string type_name = full_name + "." + child.type;
    if (!child.type.empty()) field->set_type_name(type_name);
    if (child.signal < 0) {
      field->set_type(FieldDescriptorProto::TYPE_MESSAGE);
      DescriptorProto* nested = message->add_nested_type();
      nested->set_name(child.type);
      fill_message(table, child, type_name, nested);
      continue;
    }
    const SignalDescription& signal = table[static_cast<std::size_t>(child.signal)];
    field->set_type(field_type(signal.kind));
    if (signal.kind == Kind::kEnumeration) add_enumeration(child, message);
  }
}

}  // namespace

std::string signal_schema(const SignalTable& table) {
  google::protobuf::FileDescriptorSet set;
  auto* file = set.add_file();
  file->set_name("gaitd/signals.proto");
  file->set_package("gaitd.telemetry");
  file->set_syntax("proto3");
  DescriptorProto* message = file->add_message_type();
  message->set_name("Signals");
  fill_message(table, build_signal_tree(table), std::string(".") + kSignalsMessage, message);
  return set.SerializeAsString();
}

}  // namespace gaitd::daemon

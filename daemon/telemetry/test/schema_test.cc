// SPDX-License-Identifier: Apache-2.0
// Reads what was written with protobuf's own parser, driven by the schema in the file alone.
#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/dynamic_message.h>
#include <gtest/gtest.h>

#include "daemon/log/mcap_reader.h"
#include "daemon/log/records_codec.h"
#include "daemon/log/signal_codec.h"
#include "daemon/log/signal_tree.h"
#include "daemon/telemetry/signal_schema.h"
#include "daemon/telemetry/test/fixture.h"

namespace gaitd::daemon {
namespace {

namespace pb = google::protobuf;

// Builds the message of a schema and parses bytes into it.
class Foreign {
 public:
  Foreign(const std::string& schema, const std::string& message) {
    pb::FileDescriptorSet set;
    EXPECT_TRUE(set.ParseFromString(schema));
    for (const auto& file : set.file()) EXPECT_NE(pool_.BuildFile(file), nullptr);
    descriptor_ = pool_.FindMessageTypeByName(message);
    EXPECT_NE(descriptor_, nullptr);
  }

  std::unique_ptr<pb::Message> parse(std::string_view bytes) {
    std::unique_ptr<pb::Message> message(factory_.GetPrototype(descriptor_)->New());
    EXPECT_TRUE(message->ParseFromArray(bytes.data(), static_cast<int>(bytes.size())));
    return message;
  }

 private:
  pb::DescriptorPool pool_;
  pb::DynamicMessageFactory factory_{&pool_};
  const pb::Descriptor* descriptor_ = nullptr;
};

const pb::FieldDescriptor* field_of(const pb::Message& message, const std::string& name) {
  return message.GetDescriptor()->FindFieldByName(name);
}

const pb::Message& child(const pb::Message& message, const std::string& name) {
  return message.GetReflection()->GetMessage(message, field_of(message, name));
}

double real(const pb::Message& message, const std::string& name) {
  return message.GetReflection()->GetDouble(message, field_of(message, name));
}

TEST(SignalSchema, ProtobufReadsWhatTheTemplateWrites) {
  const SignalTable table = sample_table();
  const SignalCodec codec(table);
  Foreign foreign(signal_schema(table), kSignalsMessage);
  const std::vector<double> values = {1.5, 42, 7.25, -3, 2, 1, 2, 1, 0.1, 0.2, -0.3, 1e300};
  std::string bytes;
  codec.append(values, &bytes);
  const auto message = foreign.parse(bytes);
  const auto* reflection = message->GetReflection();
  EXPECT_EQ(real(*message, "time"), 1.5);
  EXPECT_EQ(reflection->GetInt64(*message, field_of(*message, "tick")), 42);
  EXPECT_EQ(real(child(*message, "tick_group"), "total_us"), 7.25);
  const pb::Message& gait = child(*message, "gait");
  EXPECT_EQ(gait.GetReflection()->GetEnum(gait, field_of(gait, "phase"))->name(), "PHASE_SWING");
  const pb::Message& left = child(child(*message, "foot"), "left");
  EXPECT_EQ(left.GetReflection()->GetEnum(left, field_of(left, "contact"))->name(), "CONTACT_TOE");
  const pb::Message& toe_off = child(*message, "toe_off");
  EXPECT_TRUE(toe_off.GetReflection()->GetBool(toe_off, field_of(toe_off, "active")));
  const pb::Message& joint = child(*message, "joint");
  EXPECT_EQ(real(child(joint, "l_leg_kny"), "position"), 0.1);
  EXPECT_EQ(real(child(joint, "l_leg_kny"), "torque"), -0.3);
  EXPECT_EQ(real(child(joint, "l_leg_kny_2"), "position"), 0.2);
  const pb::Message& foot = child(child(child(*message, "truth"), "foot"), "left");
  EXPECT_EQ(real(child(foot, "force"), "x"), 1e300);
  EXPECT_TRUE(reflection->GetUnknownFields(*message).empty());
}

TEST(SignalSchema, EveryTickHasTheSameSizeWhateverItsValues) {
  const SignalTable table = sample_table();
  const SignalCodec codec(table);
  std::string zeros;
  codec.append(std::vector<double>(table.size(), 0.0), &zeros);
  EXPECT_EQ(zeros.size(), codec.message_size());
  EXPECT_TRUE(codec.matches(zeros));
  for (int tick = 0; tick < 100; ++tick) {
    std::string bytes;
    codec.append(sample_values(table, tick), &bytes);
    EXPECT_EQ(bytes.size(), zeros.size());
    EXPECT_TRUE(codec.matches(bytes));
  }
  zeros[0] = static_cast<char>(zeros[0] + 1);
  EXPECT_FALSE(codec.matches(zeros));
  EXPECT_FALSE(codec.matches(""));
}

TEST(SignalSchema, ClashingNamesAndWordsStillMakeAValidSchema) {
  const SignalTable table = {{"a", "", Kind::kEnumeration, {"b_c", "B-C", "b.c", "1", "_1"}},
                             {"a_b", "", Kind::kEnumeration, {"c", "n1"}},
                             {"A_B", "", Kind::kEnumeration, {"c"}},
                             {"AGroup", "", Kind::kReal, {}},
                             {"a/x", "", Kind::kReal, {}},
                             {"a_group", "", Kind::kReal, {}},
                             {"AEnum", "", Kind::kReal, {}},
                             {"9lives/1", "", Kind::kBoolean, {}},
                             {"n9lives/-", "", Kind::kBoolean, {}},
                             {"message/optional/syntax", "", Kind::kInteger, {}},
                             {"A_B_C", "", Kind::kReal, {}}};
  ASSERT_EQ(validate_signal_table(table), "");
  Foreign foreign(signal_schema(table), kSignalsMessage);
  const SignalCodec codec(table);
  const std::vector<double> values = {4, 1, 0, 0.5, 1.5, 2.5, 3.5, 1, 0, 9, 5.5};
  std::string bytes;
  codec.append(values, &bytes);
  foreign.parse(bytes);
  for (std::size_t i = 0; i < table.size(); ++i) EXPECT_EQ(codec.value(bytes, i), values[i]);
}

TEST(SignalSchema, HundredsOfSignalsInOneGroup) {
  SignalTable table;
  for (int i = 0; i < 3000; ++i) {
    table.push_back({"group/signal" + std::to_string(i), "", Kind::kReal, {}});
  }
  const SignalCodec codec(table);
  Foreign foreign(signal_schema(table), kSignalsMessage);
  std::vector<double> values(table.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i) + 0.5;
  std::string bytes;
  codec.append(values, &bytes);
  const auto message = foreign.parse(bytes);
  EXPECT_EQ(real(child(*message, "group"), "signal2999"), 2999.5);
}

TEST(SignalSchema, AWholeFileOpensWithProtobufAlone) {
  const std::string path = test_path("log.mcap");
  write_sample_log(path, 30, {});
  McapReader reader;
  std::string error;
  ASSERT_TRUE(reader.open(path, &error)) << error;
  std::map<int, std::unique_ptr<Foreign>> foreign;
  for (const McapChannel& channel : reader.channels()) {
    EXPECT_EQ(channel.message_encoding, "protobuf");
    for (const McapSchema& schema : reader.schemas()) {
      if (schema.id != channel.schema) continue;
      EXPECT_EQ(schema.encoding, "protobuf");
      foreign[channel.id] = std::make_unique<Foreign>(schema.data, schema.name);
    }
  }
  ASSERT_EQ(foreign.size(), 3u);
  int messages = 0;
  for (const McapChunk& chunk : reader.chunks()) {
    std::string records;
    ASSERT_TRUE(reader.read_chunk(chunk, &records, &error)) << error;
    std::uint64_t offset = 0;
    for (McapMessage message; next_message(records, &offset, &message); ++messages) {
      const auto parsed = foreign.at(message.channel)->parse(message.data);
      EXPECT_TRUE(parsed->GetReflection()->GetUnknownFields(*parsed).empty());
    }
  }
  EXPECT_EQ(messages, 63);
}

TEST(SignalTableText, ComesBackAsItWas) {
  SignalTable table;
  std::string error;
  ASSERT_TRUE(signal_table_from_json(signal_table_to_json(sample_table()), &table, &error));
  EXPECT_EQ(table, sample_table());
}

TEST(SignalTableText, RefusesWhatIsNoTable) {
  SignalTable table;
  std::string error;
  for (const char* text :
       {"", "{}", "[1]", "[{}]", "[{\"name\":\"a\",\"kind\":\"odd\"}]", "[]",
        "[{\"name\":\"a\",\"kind\":\"real\"},{\"name\":\"a\",\"kind\":\"real\"}]",
        "[{\"name\":\"a//b\",\"kind\":\"real\"}]", "[{\"name\":\"/a\",\"kind\":\"real\"}]",
        "[{\"name\":\"a\",\"kind\":\"enumeration\"}]",
        "[{\"name\":\"a\",\"kind\":\"enumeration\",\"words\":[\"x\",\"x\"]}]",
        "[{\"name\":\"a/a/a/a/a/a/a/a/a/a/a/a/a\",\"kind\":\"real\"}]"}) {
    EXPECT_FALSE(signal_table_from_json(text, &table, &error)) << text;
    EXPECT_FALSE(error.empty());
  }
}

}  // namespace
}  // namespace gaitd::daemon

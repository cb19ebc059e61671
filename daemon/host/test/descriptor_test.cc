// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <random>

#include "daemon/host/elf_descriptor.h"
#include "daemon/host/plugin_file.h"
#include "daemon/host/test/test_files.h"

namespace gaitd::daemon {
namespace {

std::span<const std::byte> as_bytes(const std::vector<char>& text) {
  return std::as_bytes(std::span(text));
}

// The refusal of a test plugin that must be refused.
Refusal refusal_of(const std::string& name) {
  Refusal refusal;
  EXPECT_FALSE(read_plugin_file(plugin_path(name), GAITD_LAYER_TOE_OFF, &refusal)) << name;
  EXPECT_EQ(refusal.file, plugin_path(name).string());
  for (const Refusal::Reason& reason : refusal.reasons) {
    EXPECT_FALSE(reason.what.empty() || reason.has.empty() || reason.needed.empty() ||
                 reason.remedy.empty());
  }
  return refusal;
}

TEST(Descriptor, IsReadFromTheFileOfAGoodPlugin) {
  Refusal refusal;
  const auto file = read_plugin_file(plugin_path("good"), GAITD_LAYER_TOE_OFF, &refusal);
  ASSERT_TRUE(file) << refusal.text();
  EXPECT_TRUE(refusal.empty());
  EXPECT_STREQ(file->descriptor.id, "good");
  EXPECT_STREQ(file->descriptor.version, "1.2.3");
  ASSERT_EQ(file->descriptor.parameter_count, 2u);
  EXPECT_STREQ(file->descriptor.parameters[1].name, "count");
  EXPECT_EQ(file->descriptor.parameters[1].default_value, 3.0);
}

TEST(Descriptor, OfAnotherVersionIsRefusedWithBothVersions) {
  EXPECT_EQ(refusal_of("wrong_magic").reasons.at(0).what, "magic");
  const Refusal major = refusal_of("wrong_major");
  ASSERT_EQ(major.reasons.size(), 1u);
  EXPECT_EQ(major.reasons[0].has, "7.0");
  EXPECT_EQ(major.reasons[0].needed, "1.0 to 1.0");
  EXPECT_EQ(refusal_of("wrong_minor").reasons.at(0).has, "1.9");
  EXPECT_EQ(refusal_of("wrong_size").reasons.at(0).what, "struct_size");
}

TEST(Descriptor, OfAnotherLayerIsRefusedWithBothLayers) {
  const Refusal other = refusal_of("wrong_layer");
  ASSERT_EQ(other.reasons.size(), 1u);
  EXPECT_EQ(other.reasons[0].has, "icp_planner");
  EXPECT_EQ(other.reasons[0].needed, "toe_off");
  EXPECT_EQ(refusal_of("unknown_layer").reasons.at(0).has, "77");
}

TEST(Descriptor, WithABadNameOrParameterTableIsRefused) {
  EXPECT_EQ(refusal_of("ill_named").reasons.at(0).has, "\"Bad-Name\"");
  EXPECT_EQ(refusal_of("bad_version").reasons.at(0).has, "\"new\"");
  EXPECT_NE(refusal_of("bad_range").text().find("got 2, expected a number from 4 to 10 1/s"),
            std::string::npos);
  EXPECT_NE(refusal_of("twice_named").text().find("the name of an earlier parameter"),
            std::string::npos);
}

TEST(Descriptor, ReportsEveryReasonAtOnce) {
  GaitdPluginDescriptor descriptor{};
  descriptor.layer = 55;
  descriptor.worst_case_us = -1.0;
  descriptor.parameter_count = GAITD_MAX_PARAMETERS + 1;
  Refusal refusal;
  check_descriptor_values(descriptor, std::nullopt, &refusal);
  EXPECT_EQ(refusal.reasons.size(), 5u) << refusal.text();  // layer, id, version, time, count
}

TEST(Descriptor, MissingSectionOrSymbolsAreRefused) {
  EXPECT_NE(refusal_of("no_section").text().find("no section .gaitd_plugin"), std::string::npos);
  EXPECT_NE(refusal_of("no_create").text().find("no exported gaitd_create"), std::string::npos);
}

TEST(Descriptor, ThreadLocalStorageIsRefusedInALayerOnly) {
  EXPECT_EQ(refusal_of("thread_local").reasons.at(0).what, "thread-local storage");
  Refusal refusal;
  EXPECT_TRUE(read_plugin_file(plugin_path("backend"), GAITD_LAYER_BACKEND, &refusal))
      << refusal.text();
}

TEST(Descriptor, FilesThatAreNoLibraryAreRefused) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "text.so";
  for (const std::string& text : {std::string(), std::string("#!/bin/sh\necho no\n")}) {
    write_file(path, {text.begin(), text.end()});
    Refusal refusal;
    EXPECT_FALSE(read_plugin_file(path, std::nullopt, &refusal));
    EXPECT_NE(refusal.text().find("no ELF file"), std::string::npos) << refusal.text();
  }
  Refusal absent;
  EXPECT_FALSE(read_plugin_file(directory.path() / "none.so", std::nullopt, &absent));
  Refusal folder;
  EXPECT_FALSE(read_plugin_file(directory.path(), std::nullopt, &folder));
  EXPECT_NE(folder.text().find("no regular file"), std::string::npos) << folder.text();
  // Nobody waits for a writer.
  const auto fifo_path = directory.path() / "fifo.so";
  ASSERT_EQ(mkfifo(fifo_path.c_str(), 0600), 0);
  Refusal fifo;
  EXPECT_FALSE(read_plugin_file(fifo_path, std::nullopt, &fifo));
  EXPECT_NE(fifo.text().find("no regular file"), std::string::npos) << fifo.text();
}

TEST(Descriptor, AFileForAnotherMachineIsRefused) {
  const TemporaryDirectory directory;
  std::vector<char> bytes = contents(plugin_path("good"));
  bytes[18] = static_cast<char>(183);  // e_machine: AArch64
  write_file(directory.path() / "arm.so", bytes);
  Refusal refusal;
  EXPECT_FALSE(read_plugin_file(directory.path() / "arm.so", std::nullopt, &refusal));
  EXPECT_NE(refusal.text().find("machine 183"), std::string::npos) << refusal.text();
}

TEST(Descriptor, CutFilesAreRefusedAtAnyLength) {
  const std::vector<char> whole = contents(plugin_path("good"));
  for (std::size_t size = 0; size < whole.size(); size += 1 + size / 64) {
    Refusal refusal;
    const std::vector<char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(read_elf(as_bytes(cut), &refusal)) << size;
    EXPECT_FALSE(refusal.empty()) << size;
  }
}

TEST(Descriptor, DamagedFilesNeverCrashTheReader) {
  const std::vector<char> whole = contents(plugin_path("good"));
  std::mt19937 random(1);
  // Headers and tables stand at the two ends: damage those most.
  const auto place = [&] {
    const std::size_t end = std::min<std::size_t>(whole.size(), 2200);
    const std::size_t offset = random() % end;
    return random() % 2 == 0 ? offset : whole.size() - 1 - offset;
  };
  int read = 0;
  for (int i = 0; i < 20000; ++i) {
    std::vector<char> damaged = whole;
    for (int j = 0; j < 1 + i % 8; ++j) damaged[place()] = static_cast<char>(random());
    Refusal refusal;
    if (const auto facts = read_elf(as_bytes(damaged), &refusal)) {
      check_descriptor(*facts, std::nullopt, &refusal);
      ++read;
    }
  }
  EXPECT_GT(read, 0);
}

TEST(Descriptor, DamagedDescriptorsNeverCrashTheChecks) {
  Refusal refusal;
  const auto file = read_plugin_file(plugin_path("good"), std::nullopt, &refusal);
  ASSERT_TRUE(file);
  std::mt19937 random(2);
  for (int i = 0; i < 5000; ++i) {
    GaitdPluginDescriptor damaged = file->descriptor;
    auto* bytes = reinterpret_cast<unsigned char*>(&damaged);
    for (int j = 0; j < 8; ++j) {
      bytes[24 + random() % 700] = static_cast<unsigned char>(random());
    }
    Refusal reasons;
    check_descriptor_values(damaged, std::nullopt, &reasons);
    for (const char c : reasons.text()) {
      EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20);
    }
  }
}

TEST(PluginFile, HashTellsBuildsApart) {
  Refusal refusal;
  const auto good = read_plugin_file(plugin_path("good"), std::nullopt, &refusal);
  const auto newer = read_plugin_file(plugin_path("newer"), std::nullopt, &refusal);
  ASSERT_TRUE(good && newer);
  EXPECT_EQ(good->hash().size(), 16u);
  EXPECT_NE(good->hash(), newer->hash());
  PluginFile empty;
  EXPECT_EQ(empty.hash(), "cbf29ce484222325");  // FNV-1a of nothing
  empty.bytes = {std::byte{'a'}};
  EXPECT_EQ(empty.hash(), "af63dc4c8601ec8c");  // published test value
}

}  // namespace
}  // namespace gaitd::daemon

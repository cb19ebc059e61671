// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>

#include "cli/test/cli_process.h"
#include "cli/test/sample_log.h"

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

namespace gaitd::cli {

namespace fs = std::filesystem;

// `gaitctl campaign` with a program of the test in the place of gaitd.
class CampaignTest : public ::testing::Test {
 protected:
  CampaignTest() {
    fs::copy_file(GAITCTL, workspace_.file("gaitctl"));
    write_sample_log(workspace_.file("sample.mcap"));
    write_sample_log(workspace_.file("tall.mcap"), 3.0);
    scenario("good", "2.0");
    scenario("bad", "0.5");
    // What it does is in another file, so that it stays the same build.
    workspace_.write("gaitd", "#!/bin/sh\n. " + workspace_.file("gaitd.sh") + "\n");
    fs::permissions(workspace_.file("gaitd"), fs::perms::owner_all);
    gaitd("");
  }
  void scenario(const std::string& name, const std::string& highest) {
    workspace_.write(name + ".yaml", "schema: gaitd.scenario/1\nname: " + name +
                                         "\nrobot: atlas\nduration: 5.0\nexpect:\n  checks: "
                                         "[{signal: com/z, stat: max, max: " +
                                         highest + "}]\n");
  }
  // Writes the log that it was asked for, $log.mcap, and its arguments into a file of its own.
  void gaitd(const std::string& before) {
    workspace_.write("gaitd.sh",
                     "echo \"$@\" >> " + workspace_.file("calls") +
                         "\nlog=" + workspace_.file("sample") + "\n" + before +
                         "\nwhile [ $# -gt 0 ]; do [ \"$1\" = --log ] && cp \"$log.mcap\" " +
                         "\"$2\"; shift; done\n");
  }
  void campaign(const std::string& rest) {
    workspace_.write("c.yaml", "schema: gaitd.campaign/1\nname: trial\n" + rest);
  }
  std::string command(const std::string& arguments) const {
    return workspace_.file("gaitctl") + " campaign " + workspace_.file("c.yaml") + " -o " +
           workspace_.file("results") + " " + arguments;
  }
  Outcome run(const std::string& arguments = "") {
    return run_shell(workspace_, command(arguments));
  }
  int lines(const std::string& file) const {
    std::istringstream in(workspace_.read(file));
    int count = 0;
    for (std::string line; std::getline(in, line);) ++count;
    return count;
  }
  int logs() const {
    int count = 0;
    for (const auto& entry : fs::directory_iterator(workspace_.file("results/logs"))) {
      count += entry.path().extension() == ".mcap" ? 1 : 0;
    }
    return count;
  }
  std::string file(const std::string& name) const { return workspace_.file(name); }

  Workspace workspace_;
};

}  // namespace gaitd::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace gaitd::cli {

// A directory that goes away with the test.
class Workspace {
 public:
  Workspace() {
    std::string name = "/tmp/gaitctl-test-XXXXXX";
    path_ = mkdtemp(name.data());
  }
  ~Workspace() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
  }
  std::string read(const std::string& name) const {
    std::ifstream in(file(name));
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  std::string path_;
};

struct Outcome {
  int exit_code = -1;
  std::string out;
  std::string err;
};

// Runs a shell command line with both outputs taken.
inline Outcome run_shell(const Workspace& workspace, const std::string& command_line) {
  const std::string command =
      command_line + " >" + workspace.file("out") + " 2>" + workspace.file("err");
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, workspace.read("out"),
          workspace.read("err")};
}

}  // namespace gaitd::cli

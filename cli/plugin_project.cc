// SPDX-License-Identifier: Apache-2.0
#include "cli/plugin_project.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <system_error>

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

// What a new variant begins as: the one of its layer that is easiest to read.
struct Base {
  const char* layer;
  const char* variant;
  const char* class_name;
  const char* input;
  const char* output;
  std::vector<const char*> extra = {};  // further files, below the folder of the layer
};

const std::array<Base, 5> kBases = {{
    {"state_estimator", "kinematic_inertial", "KinematicInertial", "GaitdStateEstimatorInput",
     "GaitdRobotState"},
    {"icp_planner", "single_cmp", "SingleCmp", "GaitdIcpPlannerInput", "GaitdIcpPlan"},
    {"step_adjuster", "fixed_steps", "FixedSteps", "GaitdStepAdjusterInput", "GaitdStepAdjustment"},
    {"toe_off", "icp_criteria", "IcpCriteria", "GaitdToeOffInput", "GaitdToeOff"},
    {"whole_body_controller",
     "com_height_qp",
     "ComHeightQp",
     "GaitdWholeBodyControllerInput",
     "GaitdWholeBodyControllerOutput",
     {"inverse_dynamics/inverse_dynamics_qp.h", "inverse_dynamics/inverse_dynamics_qp.cc",
      "inverse_dynamics/null_space_projector.h", "inverse_dynamics/null_space_projector.cc"}},
}};

// my_planner -> MyPlanner
std::string class_name(const std::string& name) {
  std::string result;
  bool upper = true;
  for (const char c : name) {
    if (c != '_') result += upper ? static_cast<char>(std::toupper(c)) : c;
    upper = c == '_';
  }
  return result;
}

void replace_all(std::string* text, const std::string& from, const std::string& to) {
  for (std::size_t at = text->find(from); at != std::string::npos;
       at = text->find(from, at + to.size())) {
    text->replace(at, from.size(), to);
  }
}

bool read(const fs::path& file, std::string* text) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return false;
  text->assign(std::istreambuf_iterator<char>(in), {});
  return true;
}

class Writer {
 public:
  Writer(const PluginProject& project, const Base& base)
      : project_(project),
        base_(base),
        sources_(project.prefix / "share/gaitd/plugin-sources" / base.layer),
        templates_(project.prefix / "share/gaitd/plugin-template") {
    words_ = {{"@NAME@", project.name},
              {"@LAYER@", project.layer},
              {"@BASE@", base.variant},
              {"@CLASS@", class_name(project.name)},
              {"@INPUT@", base.input},
              {"@OUTPUT@", base.output},
              {"@PREFIX@", project.prefix.string()}};
  }

  // All files in memory; empty, or what is missing.
  std::string read_all() {
    const std::string own = std::string(base_.variant) + "/" + base_.variant;
    std::string cc_files = project_.name + ".cc";
    copy(own + ".h", project_.name + ".h");
    copy(own + ".cc", project_.name + ".cc");
    copy(std::string(base_.variant) + "/adapter.cc", "adapter.cc");
    for (const char* file : base_.extra) {
      const std::string name = fs::path(file).filename();
      copy(file, name);
      if (name.ends_with(".cc")) cc_files += " " + name;
    }
    words_["@SOURCES@"] = cc_files;
    fill("CMakeLists.txt.in", "CMakeLists.txt");
    fill("README.md.in", "README.md");
    fill("test.cc.in", "test/" + project_.name + "_test.cc");
    fill("walk.yaml.in", "test/walk.yaml.in");
    return error_;
  }

  std::string write_all(std::vector<fs::path>* files) const {
    std::error_code error;
    fs::create_directories(project_.folder / "test", error);
    if (error) return project_.folder.string() + ": cannot make the folder: " + error.message();
    for (const auto& [name, text] : files_) {
      const fs::path file = project_.folder / name;
      std::ofstream out(file, std::ios::binary | std::ios::trunc);
      out << text << std::flush;
      if (!out) return file.string() + ": cannot write: " + std::strerror(errno);
      files->push_back(file);
    }
    return "";
  }

 private:
  std::string* take(const fs::path& from, const std::string& to) {
    std::string* text = &files_[to];
    if (!read(from, text) && error_.empty()) {
      error_ = from.string() +
               ": expected what new plugins begin with, got no file; install gaitd as a whole";
    }
    return text;
  }
  void copy(const std::string& from, const std::string& to) {
    std::string* text = take(sources_ / from, to);
    replace_all(text, base_.class_name, class_name(project_.name));
    replace_all(text, base_.variant, project_.name);
  }
  void fill(const std::string& from, const std::string& to) {
    std::string* text = take(templates_ / from, to);
    for (const auto& [word, value] : words_) replace_all(text, word, value);
  }

  const PluginProject& project_;
  const Base& base_;
  fs::path sources_;
  fs::path templates_;
  std::map<std::string, std::string> words_;
  std::map<std::string, std::string> files_;
  std::string error_;
};

std::string check_name(const PluginProject& project, const Base& base) {
  const std::string& name = project.name;
  const bool valid =
      !name.empty() && name.size() < 32 && std::islower(static_cast<unsigned char>(name[0])) &&
      std::all_of(name.begin(), name.end(),
                  [](unsigned char c) { return std::islower(c) || std::isdigit(c) || c == '_'; });
  if (!valid) {
    return "NAME: expected a name of a-z, 0-9 and _ that begins with a letter, like my_" +
           project.layer + ", got '" + name + "'";
  }
  for (const char* file : base.extra) {
    if (name == fs::path(file).stem() || name == "adapter") {
      return "NAME: '" + name + "' is the name of a file of the project; choose another one";
    }
  }
  return "";
}

}  // namespace

std::string write_plugin_project(const PluginProject& project, std::vector<fs::path>* files) {
  const auto base = std::find_if(kBases.begin(), kBases.end(),
                                 [&](const Base& b) { return project.layer == b.layer; });
  if (base == kBases.end()) return "LAYER: nothing to begin with for '" + project.layer + "'";
  std::string error = check_name(project, *base);
  if (!error.empty()) return error;
  std::error_code ignored;
  if (fs::exists(project.folder, ignored)) {
    return project.folder.string() + ": is there already; give another folder with -o";
  }
  Writer writer(project, *base);
  error = writer.read_all();
  if (!error.empty()) return error;
  error = writer.write_all(files);
  if (!error.empty()) fs::remove_all(project.folder, ignored);
  return error;
}

}  // namespace gaitd::cli

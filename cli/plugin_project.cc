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
#include <regex>
#include <system_error>

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

// What a new variant begins as, unless it is told otherwise: the one that is easiest to read.
struct Base {
  const char* layer;
  const char* variant;
  const char* input;
  const char* output;
};

const std::array<Base, 7> kBases = {{
    {"state_estimator", "kinematic_inertial", "GaitdStateEstimatorInput", "GaitdRobotState"},
    {"icp_planner", "single_cmp", "GaitdIcpPlannerInput", "GaitdIcpPlan"},
    {"step_adjuster", "fixed_steps", "GaitdStepAdjusterInput", "GaitdStepAdjustment"},
    {"toe_off", "icp_criteria", "GaitdToeOffInput", "GaitdToeOff"},
    {"whole_body_controller", "com_height_qp", "GaitdWholeBodyControllerInput",
     "GaitdWholeBodyControllerOutput"},
    {"task_source", "trajectory_player", "GaitdTaskSourceInput", "GaitdTaskReferences"},
    {"backend", "mujoco", "GaitdJointCommands", "GaitdSensors"},
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
        variant_(project.from.empty() ? base.variant : project.from),
        backend_(project.layer == "backend"),
        sources_(project.prefix / "share/gaitd/plugin-sources" / base.layer),
        templates_(project.prefix / "share/gaitd/plugin-template" /
                   (backend_ ? "backend" : "layer")) {
    words_ = {{"@NAME@", project.name},
              {"@LAYER@", project.layer},
              {"@BASE@", variant_},
              {"@CLASS@", class_name(project.name)},
              {"@INPUT@", base.input},
              {"@OUTPUT@", base.output},
              {"@PREFIX@", project.prefix.string()}};
  }

  // All files in memory; empty, or what is missing.
  std::string read_all() {
    std::error_code ignored;
    const std::string adapter = backend_ ? variant_ + "_backend.cc" : "adapter.cc";
    if (!fs::is_regular_file(sources_ / variant_ / adapter, ignored)) return no_such_variant();
    base_class_ = backend_ ? class_name(variant_) : exported_class(sources_ / variant_ / adapter);
    for (const auto& entry : fs::directory_iterator(sources_ / variant_, ignored)) {
      const fs::path extension = entry.path().extension();
      if (extension == ".h" || extension == ".cc") copy(entry.path());
    }
    copy_shared();
    std::string cc_files;
    for (const auto& [name, text] : files_) {
      const bool exports = name == "adapter.cc" || name == project_.name + "_backend.cc";
      if (name.ends_with(".cc") && !exports) cc_files += (cc_files.empty() ? "" : " ") + name;
    }
    words_["@SOURCES@"] = cc_files;
    fill("CMakeLists.txt.in", "CMakeLists.txt");
    fill("README.md.in", "README.md");
    if (!backend_) fill("test.cc.in", "test/" + project_.name + "_test.cc");
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
  std::string no_such_variant() const {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(sources_, ignored)) {
      const fs::path& folder = entry.path();
      const std::string name = folder.filename();
      const fs::path adapter = folder / (backend_ ? name + "_backend.cc" : "adapter.cc");
      if (fs::is_regular_file(adapter, ignored)) names.push_back(name);
    }
    if (names.empty()) {
      return sources_.string() +
             ": expected what new plugins begin with, got nothing; install gaitd as a whole";
    }
    std::sort(names.begin(), names.end());
    std::string text = "--from: no variant '" + variant_ + "' of " + project_.layer + "; there is:";
    for (const std::string& name : names) text += " " + name;
    return text;
  }

  // The class in GAITD_EXPORT_LAYER(gaitd::plugins::Class, ...).
  static std::string exported_class(const fs::path& adapter) {
    std::string text;
    read(adapter, &text);
    std::smatch match;
    const std::regex pattern(R"(GAITD_EXPORT_LAYER\(\s*[\w:]*?(\w+),)");
    return std::regex_search(text, match, pattern) ? match[1].str() : "";
  }

  // What the sources include from other folders of their layer.
  void copy_shared() {
    const std::regex include("#include \"([\\w]+)\\.h\"");
    for (bool found = true; found;) {
      found = false;
      const auto files = files_;
      for (const auto& [name, text] : files) {
        for (std::sregex_iterator it(text.begin(), text.end(), include), end; it != end; ++it) {
          const std::string stem = (*it)[1].str();
          if (files_.count(stem + ".h") != 0) continue;
          found |= copy_from_siblings(stem);
        }
      }
    }
  }

  bool copy_from_siblings(const std::string& stem) {
    std::error_code ignored;
    for (const auto& folder : fs::directory_iterator(sources_, ignored)) {
      const fs::path header = folder.path() / (stem + ".h");
      if (!fs::is_regular_file(header, ignored)) continue;
      copy(header);
      copy_sources_of(folder.path(), stem);
      return true;
    }
    return false;
  }

  // What implements a header may be in several files: those that have none of their own.
  void copy_sources_of(const fs::path& folder, const std::string& stem) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
      const fs::path& source = entry.path();
      if (source.extension() != ".cc" || source.filename() == "adapter.cc") continue;
      const bool own = source.stem() == stem;
      const bool others = fs::exists(fs::path(source).replace_extension(".h"), ignored);
      std::string text;
      if (own || (!others && read(source, &text) &&
                  text.find("#include \"" + stem + ".h\"") != std::string::npos)) {
        copy(source);
      }
    }
  }

  std::string* take(const fs::path& from, const std::string& to) {
    std::string* text = &files_[to];
    if (!read(from, text) && error_.empty()) {
      error_ = from.string() +
               ": expected what new plugins begin with, got no file; install gaitd as a whole";
    }
    return text;
  }
  void copy(const fs::path& from) {
    std::string name = from.filename();
    if (backend_) {
      replace_all(&name, variant_ + "_", project_.name + "_");
    } else if (name.starts_with(variant_ + ".") || name.starts_with(variant_ + "_")) {
      name.replace(0, variant_.size(), project_.name);
    }
    if (files_.count(name) != 0 && error_.empty()) {
      error_ =
          "NAME: '" + project_.name + "' is the name of a file of the project; choose another one";
    }
    std::string* text = take(from, name);
    if (!base_class_.empty()) replace_all(text, base_class_, class_name(project_.name));
    // The engine of a backend keeps its own name, in <engine/engine.h> say.
    replace_all(text, backend_ ? variant_ + "_" : variant_, project_.name + (backend_ ? "_" : ""));
    if (backend_) replace_all(text, "\"" + variant_ + "\"", "\"" + project_.name + "\"");
  }
  void fill(const std::string& from, const std::string& to) {
    std::string* text = take(templates_ / from, to);
    for (const auto& [word, value] : words_) replace_all(text, word, value);
  }

  const PluginProject& project_;
  std::string variant_;  // that it begins as
  bool backend_;
  fs::path sources_;
  fs::path templates_;
  std::string base_class_;
  std::map<std::string, std::string> words_;
  std::map<std::string, std::string> files_;
  std::string error_;
};

std::string check_name(const PluginProject& project) {
  const std::string& name = project.name;
  const bool valid =
      !name.empty() && name.size() < 32 && std::islower(static_cast<unsigned char>(name[0])) &&
      std::all_of(name.begin(), name.end(),
                  [](unsigned char c) { return std::islower(c) || std::isdigit(c) || c == '_'; });
  if (!valid) {
    return "NAME: expected a name of a-z, 0-9 and _ that begins with a letter, like my_" +
           project.layer + ", got '" + name + "'";
  }
  return "";
}

}  // namespace

std::string write_plugin_project(const PluginProject& project, std::vector<fs::path>* files) {
  const auto base = std::find_if(kBases.begin(), kBases.end(),
                                 [&](const Base& b) { return project.layer == b.layer; });
  if (base == kBases.end()) return "LAYER: nothing to begin with for '" + project.layer + "'";
  std::string error = check_name(project);
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

// SPDX-License-Identifier: Apache-2.0
#include "cli/scenario_run.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <system_error>
#include <thread>

#include "cli/private_daemon.h"
#include "cli/rpc_client.h"
#include "cli/verdict_view.h"
#include "cli/whole_file.h"
#include "daemon/config/paths.h"
#include "daemon/config/scenario.h"
#include "daemon/log/log_reader.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using daemon::Issues;
using daemon::Scenario;
using nlohmann::json;

// What gaitd prints. Not walk.txt beside walk.mcap, where somebody's own file may be: for example
// what gaitctl prints in `gaitctl run walk --log walk.mcap >walk.txt`.
fs::path output_of(const fs::path& log) { return log.string() + ".txt"; }

// Takes the name for this run, so that another one, begun in the same second, does not write there.
bool reserve(const fs::path& log) {
  std::error_code ignored;
  if (fs::exists(log, ignored)) return false;
  const int file = open(output_of(log).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file >= 0) close(file);
  return file >= 0 || errno != EEXIST;  // anything else the run will tell
}

// A name that no log in the folder, which exists, has: <scenario>-<UTC time>.mcap.
fs::path fresh_log(const fs::path& folder, const std::string& scenario) {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char stamp[32];
  std::strftime(stamp, sizeof(stamp), "%Y%m%d-%H%M%S", &utc);
  const std::string base = scenario + "-" + stamp;
  fs::path path = folder / (base + ".mcap");
  for (int i = 2; !reserve(path); ++i) {
    path = folder / (base + "-" + std::to_string(i) + ".mcap");
  }
  return path;
}

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return path.filename().empty() || fs::is_directory(path, ignored);
}

// Where the log of this scenario goes; its folder is made. Empty with a reason in `problem`.
fs::path choose_log(const fs::path& asked, const std::string& scenario, std::string* problem) {
  const bool file = !asked.empty() && !is_folder(asked);
  fs::path folder = asked.empty() ? default_log_folder() : file ? asked.parent_path() : asked;
  if (folder.empty()) folder = ".";
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) {
    if (asked.empty()) return fs::absolute(fresh_log(folder, scenario));
    return fs::absolute(file ? asked : folder / (scenario + ".mcap"));
  }
  *problem = "cannot make the folder " + folder.string() + ": " + error.message() +
             "; give another place with --log";
  return {};
}

// Of a log and of what gaitd prints beside it, as long as this lives.
class WriteLock {
 public:
  explicit WriteLock(const fs::path& log) {
    std::error_code ignored;
    for (const fs::path& file : {log, output_of(log)}) {
      const fs::file_status status = fs::symlink_status(file, ignored);
      if (!fs::exists(status) || fs::is_regular_file(status)) continue;
      reason_ =
          file.string() + " is no file that could be written anew; give another one with --log";
      return;
    }
    file_ = open(output_of(log).c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    // Who was killed needs a moment to end.
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    while (is_taken() && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    if (is_taken()) {
      reason_ = "another run writes " + log.string() + "; give another file with --log";
    }
  }
  ~WriteLock() {
    if (file_ >= 0) close(file_);
  }
  WriteLock(const WriteLock&) = delete;
  WriteLock& operator=(const WriteLock&) = delete;

  // Why it must not be written; empty: it may.
  const std::string& reason() const { return reason_; }

 private:
  // By another process; else it is ours from now on, or cannot be locked at all.
  bool is_taken() const {
    return file_ >= 0 && flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  }

  int file_ = -1;
  std::string reason_;
};

std::optional<Scenario> load(const RunOptions& options, RunReport* report) {
  const daemon::Paths paths = daemon::Paths::detect();
  const auto file = paths.scenario(report->scenario);
  if (!file) {
    report->problems.push_back("no scenario '" + report->scenario +
                               "'; give a name or the path of a file; " +
                               daemon::suggestion(report->scenario, paths.scenarios()));
    return std::nullopt;
  }
  report->file = file->string();
  daemon::Settings settings;
  Issues issues;
  for (const std::string& setting : options.settings) settings.set_assignment(setting, &issues);
  auto scenario = daemon::load_scenario(report->file, &settings, &issues);
  if (!issues.ok()) {
    report->problems.push_back(issues.error_text());
    return std::nullopt;
  }
  return scenario;
}

// The simulated time of the daemon there, if it answers at once.
std::optional<double> simulated_time(const std::string& socket) {
  std::string ignored;
  const auto client = RpcClient::connect({{socket}, true, daemon::Role::kObserve}, &ignored);
  if (!client) return std::nullopt;
  const daemon::RpcResult status = client->call("status", nullptr, std::chrono::milliseconds(500));
  const json* result = std::get_if<json>(&status);
  if (result == nullptr || !result->is_object()) return std::nullopt;
  const json time = result->value("time", json());
  if (!time.is_number()) return std::nullopt;
  return time.get<double>();
}

// The last lines of what the daemon printed.
std::string tail(const fs::path& file) {
  constexpr std::size_t kLines = 15;
  const std::string text = read_file(file);
  std::size_t begin = text.size();
  for (std::size_t lines = 0; begin > 0; --begin) {
    if (text[begin - 1] == '\n' && lines++ == kLines) break;
  }
  return text.substr(begin);
}

void report_end(const DaemonEnd& end, const fs::path& output, RunReport* report) {
  std::string what;
  if (end.interrupted) {
    report->interrupted = true;
    report->problems.push_back("interrupted");
    return;
  }
  if (end.signal != 0) {
    const char* name = sigabbrev_np(end.signal);
    what = "gaitd crashed with " +
           (name == nullptr ? "signal " + std::to_string(end.signal) : "SIG" + std::string(name));
  } else if (end.exit_code != 0) {
    what = "gaitd ended with exit code " + std::to_string(end.exit_code);
  } else {
    return;
  }
  const std::string last = tail(output);
  report->problems.push_back(what + "; its output is in " + output.string() +
                             (last.empty() ? ", and empty" : ", and ends with:\n" + last));
}

void judge(const Scenario& scenario, RunReport* report) {
  std::string error;
  const auto log = daemon::LogReader::open(report->log, &error);
  if (!log) {
    report->problems.push_back("no log to judge: " + error);
    return;
  }
  report->verdict = daemon::compute_verdict(*log, scenario.expect);
  // A gaitd that crashed cuts its log off: then the crash is what is wrong.
  const bool ended_well = report->problems.empty();
  for (const std::string& finding : log->damage().findings) {
    report->problems.push_back("the log is damaged: " + finding);
  }
  if (log->changed()) report->problems.push_back("the log was changed while it was judged");
  report->damaged = ended_well && (log->damage().any() || log->changed());
}

std::vector<std::string> refusals(const RunReport& report) {
  return report.verdict ? report.verdict->refusals : std::vector<std::string>();
}

std::string with_newline(std::string text) {
  if (!text.ends_with('\n')) text += '\n';
  return text;
}

}  // namespace

fs::path gaitd_program() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored).parent_path() / "gaitd";
}

fs::path default_log_folder() {
  const char* state = std::getenv("XDG_STATE_HOME");
  const char* home = std::getenv("HOME");
  fs::path folder;
  if (state != nullptr && state[0] == '/') {
    folder = fs::path(state) / "gaitd" / "logs";
  } else if (home != nullptr && home[0] == '/') {
    folder = fs::path(home) / ".local" / "state" / "gaitd" / "logs";
  }
  std::error_code error;
  if (!folder.empty()) fs::create_directories(folder, error);
  const bool usable = !folder.empty() && !error && access(folder.c_str(), W_OK | X_OK) == 0;
  return usable ? folder : fs::path("gaitd-logs");
}

RunReport run_scenario(const std::string& name, const RunOptions& options,
                       const Progress& progress) {
  RunReport report;
  report.scenario = name;
  const std::optional<Scenario> scenario = load(options, &report);
  if (!scenario) return report;
  std::string problem;
  const fs::path log = choose_log(options.log, scenario->name, &problem);
  if (log.empty()) {
    report.problems.push_back(problem);
    return report;
  }
  report.log = log.string();
  const WriteLock lock(log);
  if (!lock.reason().empty()) {
    report.problems.push_back(lock.reason());
    return report;
  }
  // An old log of this name must never be judged as the new one.
  std::error_code ignored;
  fs::remove(log, ignored);

  DaemonRun run{options.gaitd,    report.file,   log,          output_of(log),
                options.settings, options.trust, options.robot};
  Watch watch;
  if (progress) {
    watch = [&](const std::string& socket) {
      if (const auto time = simulated_time(socket)) {
        progress(scenario->name, *time, scenario->duration);
      }
    };
  }
  const std::optional<DaemonEnd> end = run_daemon(run, watch, &problem);
  if (!end) {
    report.problems.push_back(problem);
    return report;
  }
  report_end(*end, run.output, &report);
  if (!report.interrupted) judge(*scenario, &report);
  return report;
}

std::string report_text(const RunReport& report, bool figures, std::size_t columns) {
  std::string out;
  for (const std::string& refusal : refusals(report)) {
    out += with_newline("  refused at " + refusal);
  }
  for (const std::string& problem : report.problems) out += with_newline("  " + problem);
  if (report.verdict) {
    out += expectations_text(*report.verdict, columns);
    if (figures) out += figures_text(*report.verdict);
  }
  if (!report.log.empty()) out += "log: " + report.log + "\n";
  return out;
}

std::string verdict_line(const RunReport& report) {
  const bool fell = report.verdict && report.verdict->figure("falls") > 0.0;
  return report.scenario + ": " + (report.pass() ? "PASS" : "FAIL") +
         (report.pass() && fell ? ", a fall that the scenario allows" : "");
}

std::string what_failed(const RunReport& report) {
  std::string out;
  for (const std::string& problem : report.problems) {
    out += (out.empty() ? "" : ", ") + problem.substr(0, problem.find_first_of(";\n"));
  }
  if (!report.verdict) return out;
  const std::string expectations = failed_expectations(*report.verdict);
  return out + (out.empty() || expectations.empty() ? "" : ", ") + expectations;
}

json report_json(const RunReport& report) {
  json out = {{"scenario", report.scenario},
              {"file", report.file},
              {"log", report.log},
              {"pass", report.pass()},
              {"refusals", refusals(report)},
              {"problems", report.problems},
              {"damaged", report.damaged},
              {"verdict", nullptr}};
  if (report.verdict) {
    out["verdict"] = json::parse(daemon::verdict_json(*report.verdict), nullptr, false);
  }
  return out;
}

}  // namespace gaitd::cli

// SPDX-License-Identifier: Apache-2.0
#include "cli/drive_command.h"

#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>

#include "cli/ask.h"
#include "cli/failure.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/stop_signals.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kRenewal{100};
constexpr milliseconds kAnswer{2000};      // waited for; the robot has stopped itself by then
constexpr std::chrono::seconds kStop{30};  // from the last velocity to the stand

struct DriveOptions {
  std::shared_ptr<json> velocity = std::make_shared<json>(json::object());
  double seconds = 0.0;  // 0: until it is interrupted
};

// Two that drive at a time are told apart by it.
std::int64_t session() {
  const std::int64_t now = Clock::now().time_since_epoch().count();
  return ((now << 16) ^ getpid()) & ((std::int64_t{1} << 53) - 1);
}

// Which of the standard streams lead to nobody any more. Over ssh without a terminal no signal
// tells that the connection has ended, and who drives is no longer there.
unsigned hung_up() {
  pollfd streams[] = {{STDIN_FILENO, 0, 0}, {STDOUT_FILENO, 0, 0}, {STDERR_FILENO, 0, 0}};
  poll(streams, std::size(streams), 0);
  unsigned gone = 0;
  for (const pollfd& stream : streams) {
    if ((stream.revents & (POLLHUP | POLLERR)) != 0) gone |= 1u << stream.fd;
  }
  return gone;
}

int drive(const Context& context, const DriveOptions& options) {
  const StopSignals signals;
  const unsigned without = hung_up();  // an input that ended before is none that ends
  const auto client = connect(context, "drive", daemon::least_role("drive"));
  if (!client) return kNoDaemon;
  json params = *options.velocity;
  params["session"] = session();
  const auto begin = Clock::now();
  const auto over = [&] {
    const std::chrono::duration<double> time = Clock::now() - begin;
    return StopSignals::requested() || (hung_up() & ~without) != 0 ||
           (options.seconds > 0.0 && time.count() >= options.seconds);
  };
  std::optional<Waiting> driving("driving");
  std::string told;
  json answer;
  for (bool last = false;;) {
    if (last) params = {{"session", params["session"]}, {"end", true}};
    const daemon::RpcResult result = client->call("drive", params, kAnswer);
    if (const auto* error = std::get_if<daemon::RpcError>(&result)) {
      driving.reset();
      return fail(context, "drive", "drive", *error);
    }
    if (last) break;
    answer = std::get<json>(result);
    const json note = answer.is_object() ? answer.value("note", json()) : json();
    const std::string text = note.is_string() ? note.get<std::string>() : "";
    if (!context.json && !text.empty() && text != told) {
      driving.reset();
      std::cout << text << std::endl;
      driving.emplace("driving");
    }
    told = text;
    for (auto next = Clock::now() + kRenewal; Clock::now() < next && !over();) {
      std::this_thread::sleep_for(milliseconds(10));
    }
    last = over();
    params["renew"] = true;
  }
  if (!context.json && answer.is_object()) answer.erase("note");  // has been told
  driving.emplace("coming to a stand");
  // Or somebody else has given it something to do.
  const std::string faults = wait_while(client.get(), "walking", kStop);
  driving.reset();
  if (!faults.empty()) return fail(context, kFailed, "drive", faults);
  std::cout << (context.json ? json_text(answer) : result_text("drive", "drive", answer))
            << std::flush;
  return kDone;
}

}  // namespace

void add_drive_command(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "drive", "Walk at a velocity until Ctrl-C, in the place of the footsteps ahead");
  command->footer(
      "Whoever drives last has the robot: an earlier drive ends and says so. The robot comes to a\n"
      "stand by itself when this program ends however it may (drive.timeout), and this program "
      "ends\n"
      "with the connection that it was started over.");
  auto options = std::make_shared<DriveOptions>();
  const auto& velocity = options->velocity;
  add_number(command, "--forward", velocity, "/forward", "Speed ahead, m/s");
  add_number(command, "--lateral", velocity, "/lateral",
             "Speed sideways, m/s, positive to the left");
  add_number(command, "--turn", velocity, "/turn",
             "Speed of the turn, rad/s, positive to the left");
  command
      ->add_option("--for", options->seconds,
                   "End after this time, s, 0.1 to 3600, when the robot stands; else at Ctrl-C")
      ->check(CLI::Range(0.1, 3600.0))
      ->type_name("S");
  command->callback([context, options] {
    if (options->velocity->empty()) {
      throw CLI::RequiredError("drive: one of --forward, --lateral and --turn");
    }
    context->action = [context, options] { return drive(*context, *options); };
  });
}

}  // namespace gaitd::cli

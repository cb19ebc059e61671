// SPDX-License-Identifier: Apache-2.0
#include "cli/view/view_command.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/child.h"
#include "cli/failure.h"
#include "cli/print.h"
#include "cli/rpc_client.h"
#include "cli/view/certificate.h"
#include "cli/view/live_view.h"

namespace gaitd::cli {
namespace {

using daemon::Role;

struct ViewArguments {
  std::string listen = "127.0.0.1:8765";
  std::vector<std::string> origins;
  std::string folder = ".";
  bool watch_only = false;
  bool open = false;
};

// What this user may do at gaitd; who may not even watch gets the reason.
std::optional<Role> role_at_gaitd(const Context& context, std::string* error) {
  const auto client = RpcClient::connect(Destination::of(context.socket, Role::kAdminister), error);
  if (!client) return std::nullopt;
  const auto answer = client->call("version", nullptr);
  if (const auto* refused = std::get_if<daemon::RpcError>(&answer)) {
    *error = refused->message;
    return std::nullopt;
  }
  const std::string name = std::get<nlohmann::json>(answer).value("role", "observe");
  for (std::size_t i = 0; i < daemon::kRoleNames.size(); ++i) {
    if (daemon::kRoleNames[i] == name) return static_cast<Role>(i);
  }
  return Role::kObserve;
}

// Addresses of this machine by which others may reach it.
std::vector<std::string> reachable_addresses() {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return {};
  std::vector<std::string> found;
  for (const ifaddrs* one = list; one != nullptr; one = one->ifa_next) {
    constexpr unsigned kUp = IFF_UP | IFF_RUNNING;
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    if ((one->ifa_flags & kUp) != kUp || (one->ifa_flags & IFF_LOOPBACK) != 0) continue;
    char text[INET_ADDRSTRLEN];
    const auto* address = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
    if (inet_ntop(AF_INET, &address->sin_addr, text, sizeof(text)) != nullptr) {
      found.emplace_back(text);
    }
  }
  freeifaddrs(list);
  return found;
}

// What a browser has to be given: of 0.0.0.0, which means all, each: it may reach only one of them.
std::vector<std::string> bases_of(const ListenAddress& address, unsigned short port) {
  const bool any = boost::asio::ip::make_address(address.address).is_unspecified();
  std::vector<std::string> bases =
      any ? reachable_addresses() : std::vector<std::string>{address.address};
  if (bases.empty()) bases.emplace_back("localhost");
  for (std::string& base : bases) {
    std::string host = base.find(':') == std::string::npos ? base : "[" + base + "]";
    base = address.loopback ? "http://" : "https://";
    base.append(host).append(":").append(std::to_string(port));
  }
  return bases;
}

void print_addresses(const Context& context, const std::vector<std::string>& bases,
                     const Access& access, const std::string& fingerprint) {
  const auto page = [&](const std::string& base, Role role) {
    return base + "/#token=" + access.token(role);
  };
  if (context.json) {
    nlohmann::json result;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(access.highest()); ++i) {
      result[std::string(daemon::kRoleNames[i])] = page(bases.front(), static_cast<Role>(i));
    }
    if (bases.size() > 1) result["bases"] = bases;
    if (!fingerprint.empty()) result["fingerprint"] = fingerprint;
    std::cout << json_text(result) << std::flush;
    return;
  }
  for (const std::string& base : bases) {
    std::cout << "live page: " << page(base, access.highest()) << "\n";
    if (access.highest() == Role::kAdminister) {
      std::cout << "  to walk it:   " << page(base, Role::kCommand) << "\n";
    }
    if (access.highest() > Role::kObserve) {
      std::cout << "  to watch:     " << page(base, Role::kObserve) << "\n";
    }
  }
  if (!fingerprint.empty()) std::cout << "  certificate:  SHA-256 " << fingerprint << "\n";
  std::cout << "Whoever has an address may do what it says. Ctrl-C ends it." << std::endl;
}

void open_browser(const std::string& page) {
  if (start_child({"/usr/bin/xdg-open", page}, "/dev/null", "/dev/null") < 0) {
    std::cerr << "gaitctl: view: cannot open a browser (xdg-open); open the address yourself\n";
  }
}

int run(const Context& context, const ViewArguments& arguments) {
  std::string error;
  const auto address = parse_listen_address(arguments.listen, &error);
  if (!address) return fail(context, kUsage, "view", error);
  std::string page = live_page(&error);
  if (page.empty()) return fail(context, kFailed, "view", error);
  auto role = role_at_gaitd(context, &error);
  if (!role) return fail(context, kNoDaemon, "view", error);
  if (arguments.watch_only) role = Role::kObserve;
  Certificate certificate;
  if (!address->loopback) {
    certificate = own_certificate(certificate_file(), &error);
    if (!certificate.context) return fail(context, kFailed, "view", error);
  }

  boost::asio::io_context io(1);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGCHLD, SIG_IGN);  // of the browser
  LiveView view(&io, context.socket, Access(*role, arguments.origins), std::move(page),
                arguments.folder);
  WebServer server(&io, &view, certificate.context.get());
  if (!server.listen(*address, &error)) return fail(context, kFailed, "view", error);
  const std::vector<std::string> bases = bases_of(*address, server.port());
  print_addresses(context, bases, view.access(), certificate.fingerprint);
  if (arguments.open) open_browser(bases.front() + "/#token=" + view.access().token(*role));
  view.start();
  boost::asio::signal_set signals(io, SIGINT, SIGTERM, SIGHUP);
  signals.async_wait([&](boost::system::error_code, int) {
    server.stop();
    view.stop();
    io.stop();
  });
  io.run();
  return kDone;
}

}  // namespace

void add_view_command(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "view", "Serves a page that shows the robot live, pushes it, and walks it with a stick");
  command->footer(
      "The page runs in a browser, on a phone too. Everybody who opens it needs a token, which is "
      "in\nthe addresses that are printed, one for each role that you have. Away from this machine "
      "it is\nserved over TLS with a certificate of your own, whose fingerprint is printed. "
      "docs/view.md.");
  auto arguments = std::make_shared<ViewArguments>();
  command->add_option("--listen", arguments->listen, "Where browsers connect")
      ->type_name("ADDRESS:PORT")
      ->capture_default_str();
  command->add_flag("--watch-only", arguments->watch_only, "Give out the address to watch only");
  command
      ->add_option("--origin", arguments->origins,
                   "Page of another address that may connect, as https://app.foxglove.dev")
      ->type_name("URL");
  command->add_option("--recordings", arguments->folder, "Folder for the logs that are recorded")
      ->type_name("FOLDER")
      ->check(CLI::ExistingDirectory)
      ->capture_default_str();
  command->add_flag("--open", arguments->open, "Open the page in the browser of this desktop");
  command->callback([context, arguments] {
    context->action = [context, arguments] { return run(*context, *arguments); };
  });
}

}  // namespace gaitd::cli

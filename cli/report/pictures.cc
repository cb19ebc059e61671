// SPDX-License-Identifier: Apache-2.0
#include "cli/report/pictures.h"

#include <sys/wait.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <thread>

#include "cli/child.h"
#include "daemon/config/names.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kBrowserTime(600);  // on a busy machine

// As the page writes them: cli/page/src/report/pictures.js.
constexpr std::string_view kPicture = "<img id=\"";
constexpr std::string_view kData = "\" src=\"data:image/png;base64,";

// The browser that draws, or nothing.
fs::path find_browser() {
  const char* path = std::getenv("PATH");
  std::string rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t colon = rest.find(':');
    const fs::path file = fs::path(rest.substr(0, colon)) / "chromium";
    std::error_code ignored;
    if (fs::exists(file, ignored)) return file;
    rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
  }
  return {};
}

// False if it had to be killed.
bool wait_for_child(pid_t pid, std::chrono::seconds most) {
  const auto end = std::chrono::steady_clock::now() + most;
  while (waitpid(pid, nullptr, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end) {
      kill(pid, SIGKILL);
      waitpid(pid, nullptr, 0);
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

std::string from_base64(std::string_view text) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) break;  // '=' at the end
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 255u);
  }
  return bytes;
}

// All pictures in what the browser made of the page. Empty, or the reason why not.
std::string write_pictures(std::string_view document, const fs::path& folder) {
  int written = 0;
  for (std::size_t at = 0; (at = document.find(kPicture, at)) != std::string_view::npos;) {
    at += kPicture.size();
    const std::size_t data = document.find(kData, at);
    if (data == std::string_view::npos) break;
    const std::string_view name = document.substr(at, data - at);
    if (!daemon::is_file_name(name)) continue;
    const std::size_t begin = data + kData.size();
    const std::size_t end = document.find('"', begin);
    if (end == std::string_view::npos) break;
    const fs::path file = folder / (std::string(name) + ".png");
    std::ofstream out(file, std::ios::binary | std::ios::trunc);
    out << from_base64(document.substr(begin, end - begin)) << std::flush;
    if (!out) return file.string() + ": cannot write: " + std::strerror(errno);
    ++written;
    at = end;
  }
  return written > 0 ? "" : "it drew nothing";
}

}  // namespace

std::string draw_pictures(const fs::path& page, const fs::path& folder) {
  const fs::path browser = find_browser();
  if (browser.empty()) return "--png needs chromium; install it (apt-get install chromium)";
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return folder.string() + ": cannot make the folder: " + error.message();
  const fs::path document = folder / ".drawn.html";
  const pid_t pid = start_child({browser.string(), "--headless", "--no-sandbox", "--disable-gpu",
                                 "--virtual-time-budget=10000", "--dump-dom",
                                 "file://" + fs::absolute(page).string() + "#pictures"},
                                document.string(), "/dev/null");
  if (pid < 0) return "cannot start " + browser.string() + ": " + std::strerror(errno);
  const bool ended = wait_for_child(pid, kBrowserTime);
  std::ifstream in(document, std::ios::binary);
  const std::string drawn{std::istreambuf_iterator<char>(in), {}};
  fs::remove(document, error);
  if (!ended) return browser.string() + " did not end while it drew " + page.string();
  const std::string problem = write_pictures(drawn, folder);
  return problem.empty() ? "" : browser.string() + ": " + page.string() + ": " + problem;
}

}  // namespace gaitd::cli

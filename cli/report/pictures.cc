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
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "cli/child.h"
#include "cli/report/animated_png.h"
#include "cli/whole_file.h"
#include "daemon/config/names.h"
#include "daemon/server/base64.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kBrowserTime(600);  // on a busy machine

constexpr int kFilmRate = 10;  // frames per second; cli/page/src/report/film.js draws as many

// As the page writes them: cli/page/src/report/pictures.js.
constexpr std::string_view kPicture = "<img id=\"";
constexpr std::string_view kData = "\" src=\"data:image/png;base64,";

// The browser that draws, or nothing.
fs::path find_browser() {
  const char* path = std::getenv("PATH");
  std::string rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t colon = rest.find(':');
    fs::path file = fs::path(rest.substr(0, colon)) / "chromium";
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

struct Picture {
  std::string name;
  std::string png;
};

// Those in what the browser made of the page.
std::vector<Picture> read_pictures(std::string_view document) {
  std::vector<Picture> pictures;
  for (std::size_t at = 0; (at = document.find(kPicture, at)) != std::string_view::npos;) {
    at += kPicture.size();
    const std::size_t data = document.find(kData, at);
    if (data == std::string_view::npos) break;
    const std::string_view name = document.substr(at, data - at);
    if (!daemon::is_file_name(name)) continue;
    const std::size_t begin = data + kData.size();
    const std::size_t end = document.find('"', begin);
    if (end == std::string_view::npos) break;
    pictures.push_back(
        {std::string(name), daemon::from_base64(document.substr(begin, end - begin))});
    at = end;
  }
  return pictures;
}

// What chromium draws of the page with this fragment; none, with the reason.
std::vector<Picture> draw(const fs::path& page, const std::string& fragment, const fs::path& folder,
                          std::string* problem) {
  const fs::path browser = find_browser();
  if (browser.empty()) {
    *problem = "pictures need chromium; install it (apt-get install chromium)";
    return {};
  }
  const fs::path document = folder / ".drawn.html";
  const pid_t pid = start_child({browser.string(), "--headless", "--no-sandbox", "--disable-gpu",
                                 "--virtual-time-budget=10000", "--dump-dom",
                                 "file://" + fs::absolute(page).string() + fragment},
                                document.string(), "/dev/null");
  if (pid < 0) {
    *problem = "cannot start " + browser.string() + ": " + std::strerror(errno);
    return {};
  }
  const bool ended = wait_for_child(pid, kBrowserTime);
  const std::string drawn = read_file(document);
  std::error_code ignored;
  fs::remove(document, ignored);
  std::vector<Picture> pictures;
  if (ended) pictures = read_pictures(drawn);
  if (pictures.empty()) {
    *problem = browser.string() + (ended ? " drew nothing of " : " did not end while it drew ") +
               page.string();
  }
  return pictures;
}

// Empty, or the reason why not.
std::string write(const fs::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << bytes << std::flush;
  return out ? "" : file.string() + ": cannot write: " + std::strerror(errno);
}

}  // namespace

std::string draw_pictures(const fs::path& page, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return folder.string() + ": cannot make the folder: " + error.message();
  std::string problem;
  for (const Picture& picture : draw(page, "#pictures", folder, &problem)) {
    if (problem.empty()) problem = write(folder / (picture.name + ".png"), picture.png);
  }
  return problem;
}

std::string draw_film(const fs::path& page, const fs::path& file, double from, double to) {
  std::string problem;
  const fs::path folder = fs::absolute(file).parent_path();
  std::vector<std::string> frames;
  const std::string span = std::to_string(from) + "," + std::to_string(to);
  for (Picture& picture : draw(page, "#film=" + span, folder, &problem)) {
    frames.push_back(std::move(picture.png));
  }
  if (!problem.empty()) return problem;
  const std::string film = animated_png(frames, kFilmRate);
  return film.empty() ? "what the browser drew are no PNG pictures" : write(file, film);
}

}  // namespace gaitd::cli

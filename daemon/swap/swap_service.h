// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "daemon/config/settings.h"
#include "daemon/control/swap_port.h"
#include "daemon/host/library_folders.h"
#include "daemon/host/plugin_directory.h"
#include "daemon/parameters/live_parameters.h"
#include "daemon/server/command_bridge.h"
#include "daemon/telemetry/telemetry.h"

namespace gaitd::daemon {

/// Loads layers on a thread of its own, gives them to the control thread, and tells the caller and
/// the log what became of them. Destroys what the control thread has retired. Nothing of a library
/// is touched before it is known that a swap may begin now and that the library may be loaded.
class SwapService {
 public:
  struct Parts {
    const GaitdModel* model;
    const PluginDirectory* directory;
    /// For libraries that are named by their path.
    LibraryFolders folders;
    bool any_file_for_clients = false;    ///< whatever folder it is in
    bool any_file_for_scenarios = false;  ///< likewise
    Settings* settings;                   ///< of this thread alone from start() on
    LiveParameters* parameters;
    Telemetry* telemetry;
    CommandBridge* bridge;  ///< may be null
    PluginLog log;
    /// The words of the signals layer/<layer>/variant; the last one is for any other variant.
    std::array<std::vector<std::string>, GAITD_LAYER_COUNT> words;
    std::array<std::string, GAITD_LAYER_COUNT> in_use;  ///< variants, at the start
  };

  explicit SwapService(Parts parts);
  ~SwapService();  ///< stops

  void start();
  /// After the control thread has ended: refuses what waits, ends the child that tries a library,
  /// and joins.
  void stop();
  SwapPort& port() { return port_; }

  /// [server thread] Adds plugin.swap {layer, to} and plugin.rollback {layer}. They are answered
  /// when the swap is over: done, refused or rolled back; at once with "busy" while another swap of
  /// the same layer, or bounds::kOpenSwaps of any, are not over.
  void add_methods(Methods* methods);
  /// [any thread but rt] The variant in use, and its library.
  std::string variant(int layer) const;
  std::string file(int layer) const;

 private:
  struct Wanted {
    std::uint64_t request = 0;
    int layer = -1;
    std::string to;  // empty: rollback
    bool from_scenario = false;
    std::int64_t tick = 0;
    double time = 0.0;
  };
  // A swap that was given to the control thread.
  struct UnderWay {
    Wanted wanted;
    nlohmann::json what;  // layer, variant, file, hash, parameters
    nlohmann::json steps = nlohmann::json::array();
  };
  struct Library {
    std::string variant;
    std::string file;
  };
  struct Names {
    Library in_use;
    Library before;
    Library before_that;  // while the newest is on probation
  };

  std::optional<RpcError> admit(const std::string& method, const Wanted& wanted);
  void answer(const Wanted& wanted, RpcResult result);
  void run();
  void drop_the_rest();
  bool take_wanted(Wanted* wanted);
  void carry_out(const Wanted& wanted);
  bool may_swap(std::string* error) const;
  std::optional<std::filesystem::path> find(const Wanted& wanted, std::string* error) const;
  bool load(const Wanted& wanted, SwapOrder* order, nlohmann::json* what, std::string* error);
  std::vector<double> values_for(int layer, const GaitdPluginDescriptor& descriptor, int table,
                                 std::string* error);
  void refuse(const Wanted& wanted, const std::string& why);
  void follow(const SwapReport& report);
  void finish(UnderWay& swap, const SwapReport& report);

  Parts parts_;
  SwapPort port_;
  std::map<std::uint64_t, UnderWay> under_way_;
  std::uint64_t next_of_scenario_ = std::uint64_t{1} << 63;  // apart from those of the bridge
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Wanted> wanted_;
  int open_ = 0;                                     // of clients, not answered
  std::array<int, GAITD_LAYER_COUNT> open_swaps_{};  // of them, without rollbacks
  std::array<Names, GAITD_LAYER_COUNT> names_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace gaitd::daemon

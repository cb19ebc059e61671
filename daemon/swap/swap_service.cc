// SPDX-License-Identifier: Apache-2.0
#include "daemon/swap/swap_service.h"

#include <pthread.h>

#include <algorithm>
#include <chrono>

#include "daemon/host/layers.h"
#include "daemon/host/plugin_file.h"
#include "gaitd/sdk/bounds.h"
#include "gaitd/sdk/layer_names.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;
constexpr auto kPoll = std::chrono::milliseconds(2);

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (std::size_t at; (at = text.find('\n')) != std::string::npos;) text.replace(at, 1, "; ");
  return text;
}

RpcError invalid(const std::string& method, const std::string& what) {
  return {rpc_code::kInvalidParams, method + ": " + what};
}

// What a plugin says of itself need not be UTF-8.
std::string text_of(const json& event) {
  return event.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

SwapService::SwapService(Parts parts) : parts_(std::move(parts)) {
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    std::string error;
    const auto file = parts_.directory->find(layer, parts_.in_use[layer], &error);
    names_[layer].in_use = {parts_.in_use[layer], file ? file->string() : ""};
  }
}

SwapService::~SwapService() { stop(); }

void SwapService::start() {
  thread_ = std::thread([this] { run(); });
  pthread_setname_np(thread_.native_handle(), "gaitd-swap");
}

void SwapService::stop() {
  if (!thread_.joinable()) return;
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
  SwapOrder order;
  while (port_.next_order(order)) delete order.candidate;
}

std::string SwapService::variant(int layer) const {
  const std::scoped_lock lock(mutex_);
  return names_[layer].in_use.variant;
}

std::string SwapService::file(int layer) const {
  const std::scoped_lock lock(mutex_);
  return names_[layer].in_use.file;
}

void SwapService::add_methods(Methods* methods) {
  const auto add = [this, methods](const std::string& name, bool rollback) {
    methods->add_async(
        name, [this, name, rollback](const json& params, const Caller&, Respond respond) {
          const auto text = [&params](const char* key) {
            const auto found = params.is_object() ? params.find(key) : params.end();
            return found != params.end() && found->is_string() ? found->get<std::string>() : "";
          };
          const std::string to = text("to");
          const auto layer = layer_from_name(text("layer"));
          if (!layer || *layer >= GAITD_LAYER_COUNT || params.size() != (rollback ? 1 : 2) ||
              to.empty() != rollback || to.size() >= bounds::kPathBytes ||
              to.find('\0') != std::string::npos) {
            std::string layers;
            for (const std::string_view one : sdk::kLayerNames) {
              layers += (layers.empty() ? "" : ", ") + std::string(one);
            }
            return respond(invalid(
                name, std::string("expected {\"layer\": ") + "one of " + layers +
                          (rollback ? "}" : ", \"to\": a variant or the path of a library}")));
          }
          Wanted wanted;
          wanted.layer = *layer;
          wanted.to = to;
          wanted.tick = parts_.telemetry->newest_tick();
          wanted.time = static_cast<double>(wanted.tick) * parts_.telemetry->period();
          if (auto error = admit(name, wanted)) return respond(std::move(*error));
          wanted.request = parts_.bridge->open(std::move(respond));
          {
            const std::scoped_lock lock(mutex_);
            wanted_.push_back(std::move(wanted));
          }
          wake_.notify_all();
        });
  };
  add("plugin.swap", false);
  add("plugin.rollback", true);
}

// Counts the request of a client until it is answered, or says why there is no room for it.
std::optional<RpcError> SwapService::admit(const std::string& method, const Wanted& wanted) {
  const std::scoped_lock lock(mutex_);
  if (stopping_) return RpcError{rpc_code::kStopping, method + ": gaitd is stopping"};
  int& of_layer = open_swaps_[wanted.layer];
  if (!wanted.to.empty() && of_layer > 0) {
    return RpcError{rpc_code::kBusy, method + ": busy: a swap of " +
                                         std::string(layer_name(wanted.layer)) +
                                         " is under way; wait until it is done"};
  }
  if (open_ >= bounds::kOpenSwaps) {
    return RpcError{rpc_code::kBusy, method + ": busy: " + std::to_string(open_) +
                                         " swaps are under way; wait until they are done"};
  }
  ++open_;
  if (!wanted.to.empty()) ++of_layer;
  return std::nullopt;
}

void SwapService::answer(const Wanted& wanted, RpcResult result) {
  if (parts_.bridge == nullptr || wanted.from_scenario) return;
  {
    const std::scoped_lock lock(mutex_);
    --open_;
    if (!wanted.to.empty()) --open_swaps_[wanted.layer];
  }
  parts_.bridge->answer(wanted.request, std::move(result));
}

void SwapService::run() {
  while (!stopping_) {
    Wanted wanted;
    while (!stopping_ && take_wanted(&wanted)) carry_out(wanted);
    SwapReport report;
    while (port_.next_report(report)) follow(report);
    std::unique_lock lock(mutex_);
    if (!stopping_ && wanted_.empty()) wake_.wait_for(lock, kPoll);
  }
  drop_the_rest();
}

void SwapService::drop_the_rest() {
  SwapReport report;
  while (port_.next_report(report)) follow(report);
  Wanted wanted;
  const RpcError why{rpc_code::kStopping, "gaitd is stopping; the layer was not exchanged"};
  while (take_wanted(&wanted)) answer(wanted, why);
}

bool SwapService::take_wanted(Wanted* wanted) {
  SwapRequest request;
  if (port_.next_request(request)) {
    *wanted = {next_of_scenario_++, request.layer, request.to.data(), true,
               request.tick,        request.time};
    return true;
  }
  const std::scoped_lock lock(mutex_);
  if (wanted_.empty()) return false;
  *wanted = std::move(wanted_.front());
  wanted_.pop_front();
  return true;
}

void SwapService::carry_out(const Wanted& wanted) {
  SwapOrder order{
      .request = wanted.request, .layer = wanted.layer, .from_scenario = wanted.from_scenario};
  json what = {{"layer", layer_name(wanted.layer)}};
  std::string error;
  const bool good = may_swap(&error) && (wanted.to.empty() || load(wanted, &order, &what, &error));
  if (good) under_way_[wanted.request] = {wanted, std::move(what)};
  // A scenario waits for what became of it.
  if (!good) order = {.layer = -1, .from_scenario = wanted.from_scenario};
  if ((good || wanted.from_scenario) && !port_.order(order)) {
    delete order.candidate;
    under_way_.erase(wanted.request);
    error = "too many swaps at once; try again later";
  }
  if (!error.empty()) refuse(wanted, error);
}

bool SwapService::may_swap(std::string* error) const {
  const char* why = swap_refusal(port_.right());
  if (why != nullptr) *error = why;
  return why == nullptr;
}

// The values that the configuration gives it; for a variant that was in use before, those it had.
std::vector<double> SwapService::values_for(int layer, const GaitdPluginDescriptor& d, int table,
                                            std::string* error) {
  if (table >= 0) return parts_.parameters->values(table);
  Issues issues;
  auto values =
      parts_.settings->resolve(layer_name(layer), {d.parameters, d.parameter_count}, &issues, d.id);
  if (!issues.ok()) *error = one_line(issues.error_text());
  return values;
}

// The library that is wanted, if it may be loaded.
std::optional<std::filesystem::path> SwapService::find(const Wanted& wanted,
                                                       std::string* error) const {
  const bool any_file =
      wanted.from_scenario ? parts_.any_file_for_scenarios : parts_.any_file_for_clients;
  return PluginDirectory::is_path(wanted.to) && !any_file
             ? parts_.folders.admit(wanted.to, error)
             : parts_.directory->find(wanted.layer, wanted.to, error);
}

bool SwapService::load(const Wanted& wanted, SwapOrder* order, json* what, std::string* error) {
  const auto began = std::chrono::steady_clock::now();
  const auto path = find(wanted, error);
  if (!path) return false;
  Refusal refusal;
  auto file = read_plugin_file(*path, wanted.layer, &refusal);
  if (!file) {
    *error = one_line(refusal.text());
    return false;
  }
  const GaitdPluginDescriptor d = file->descriptor;
  const std::span<const GaitdParameter> declared{d.parameters, d.parameter_count};
  LoadedLayer::Request request;
  request.layer = wanted.layer;
  request.model = parts_.model;
  order->table = parts_.parameters->find_table(wanted.layer, d.id, declared);
  request.parameters = values_for(wanted.layer, d, order->table, error);
  request.probe_options.cancel = &stopping_;
  request.log = parts_.log;
  if (!error->empty()) return false;
  auto layer = LoadedLayer::load(std::move(*file), request, &refusal);
  if (layer == nullptr) {
    *error = one_line(refusal.text());
    return false;
  }
  // Only now, since there is room for so many and none is ever given back.
  if (order->table < 0 && !declared.empty()) {
    order->table = parts_.parameters->add(wanted.layer, layer_name(wanted.layer), d.id, declared,
                                          request.parameters);
    if (order->table < 0) {
      *error = "too many different tables of parameters; start gaitd again";
      return false;
    }
  }
  const auto& words = parts_.words[wanted.layer];
  const auto word = std::find(words.begin(), words.end() - 1, d.id);
  order->variant = static_cast<int>(word - words.begin());
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - began;
  *what = {{"layer", layer_name(wanted.layer)},
           {"variant", d.id},
           {"version", d.version},
           {"file", path->string()},
           {"hash", layer->library().hash()},
           {"parameters", request.parameters},
           {"staged_ms", took.count()}};
  order->candidate = layer.release();
  return true;
}

// Before the control thread has seen anything of it.
void SwapService::refuse(const Wanted& wanted, const std::string& why) {
  const json event = {{"command", wanted.to.empty() ? "plugin.rollback" : "plugin.swap"},
                      {"layer", layer_name(wanted.layer)},
                      {"to", wanted.to},
                      {"accepted", false},
                      {"reason", why}};
  parts_.telemetry->record_event(EventKind::kCommand, wanted.tick, wanted.time, text_of(event));
  answer(wanted, RpcError{rpc_code::kRefused, why, {{"tick", wanted.tick}}});
}

void SwapService::follow(const SwapReport& report) {
  delete report.retired;
  const auto entry = under_way_.find(report.request);
  if (entry == under_way_.end()) return;
  UnderWay& swap = entry->second;
  const char* step = kSwapStepNames[static_cast<int>(report.step)];
  json said = {{"step", step}, {"tick", report.tick}};
  if (report.difference > 0.0) said["difference"] = report.difference;
  if (report.why[0] != '\0') said["why"] = report.why;
  json event = said;
  event["request"] = report.request;
  event["wall_time"] = report.wall_time;
  // The first event of a swap says everything that it takes to do it again.
  if (swap.steps.empty()) event.update(swap.what);
  event["layer"] = layer_name(report.layer);
  event["rollback"] = report.rollback;
  swap.steps.push_back(std::move(said));
  const double time = static_cast<double>(report.tick) * parts_.telemetry->period();
  parts_.telemetry->record_event(EventKind::kSwap, report.tick, time, text_of(event));

  const bool back = report.step == SwapStep::kRolledBack;
  if (report.step == SwapStep::kSwitched || (back && !report.rolled_back_already)) {
    const std::scoped_lock lock(mutex_);
    Names& names = names_[report.layer];
    if (back && report.rollback) {
      std::swap(names.in_use, names.before);
    } else if (back) {
      names.in_use = std::exchange(names.before, names.before_that);
    } else {
      names.before_that = names.before;
      names.before = std::exchange(
          names.in_use, Library{swap.what.value("variant", ""), swap.what.value("file", "")});
    }
  }
  if (report.step == SwapStep::kShadow || report.step == SwapStep::kSwitched) return;
  UnderWay over = std::move(swap);
  under_way_.erase(entry);
  finish(over, report);
}

void SwapService::finish(UnderWay& swap, const SwapReport& report) {
  const bool well =
      report.step == SwapStep::kDone || (report.rollback && report.step == SwapStep::kRolledBack);
  const std::string why = report.step == SwapStep::kRolledBack
                              ? std::string("it was in use and had to go again: ") + report.why
                              : std::string(report.why);
  if (!well) {
    Wanted wanted = swap.wanted;
    wanted.tick = report.tick;
    wanted.time = static_cast<double>(report.tick) * parts_.telemetry->period();
    return refuse(wanted, why);
  }
  if (parts_.bridge == nullptr || swap.wanted.from_scenario) return;
  json result = swap.what;
  result.erase("parameters");
  result["accepted"] = true;
  result["tick"] = report.tick;
  result["variant"] = variant(report.layer);
  result["note"] = std::string(layer_name(report.layer)) + " is " + variant(report.layer) +
                   (report.rollback ? " again" : " now");
  result["steps"] = swap.steps;
  answer(swap.wanted, std::move(result));
}

}  // namespace gaitd::daemon

// SPDX-License-Identifier: Apache-2.0
#include "tests/storm/command_source.h"

#include <cmath>

namespace gaitd::storm {
namespace {

constexpr const char* kSides[] = {"left", "right"};
constexpr int kInvalidRequest = -32600;
constexpr int kInvalidParams = -32602;

}  // namespace

Request CommandSource::next(const Scene& scene) {
  const double draw = uniform(0, 1);
  if (draw < mixture_.commands) return request(Request::Kind::kCommand, good_call(scene));
  if (draw < mixture_.commands + mixture_.queries) {
    // plugin.list reads files: it is the slow one.
    if (chance(0.02)) return request(Request::Kind::kQuery, {"plugin.list", nullptr});
    if (chance(0.1)) return request(Request::Kind::kQuery, {"param.list", {{"match", "gait.*"}}});
    if (chance(0.1)) {
      return request(Request::Kind::kQuery, {"param.get", {{"name", "gait.swing_height"}}});
    }
    return request(Request::Kind::kQuery, {chance(0.5) ? "status" : "version", nullptr});
  }
  switch (integer(0, 9)) {
    case 0:
    case 1:
    case 2:
      return refused_by_the_gait(scene);
    case 3:
    case 4:
    case 5:
    case 6:
      return wrong_params(scene);
    case 7:
      return no_request(scene);
    default:
      return no_json(scene);
  }
}

Request CommandSource::request(Request::Kind kind, const Call& call) {
  Request r;
  r.kind = kind;
  r.method = call.method;
  r.id = next_id_++;
  json object = {{"jsonrpc", "2.0"}, {"id", r.id}, {"method", call.method}};
  if (!call.params.is_null()) object["params"] = call.params;
  r.line = object.dump();
  return r;
}

Request CommandSource::plain(const std::string& method) {
  return request(Request::Kind::kCommand, {method, nullptr});
}

Request CommandSource::without_effect() {
  return request(Request::Kind::kFlood,
                 {"param.set", {{"name", "swap.probation"}, {"value", 1.0}}});
}

std::string CommandSource::batch(const std::vector<Request>& requests) {
  std::string line = "[";
  for (const Request& r : requests) line += (line.size() > 1 ? "," : "") + r.line;
  return line + "]";
}

std::string CommandSource::damaged(std::string line) {
  for (int i = integer(1, 3); i > 0; --i) {
    line[integer(0, static_cast<int>(line.size()) - 1)] = static_cast<char>(integer(0, 255));
  }
  for (char& c : line) c = c == '\n' ? ' ' : c;
  return line;
}

CommandSource::json CommandSource::good_walk() {
  json walk = {{"steps", integer(1, 6)},
               {"length", uniform(-0.2, 0.35)},
               {"swing", uniform(0.55, 0.9)},
               {"transfer", uniform(0.22, 0.4)}};
  if (chance(0.3)) walk["lateral"] = uniform(-0.08, 0.08);
  if (chance(0.3)) walk["turn"] = uniform(-0.15, 0.15);
  if (chance(0.2)) walk["width"] = uniform(0.2, 0.35);
  if (chance(0.2)) walk["first"] = pick(kSides);
  return walk;
}

// Two drivers who take the robot from each other, renew in time or not, and let go.
CommandSource::json CommandSource::good_drive() {
  json drive = {{"session", integer(1, 2)}};
  if (chance(0.15)) {
    drive["end"] = true;
    return drive;
  }
  drive["forward"] = uniform(-0.4, 0.9);
  if (chance(0.3)) drive["lateral"] = uniform(-0.3, 0.3);
  if (chance(0.4)) drive["turn"] = uniform(-0.6, 0.6);
  if (chance(0.4)) drive["renew"] = true;
  return drive;
}

// A few footsteps beside where a foot is now: on the way of a walk they may well be refused.
CommandSource::json CommandSource::good_footsteps(const Scene& scene) {
  json list = json::array();
  int side = integer(0, 1);
  auto [x, y, yaw] = scene.feet[1 - side];
  for (int i = integer(1, 3); i > 0; --i, side = 1 - side) {
    const double forward = uniform(-0.1, 0.3);
    const double outward = uniform(0.2, 0.32) * (side == 0 ? 1.0 : -1.0);
    x += forward * std::cos(yaw) - outward * std::sin(yaw);
    y += forward * std::sin(yaw) + outward * std::cos(yaw);
    yaw += uniform(-0.12, 0.12);
    json step = {{"side", kSides[side]}, {"x", x}, {"y", y}, {"yaw", yaw}};
    if (chance(0.5)) step["swing"] = uniform(0.55, 0.9);
    if (chance(0.5)) step["transfer"] = uniform(0.22, 0.4);
    if (chance(0.3)) step["swing_height"] = uniform(0.06, 0.14);
    list.push_back(step);
  }
  json params = {{"footsteps", list}};
  if (chance(0.4)) params["replace"] = chance(0.8);
  return params;
}

CommandSource::json CommandSource::good_push() {
  json push = {{"link", chance(0.5) ? "utorso" : "pelvis"},
               {"force", {uniform(-60, 60), uniform(-40, 40), uniform(-40, 40)}},
               {"duration", uniform(0.02, 0.2)}};
  if (chance(0.3)) push["point"] = {0.0, uniform(-0.1, 0.1), uniform(0.0, 0.2)};
  return push;
}

CommandSource::Call CommandSource::good_call(const Scene& scene) {
  const double draw = uniform(0, 1);
  if (draw < 0.22) return {"walk", good_walk()};
  if (draw < 0.34) return {"drive", good_drive()};
  if (draw < 0.60) return {"footsteps", good_footsteps(scene)};
  if (draw < 0.68) return {"sim.push", good_push()};
  if (draw < 0.82) return {"resume", nullptr};
  if (draw < 0.86) return {"pause", nullptr};
  if (draw < 0.90) return {"stop", json::object()};
  if (draw < 0.93) return {"abort", nullptr};
  if (draw < 0.97) return {"mode", {{"mode", chance(0.9) ? "walk-bent" : "stand"}}};
  if (draw < 0.975) return {"arm", nullptr};
  if (draw < 0.985) {
    return {"param.set", {{"name", "gait.swing_height"}, {"value", uniform(0.08, 0.13)}}};
  }
  constexpr const char* kRare[] = {"estop", "reset", "disarm", "sim.reset"};
  return {pick(kRare), nullptr};
}

// Well-formed and in the range of every key, but nothing that legs can do: where it is about
// footsteps, one cannot follow the other wherever the robot is.
Request CommandSource::refused_by_the_gait(const Scene& scene) {
  json step = good_footsteps(scene)["footsteps"][0];
  json next = step;
  const int side = step["side"] == "left" ? 0 : 1;
  next["side"] = kSides[1 - side];
  Call call{"footsteps", nullptr};
  const int what = integer(0, 10);
  switch (what) {
    case 0:  // legs crossed, whichever way the robot faces
      next["x"] = step["x"].get<double>() + 0.01;
      break;
    case 1:
      next["x"] = step["x"].get<double>() + pick(std::array{-30.0, -5.0, 5.0, 3000.0});
      break;
    case 2:
      next["z"] = pick(std::array{-9.0, -1.0, 1.0, 500.0});
      break;
    case 3:
      next["yaw"] = step["yaw"].get<double>() + pick(std::array{1.2, -1.6, 3.1});
      break;
    case 4:
      next["roll"] = pick(std::array{-0.9, 0.8});
      break;
    case 5:
      next["side"] = kSides[side];
      break;
    case 6: {
      json list = json::array();
      for (int i = 0; i < 64; ++i) {
        list.push_back({{"side", kSides[i % 2]}, {"x", 3.0 * i}, {"y", 0.1 - 0.2 * (i % 2)}});
      }
      call.params = {{"footsteps", list}};
      break;
    }
    case 7:
      call = {"walk", {{"steps", 4}, {"length", pick(std::array{1.9, -1.8, 1.5})}}};
      break;
    case 8:
      call = {"walk", {{"steps", 3}, {"turn", pick(std::array{1.5, -1.5})}}};
      break;
    case 9:
      call = {"walk", {{"steps", 1000}, {"length", 1.2}}};
      break;
    default:
      call = {"walk", {{"steps", 2}, {"width", pick(std::array{0.01, 0.1, 1.9})}}};
      break;
  }
  if (call.params.is_null()) call.params = {{"footsteps", {step, next}}, {"replace", chance(0.5)}};
  Request r = request(Request::Kind::kInvalid, call);
  r.fills_a_tick = what == 6 || what == 9;
  r.code = -32000;
  return r;
}

// A landing region that is empty, flat, not convex, no number, the other way around, too high or
// out of reach.
Request CommandSource::wrong_region(Call call) {
  json& step = call.params["footsteps"].back();
  const double x = step["x"], y = step["y"];
  const auto corner = [&](double dx, double dy) { return json{x + dx, y + dy, 0.0}; };
  json region = {corner(-0.2, -0.1), corner(0.2, -0.1), corner(0.2, 0.1), corner(-0.2, 0.1)};
  switch (integer(0, 6)) {
    case 0:
      region = json::array();
      break;
    case 1:
      region = {corner(-0.2, -0.2), corner(0.0, 0.0), corner(0.2, 0.2)};
      break;
    case 2:
      region[1] = corner(-0.1, 0.0);
      break;
    case 3:
      region[2][1] = pick(std::vector<json>{"nan", nullptr, 1e300});
      break;
    case 4:
      std::reverse(region.begin(), region.end());
      break;
    case 5:
      for (json& point : region) point[2] = 2.0;
      break;
    default:
      for (json& point : region) point[0] = point[0].get<double>() + 3.0;
      break;
  }
  step["landing_region"] = region;
  Request r = request(Request::Kind::kInvalid, call);
  r.code = kInvalidParams;
  r.names = "landing_region";
  return r;
}

Request CommandSource::wrong_params(const Scene& scene) {
  constexpr const char* kMethods[] = {"walk",  "footsteps", "sim.push", "mode",
                                      "pause", "arm",       "param."};
  Call call{pick(kMethods), json::object()};
  if (call.method == "param.") return wrong_parameter();
  if (call.method == "walk") call.params = good_walk();
  if (call.method == "footsteps") call.params = good_footsteps(scene);
  if (call.method == "footsteps" && chance(0.2)) return wrong_region(call);
  if (call.method == "sim.push") call.params = good_push();
  if (call.method == "mode") call.params["mode"] = "walk-bent";
  // In a footstep as often as around it.
  const bool inside = call.method == "footsteps" && chance(0.7);
  json& map = inside ? call.params["footsteps"][0] : call.params;
  std::string key;
  if (!map.empty())
    key = std::next(map.begin(), integer(0, static_cast<int>(map.size()) - 1)).key();
  const int kind = map.empty() ? 0 : integer(0, 3);
  if (kind == 0) {
    key = pick(std::array{"lenght", "stepz", "swng", "force_", "x ", "", "\x7f", "MODE", "replce"});
    map[key] = uniform(-1, 1);
  } else if (kind == 1) {
    map[key] = pick(std::vector<json>{"0.3", json::array(), json::object(), nullptr, 1e300,
                                      std::string(2000, 'x')});
  } else if (kind == 2 && map[key].is_number()) {
    map[key] = pick(std::array{1e9, -1e9, 1e300, -1e300});
  } else {
    constexpr const char* kNeeded[] = {"steps", "footsteps", "link", "force", "duration",
                                       "side",  "x",         "y",    "mode"};
    key = "";
    for (const char* needed : kNeeded) {
      if (map.contains(needed)) key = needed;
    }
    map.erase(key);
  }
  Request r = request(Request::Kind::kInvalid, call);
  r.code = kInvalidParams;
  r.names = key;
  // In one of many it is a notification: not carried out, not answered.
  if (chance(0.05)) {
    json object = json::parse(r.line);
    object.erase("id");
    r.line = object.dump();
    r.id = 0;
    r.notification = true;
  }
  return r;
}

Request CommandSource::wrong_parameter() {
  Call call{pick(std::array{"param.set", "param.get", "param.list"}), json::object()};
  const char* name = pick(std::array{"gait.swing_hight", "gait.", "swing", "wbc.gain", "period"});
  std::string names;
  if (call.method == "param.set" && chance(0.5)) {
    names = "gait.swing_height";
    call.params = {{"name", names}, {"value", pick(std::vector<json>{-1, 1e9, true})}};
  } else if (call.method == "param.list") {
    call.params = {{"match", pick(std::vector<json>{"nothing.*", 7, json::array()})}};
  } else {
    names = name;
    call.params["name"] = name;
    if (call.method == "param.set") call.params["value"] = 0.1;
  }
  Request r = request(Request::Kind::kInvalid, call);
  r.code = kInvalidParams;
  r.names = names;
  return r;
}

// JSON, but no request.
Request CommandSource::no_request(const Scene& scene) {
  Request r = request(Request::Kind::kInvalid, good_call(scene));
  json object = json::parse(r.line);
  if (object["method"] == "estop") object["method"] = "stop";  // is never refused for its form
  r.code = kInvalidRequest;
  switch (integer(0, 10)) {
    case 0:
      object["method"] = pick(std::array{"fly", "walk ", "", "STATUS", "param", "sim"});
      r.code = -32601;
      r.names = "there is: ";
      break;
    case 1:
      object["jsonrpc"] = "1.0";
      r.names = "jsonrpc";
      break;
    case 2:
      object["params"] = 3;
      r.names = "params";
      break;
    case 3:
      object["parms"] = 1;
      r.names = "parms";
      break;
    case 4:
      object["method"] = 7;
      r.names = "method";
      break;
    case 5:
      object = {{"jsonrpc", "2.0"}, {"id", r.id}, {"method", "status"}, {"params", {{"a", 1}}}};
      r.code = kInvalidParams;
      r.names = "takes no params";
      break;
    case 6:
      object["id"] = json::array({r.id});
      r.id = 0;
      r.names = "id";
      break;
    case 7:
      object = pick(std::vector<json>{7, nullptr, "walk", json::array(), true, 1.5});
      r.id = 0;
      break;
    case 8:
      object = json::array();
      for (int i = 0; i < 300; ++i) object.push_back(1);
      r.id = 0;
      r.names = "batch";
      break;
    case 9:
      for (int i = integer(40, 200); i > 0; --i) object = json::array({object});
      r.id = 0;
      r.names = "nested";
      break;
    default:
      r.id = 0;
      r.names = "stands twice";
      break;
  }
  r.method = "no request";
  r.line = object.dump();
  if (r.names == "stands twice") r.line.insert(1, "\"method\":\"estop\",");
  return r;
}

Request CommandSource::no_json(const Scene& scene) {
  Request r = request(Request::Kind::kInvalid, good_call(scene));
  r.method = "no JSON";
  r.id = 0;
  r.code = -32700;
  std::string& line = r.line;
  const std::size_t somewhere = integer(1, static_cast<int>(line.size()) - 1);
  const std::size_t value = line.find("\"2.0\"");
  switch (integer(0, 8)) {
    case 0:
      line.resize(somewhere);
      break;
    case 1:
      line.replace(value, 5, "NaN");
      break;
    case 2:
      line.replace(value, 5, pick(std::array{"1e999", "-1e999", "0x1", "Infinity", "'2.0'"}));
      break;
    case 3:
      line.replace(value, 5, "\"\xc3\x28\"");  // no UTF-8
      break;
    case 4:
      line.insert(value + 1, pick(std::array{"\t", "\x01", "\\x", "\\ud800"}));
      break;
    case 5:
      line += pick(std::array{"}", "{}", ",", " 1", "\\"});
      break;
    case 6:
      line.insert(1, ",");
      break;
    case 7:  // nothing but noise
      for (char& c : line) c = static_cast<char>(integer(11, 255));
      line.insert(0, "]");
      break;
    default:
      line.insert(value, "\"id\":1,\"x\":[\"1\",}");
      break;
  }
  return r;
}

}  // namespace gaitd::storm

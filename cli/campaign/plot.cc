// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <utility>

#include "cli/campaign/labels.h"

namespace gaitd::cli {
namespace {

constexpr double kRadius = 130.0;  // px, of a diagram
constexpr double kPanel = 320.0;   // px, its square
constexpr double kHead = 30.0;     // px, above the diagrams, and of the legend below them
constexpr const char* kColours[] = {"#0a62a8", "#d1491b", "#2f8a3c", "#7a4ea3", "#8a6d00"};

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[512];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return out;
}

std::string label(double x, double y, const char* anchor, const std::string& text,
                  const char* colour = "#333") {
  return format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" fill=\"%s\">", x, y, anchor,
                colour) +
         escaped(text) + "</text>\n";
}

std::size_t index_of(const Campaign& campaign, const std::string& key) {
  std::size_t i = 0;
  while (i < campaign.settings.size() && campaign.settings[i].key != key) ++i;
  return i;
}

// 1, 2 or 5 times a power of ten: at most four rings up to the value.
double ring_step(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {0.2, 0.5, 1.0, 2.0}) {
    if (factor * power * 4.0 >= value * (1.0 - 1e-9)) return factor * power;
  }
  return 5.0 * power;
}

struct Radius {
  double length = 0.0;
  double low = 0.0, high = 0.0;  // the interval
  bool beyond = false;
};

struct Curve {
  std::map<double, Radius> points;  // by angle, rad
};

std::string grid(double x, double y, double largest, double step) {
  std::string out;
  const auto rings = static_cast<int>(largest / step + 1e-9);
  for (int i = 1; i <= rings; ++i) {
    const double ring = i * step;
    const double r = kRadius * ring / largest;
    out += format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"none\" stroke=\"#ccc\"/>\n", x,
                  y, r);
    out += label(x + 3.0, y - r + 11.0, "start", format("%g", ring), "#888");
  }
  for (int i = 0; i < 8; ++i) {
    const double angle = i * M_PI / 4.0;
    out += format("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#e4e4e4\"/>\n", x,
                  y, x - kRadius * std::sin(angle), y - kRadius * std::cos(angle));
  }
  return out;
}

std::string drawing(const Curve& curve, double x, double y, double largest, const char* colour) {
  std::string points, dots;
  for (const auto& [angle, value] : curve.points) {
    const double r = kRadius * value.length / largest;
    const double px = x - r * std::sin(angle), py = y - r * std::cos(angle);
    points += format("%.1f,%.1f ", px, py);
    if (value.high > value.low) {
      const double in = kRadius * value.low / largest, out = kRadius * value.high / largest;
      dots += format(
          "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" "
          "stroke-opacity=\"0.6\"/>\n",
          x - in * std::sin(angle), y - in * std::cos(angle), x - out * std::sin(angle),
          y - out * std::cos(angle), colour);
    }
    dots += format(
        "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%s\" fill=\"%s\" stroke=\"%s\" "
        "stroke-width=\"1.6\"/>\n",
        px, py, value.beyond ? "4" : "2", value.beyond ? "#fff" : colour, colour);
  }
  return "<polygon points=\"" + points +
         format("\" fill=\"%s\" fill-opacity=\"0.12\" stroke=\"%s\" stroke-width=\"1.6\"/>\n",
                colour, colour) +
         dots;
}

}  // namespace

void read_plot(daemon::MapReader map, Campaign* campaign) {
  if (!map.valid()) return;
  map.require({"angle"});
  CampaignPlot plot;
  // The values of a setting, or none and an error where there is no such setting.
  const auto values_of = [&](const char* name, std::string* key) {
    *key = map.text(name).value_or("");
    if (key->empty()) return std::vector<std::string>();
    const std::size_t i = index_of(*campaign, *key);
    if (i < campaign->settings.size() - (campaign->search ? 1 : 0)) {
      return campaign->settings[i].values;
    }
    map.fail(name, "a key of 'set'", "'" + *key + "'", "write one that has a list of values there");
    return std::vector<std::string>();
  };
  for (const std::string& value : values_of("angle", &plot.angle)) {
    if (daemon::as_number(*daemon::make_scalar(value, map.where()))) continue;
    map.fail("angle", "a key of 'set' whose values are angles in rad", value, "");
  }
  plot.panel_names = values_of("panels", &plot.panels);
  values_of("curves", &plot.curves);
  if (map.has("panel_names")) {
    const std::size_t count = plot.panel_names.size();
    plot.panel_names.clear();
    for (const daemon::NodePtr& name : map.list("panel_names", count, count)) {
      plot.panel_names.push_back(name->text);
    }
  }
  plot.scale = map.number("scale", {1e-9, 1e9, ""}).value_or(1.0);
  plot.label = map.text("label").value_or(campaign->search ? "" : "success rate");
  map.finish();
  campaign->plot = std::move(plot);
}

std::vector<PlotPoint> plot_points(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                                   const CampaignResults& results, RunOrder* order) {
  std::vector<PlotPoint> points;
  if (campaign.search) {
    for (const SearchResult& found : order->found()) {
      const std::optional<double>& bound = found.low ? found.low : found.high;
      if (!found.finished || !bound) continue;
      const auto [from, to, rate, width] = *campaign.search;
      points.push_back({found.scenario, found.values, found.limit.value_or(*bound),
                        found.low.value_or(std::min(from, to)),
                        found.high.value_or(std::max(from, to)), !found.limit});
    }
    return points;
  }
  std::map<int, std::pair<int, int>> counts;  // successes and runs by cell
  for (const auto& [number, result] : results) {
    auto& [successes, count] = counts[runs[static_cast<std::size_t>(number) - 1].cell];
    successes += result.success ? 1 : 0;
    ++count;
  }
  for (const auto& [cell, count] : counts) {
    const CampaignRun& run = runs[static_cast<std::size_t>(cell)];  // of the first seed
    points.push_back(
        {run.scenario, run.values, static_cast<double>(count.first) / count.second, {}, {}, false});
  }
  return points;
}

std::string polar_plot(const Campaign& campaign, const std::vector<PlotPoint>& points,
                       const std::string& scenario) {
  const CampaignPlot& plot = *campaign.plot;
  const std::size_t angle = index_of(campaign, plot.angle);
  const auto values = [&](const std::string& key) {
    return key.empty() ? std::vector<std::string>{""}
                       : campaign.settings[index_of(campaign, key)].values;
  };
  const std::vector<std::string> panels = values(plot.panels), curves = values(plot.curves);
  std::vector<std::vector<Curve>> data(panels.size(), std::vector<Curve>(curves.size()));
  double largest = 0.0;
  bool beyond = false;
  for (const PlotPoint& result : points) {
    if (result.scenario != scenario) continue;
    const auto place = [&](const std::string& key, const std::vector<std::string>& of) {
      if (key.empty()) return std::size_t{0};
      const std::string& value = result.values[index_of(campaign, key)];
      return static_cast<std::size_t>(std::find(of.begin(), of.end(), value) - of.begin());
    };
    const Radius radius{plot.scale * result.value, plot.scale * result.low.value_or(result.value),
                        plot.scale * result.high.value_or(result.value), result.beyond};
    Curve& curve = data[place(plot.panels, panels)][place(plot.curves, curves)];
    const auto [point, fresh] =
        curve.points.emplace(std::atof(result.values[angle].c_str()), radius);
    // The worst: a search may go from large to small.
    const bool down = campaign.search && campaign.search->to < campaign.search->from;
    const bool worse =
        down ? radius.length > point->second.length : radius.length < point->second.length;
    if (!fresh && worse) point->second = radius;
    largest = std::max(largest, radius.high);
    beyond = beyond || radius.beyond;
  }
  const double step = ring_step(std::max(largest, 1e-9));
  largest = step * std::ceil(std::max(largest, 1e-9) / step - 1e-9);

  const double width = std::max(kPanel * static_cast<double>(panels.size()), 1.5 * kPanel);
  const double height = kPanel + 2.0 * kHead;
  std::string out = format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" "
      "height=\"%.0f\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
      width, height, width, height);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const double x = kPanel * (static_cast<double>(i) + 0.5), y = kHead + 0.5 * kPanel;
    if (!plot.panel_names.empty()) out += label(x, kHead - 8.0, "middle", plot.panel_names[i]);
    out += grid(x, y, largest, step);
    for (std::size_t k = 0; k < curves.size(); ++k) {
      out += drawing(data[i][k], x, y, largest, kColours[k % std::size(kColours)]);
    }
  }
  double x = 20.0;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const std::string name = curves[k].empty() ? "" : value_label(campaign, plot.curves, curves[k]);
    out += label(x, height - 12.0, "start", name, kColours[k % std::size(kColours)]);
    x += 8.0 * static_cast<double>(name.size()) + 24.0;
  }
  out += label(width - 20.0, height - 12.0, "end",
               plot.label + (beyond ? "; ○ beyond what was tried" : ""));
  return out + "</svg>\n";
}

}  // namespace gaitd::cli

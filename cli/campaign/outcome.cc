// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/outcome.h"

#include <algorithm>
#include <iostream>

#include "cli/campaign/plot.h"
#include "cli/campaign/search.h"
#include "cli/campaign/summary.h"
#include "cli/print.h"
#include "cli/terminal.h"
#include "cli/whole_file.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

// Of a name or a file; a name may have dots.
std::string plot_name(const std::string& scenario) {
  std::string name = fs::path(scenario).filename().string();
  if (name.ends_with(".yaml")) name.resize(name.rfind('.'));
  return name + ".svg";
}

// False, and said, when one of them cannot be written.
bool write_plots(const Campaign& campaign, const std::vector<PlotPoint>& points,
                 const fs::path& folder, std::string* error) {
  return std::ranges::all_of(campaign.scenarios, [&](const std::string& scenario) {
    return write_file(folder / plot_name(scenario), polar_plot(campaign, points, scenario), error);
  });
}

}  // namespace

bool conclude(const Context& context, const CampaignPlan& plan, const CampaignResults& results,
              const RunnerOptions& options) {
  const fs::path& folder = options.folder;
  RunOrder order(plan.campaign, plan.runs, results);
  std::string error;
  bool written = true;
  if (plan.campaign.plot) {
    written = write_plots(plan.campaign, plot_points(plan.campaign, plan.runs, results, &order),
                          folder, &error);
  }
  const nlohmann::json kept =
      summary_json(plan.campaign, plan.runs, results, &order, options, fs::path());
  written = written && write_file(folder / "summary.txt", summary_text(kept, 0), &error) &&
            write_file(folder / "summary.json", json_text(kept), &error);
  const nlohmann::json shown =
      summary_json(plan.campaign, plan.runs, results, &order, options, folder);
  if (options.part.empty()) {
    std::cout << (context.json ? json_text(shown) : summary_text(shown, output_columns()));
  }
  if (!written) std::cerr << "gaitctl: campaign: " << error << '\n';
  return written && shown["pass"].get<bool>();
}

}  // namespace gaitd::cli

// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/outcome.h"

#include <fstream>
#include <iostream>

#include "cli/campaign/plot.h"
#include "cli/campaign/search.h"
#include "cli/campaign/summary.h"
#include "cli/print.h"
#include "cli/terminal.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

void write_plots(const Campaign& campaign, const std::vector<PlotPoint>& points,
                 const fs::path& folder) {
  for (const std::string& scenario : campaign.scenarios) {
    std::ofstream(folder / (fs::path(scenario).stem().string() + ".svg"))
        << polar_plot(campaign, points, scenario);
  }
}

}  // namespace

bool conclude(const Context& context, const CampaignPlan& plan, const CampaignResults& results,
              const RunnerOptions& options) {
  const fs::path& folder = options.folder;
  RunOrder order(plan.campaign, plan.runs, results);
  if (plan.campaign.plot) {
    write_plots(plan.campaign, plot_points(plan.campaign, plan.runs, results, &order), folder);
  }
  const nlohmann::json kept =
      summary_json(plan.campaign, plan.runs, results, &order, options, fs::path());
  std::ofstream(folder / "summary.txt") << summary_text(kept, 0);
  std::ofstream(folder / "summary.json") << json_text(kept);
  const nlohmann::json shown =
      summary_json(plan.campaign, plan.runs, results, &order, options, folder);
  if (options.part.empty()) {
    std::cout << (context.json ? json_text(shown) : summary_text(shown, output_columns()));
  }
  return shown["pass"].get<bool>();
}

}  // namespace gaitd::cli

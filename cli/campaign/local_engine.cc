// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/local_engine.h"

#include <algorithm>
#include <iostream>

#include "cli/campaign/calibration.h"
#include "cli/campaign/outcome.h"
#include "cli/campaign/progress.h"
#include "cli/campaign/results.h"
#include "cli/campaign/search.h"
#include "cli/failure.h"
#include "cli/print.h"

namespace gaitd::cli {
namespace {

PoolEnd calibrate(const CampaignPlan& plan, const std::vector<CampaignRun>& runs,
                  const RunnerOptions& options, const CampaignResults& results,
                  CalibrationFailures* failures, std::string* error) {
  ProgressBar bar(options.part + "calibrations ");
  const auto progress = [&](const ProgressCounts& counts) { bar.show(counts); };
  const PoolEnd end =
      make_calibrations(plan.campaign, runs, options, results, progress, failures, error);
  bar.end();
  for (const auto& [file, why] : *failures) std::cerr << "gaitctl: campaign: " << why << "\n";
  return end;
}

PoolEnd play(const CampaignPlan& plan, const RunnerOptions& options,
             const CalibrationFailures& failures, RunOrder* order, ResultFile* results,
             std::string* error) {
  ProgressBar bar(options.part);
  const auto progress = [&](int finished) {
    const std::size_t done = results->results().size();
    bar.show({done, done + order->remaining(), results->failed(), finished});
  };
  const PoolEnd end =
      play_runs(plan.campaign, plan.runs, options, failures, order, results, progress, error);
  bar.end();
  return end;
}

// Of a shard nothing can be said of the campaign.
void tell_shard(const Context& context, const CampaignPlan& plan, const CampaignResults& results,
                std::size_t remaining, const std::string& file) {
  const std::string shard = shard_text(plan.origin.shard);
  if (context.json) {
    std::cout << json_text({{"campaign", plan.campaign.name},
                            {"shard", shard},
                            {"runs", results.size() + remaining},
                            {"finished", results.size()},
                            {"failed", count_failed(results)},
                            {"results", file}});
    return;
  }
  std::cout << plan.campaign.name << ", shard " << shard << ": " << results.size() << " of "
            << results.size() + remaining << " runs, " << count_failed(results)
            << " failed\nresults: " << file
            << "\nall shards together: gaitctl campaign merge FOLDER... -o FOLDER\n";
}

}  // namespace

int play_locally(const Context& context, const CampaignPlan& plan, const RunnerOptions& options) {
  std::string error;
  ResultFile results(plan.campaign, plan.runs);
  RunOrder order(plan.campaign, plan.runs, results.results(), plan.origin.shard);
  const std::vector<CampaignRun> runs = order.runs();
  const std::filesystem::path file = options.folder / "results.csv";
  if (!write_drawn(plan.campaign, runs, options.folder, &error) || !results.open(file, &error)) {
    return fail(context, kFailed, "campaign", error);
  }
  const std::size_t before = results.results().size();
  if (before > 0 && (options.part.empty() || order.remaining() > 0)) {
    std::cerr << "goes on: " << before << " of " << before + order.remaining()
              << (plan.campaign.search ? " runs at most are done\n" : " runs are done\n");
  }
  CalibrationFailures failures;
  PoolEnd end = calibrate(plan, runs, options, results.results(), &failures, &error);
  if (end == PoolEnd::kDone) end = play(plan, options, failures, &order, &results, &error);
  if (end == PoolEnd::kFailed || !results.sort(&error)) {
    return fail(context, kFailed, "campaign", error);
  }
  bool passed = order.remaining() == 0;
  if (plan.origin.shard.whole()) {
    passed = conclude(context, plan, results.results(), options);
  } else {
    tell_shard(context, plan, results.results(), order.remaining(), file.string());
  }
  if (end == PoolEnd::kInterrupted) {
    std::cerr << "interrupted; the same command goes on\n";
    return kInterrupted;
  }
  const auto damaged = std::count_if(results.results().begin(), results.results().end(),
                                     [](const auto& entry) { return entry.second.damaged; });
  if (damaged > 0) {
    std::cerr << "gaitctl: campaign: the logs of " << damaged
              << " runs are damaged; the same command plays them again\n";
    return kDamaged;
  }
  return passed ? kDone : kFailed;
}

}  // namespace gaitd::cli

// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// obstacle-evaluate: how good the detector is on labelled recordings. Parses, wires, reports.
#include <cstdio>
#include <filesystem>
#include <opencv2/core/utility.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "batch.h"
#include "common/address_space.h"
#include "common/interrupt.h"
#include "common/read_params.h"
#include "common/run_app.h"
#include "common/text_file.h"
#include "csv_outputs.h"
#include "gnuplot.h"
#include "lidar_obstacles/evaluation/worst_scans.h"
#include "metrics_json.h"
#include "monza.h"
#include "options.h"
#include "pictures.h"
#include "plots.h"
#include "replay_pages.h"
#include "report.h"
#include "results_folder.h"
#include "table.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::apps;
namespace fs = std::filesystem;

DetectorParams paramsOf(const EvaluateOptions& options, const Variant& variant) {
    std::vector<std::string> set = options.set;
    set.insert(set.end(), variant.set.begin(), variant.set.end());
    return readParams(options.config, set);
}

void makeFolder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error || !fs::is_directory(folder)) {
        throw std::runtime_error(folder.string() + ": cannot make the output folder" +
                                 (error ? ": " + error.message() : ": there is a file of that name"));
    }
}

Job jobOf(const EvaluateOptions& options, const Variant& variant, const SetFiles& files) {
    Job job{files, paramsOf(options, variant), files.detections};
    if (!files.detections.empty()) return job;
    job.detections = (fs::path(options.output) / variant.name / files.name / "obstacles.csv").string();
    return job;
}

/// The jobs of all variants, one variant after another, sets in their order.
std::vector<Job> jobsOf(const EvaluateOptions& options) {
    std::vector<Job> jobs;
    for (const Variant& variant : options.variants) {
        for (const SetFiles& files : options.sets) jobs.push_back(jobOf(options, variant, files));
    }
    return jobs;
}

std::vector<Plot> drawPlots(const std::vector<evaluation::SetResult>& results, const evaluation::Metrics& metrics,
                            const fs::path& folder) {
    makeFolder(folder);
    std::vector<Plot> plots = plotMetrics(results, metrics, folder);
    for (const evaluation::SetResult& set : results) {
        if (set.target_id.empty()) continue;
        const std::string title = set.name + ", object " + set.target_id + " over time";
        if (auto figure = plotTarget(set, title, folder / ("target_" + set.name))) plots.push_back(std::move(*figure));
    }
    return plots;
}

/// Plots, pictures and replays of the worst scans, report.html. The HTML of the worst scans is wanted once more.
std::string writeReport(const EvaluateOptions& options, const Variant& variant,
                        const std::vector<evaluation::SetResult>& results, const evaluation::Metrics& metrics) {
    const fs::path folder = fs::path(options.output) / variant.name;
    ReportContent content;
    content.title = "Evaluation" + (variant.name.empty() ? "" : ": " + variant.name);
    content.metrics = &metrics;
    content.results = &results;
    if (options.plots) content.plots = drawPlots(results, metrics, folder / "plots");
    content.worst = evaluation::worstScans(results, static_cast<std::size_t>(options.worst));
    content.pictures = drawScans(content.worst, results, options, paramsOf(options, variant));
    content.replays = writeReplayPages(content.worst, results, options, {paramsOf(options, variant), folder});
    writeTextFile(folder / "report.html", reportHtml(content, options, variant));
    return worstScansHtml(content, variant.name + "/");
}

/// Where a run was interrupted.
struct Interruption {
    std::string set;
    std::size_t scan = 0;  ///< the first that was left out
};

/// The results of one variant.
struct VariantResults {
    std::vector<evaluation::SetResult> sets;
    std::optional<Interruption> interrupted;  ///< the first, in the order of the sets
};

/// Everything of one variant but the figures of the paper's experiment.
MonzaResult writeVariant(const EvaluateOptions& options, const Variant& variant, const VariantResults& results) {
    const evaluation::Metrics metrics = evaluation::summarise(results.sets, options.bootstrap);
    const fs::path folder = fs::path(options.output) / variant.name;
    makeFolder(folder);
    nlohmann::ordered_json json = toJson(metrics);
    json["options"] = optionsJson(options, variant);
    json["interrupted"] = nullptr;
    if (const auto& at = results.interrupted) json["interrupted"] = {{"set", at->set}, {"scan", at->scan}};
    writeTextFile(folder / "metrics.json", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    writeTextFile(folder / "objects.csv", objectsCsv(results.sets));
    writeTextFile(folder / "matches.csv", matchesCsv(results.sets));
    MonzaResult written{variant.name, metrics.target.value_or(evaluation::GroupMetrics{}), {}, ""};
    if (options.report) written.worst_scans = writeReport(options, variant, results.sets, metrics);
    if (!variant.name.empty()) std::printf("== %s\n", variant.name.c_str());
    std::fputs(tableText(metrics).c_str(), stdout);
    return written;
}

/// The jobs' results of variant number v.
VariantResults resultsOf(const std::vector<JobResult>& all, const EvaluateOptions& options, std::size_t v) {
    VariantResults results;
    for (std::size_t k = 0; k < options.sets.size(); ++k) {
        const JobResult& job = all[v * options.sets.size() + k];
        if (job.result) results.sets.push_back(*job.result);
        if (job.interrupted_at && !results.interrupted)
            results.interrupted = Interruption{options.sets[k].name, *job.interrupted_at};
    }
    return results;
}

/// Writes what belongs to all variants, and the variants that something is known about.
void writeResults(const EvaluateOptions& options, const std::vector<JobResult>& all) {
    std::vector<MonzaResult> monza;
    for (std::size_t v = 0; v < options.variants.size(); ++v) {
        const Variant& variant = options.variants[v];
        const VariantResults results = resultsOf(all, options, v);
        if (results.sets.empty()) continue;
        monza.push_back(writeVariant(options, variant, results));
        if (options.monza && options.report && options.plots)
            monza.back().figures = plotFigures(variant.name, results.sets, options.output);
    }
    if (monza.empty()) return;
    if (options.monza) {
        writeMonza(monza, options);
        std::fputs(monzaTable(monza).c_str(), stdout);
    }
    std::printf("\nResults in %s\n", options.output.c_str());
}

/// The first interruption in the order of the jobs.
std::optional<std::size_t> interruptedAt(const std::vector<JobResult>& all) {
    for (const JobResult& job : all)
        if (job.interrupted_at) return job.interrupted_at;
    return std::nullopt;
}

int run(EvaluateOptions options) {
    constexpr std::uint64_t kGiB = std::uint64_t{1} << 30U;
    capAddressSpace(4 * kGiB + static_cast<std::uint64_t>(options.jobs) * (kGiB / 2));
    options.plots = options.report && hasGnuplot();
    makeFolder(options.output);
    const std::vector<Job> jobs = jobsOf(options);
    catchInterrupts();
    beginResults(options, jobs);
    for (const Job& job : jobs)
        if (job.files.detections.empty()) makeFolder(fs::path(job.detections).parent_path());
    const std::vector<JobResult> all = runJobs(jobs, options);
    const auto interrupted_at = interruptedAt(all);
    options.report = options.report && !interrupted_at;  // of a part there are the numbers
    writeResults(options, all);
    if (options.report && !options.plots) std::fprintf(stderr, "obstacle-evaluate: %s\n", kNoPlots);
    if (interrupted_at || !isInterrupted()) return exitCode("obstacle-evaluate", interrupted_at);
    std::fputs("obstacle-evaluate: interrupted after the last scan: pictures may be missing in the report\n", stderr);
    return kInterruptedCode;
}

}  // namespace

int main(int argc, char** argv) {
    return runApp("obstacle-evaluate", [&] {
        cv::setNumThreads(1);  // --jobs says how many cores are used
        const auto options = parseEvaluateOptions(argc, argv);
        return options ? run(*options) : 0;
    });
}

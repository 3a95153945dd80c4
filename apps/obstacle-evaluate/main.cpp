/// @file
/// obstacle-evaluate: how good the detector is on labelled recordings. Parses, wires, reports.
#include <cstdio>
#include <filesystem>
#include <opencv2/core/utility.hpp>
#include <stdexcept>
#include <string>

#include "batch.h"
#include "common/address_space.h"
#include "common/run_app.h"
#include "common/text_file.h"
#include "csv_outputs.h"
#include "gnuplot.h"
#include "lidar_obstacles/evaluation/worst_scans.h"
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "metrics_json.h"
#include "monza.h"
#include "options.h"
#include "pictures.h"
#include "plots.h"
#include "report.h"
#include "table.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::apps;
namespace fs = std::filesystem;

DetectorParams readParams(const EvaluateOptions& options, const Variant& variant) {
    DetectorParams params = options.config.empty() ? DetectorParams{} : loadParams(options.config);
    for (const std::string& assignment : options.set) setParam(params, assignment);
    for (const std::string& assignment : variant.set) setParam(params, assignment);
    validate(params);
    return params;
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
    Job job{files, readParams(options, variant), files.detections};
    if (!files.detections.empty()) return job;
    const fs::path folder = fs::path(options.output) / variant.name / files.name;
    makeFolder(folder);
    job.detections = (folder / "obstacles.csv").string();
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

/// Plots, pictures of the worst scans, report.html. The HTML of the worst scans is wanted once more.
std::string writeReport(const EvaluateOptions& options, const Variant& variant,
                        const std::vector<evaluation::SetResult>& results, const evaluation::Metrics& metrics) {
    const fs::path folder = fs::path(options.output) / variant.name;
    makeFolder(folder / "plots");
    ReportContent content;
    content.title = "Evaluation" + (variant.name.empty() ? "" : ": " + variant.name);
    content.metrics = &metrics;
    content.results = &results;
    content.plots = plotMetrics(results, metrics, folder / "plots");
    for (const evaluation::SetResult& set : results) {
        if (!set.target_id.empty())
            content.plots.push_back(plotTarget(set, set.name + ", object " + set.target_id + " over time",
                                               folder / "plots" / ("target_" + set.name)));
    }
    content.worst = evaluation::worstScans(results, static_cast<std::size_t>(options.worst));
    content.pictures = drawScans(content.worst, results, options, readParams(options, variant));
    writeTextFile(folder / "report.html", reportHtml(content, options, variant));
    return worstScansHtml(content);
}

/// Everything of one variant but the figures of the paper's experiment.
MonzaResult writeVariant(const EvaluateOptions& options, const Variant& variant,
                         const std::vector<evaluation::SetResult>& results) {
    const evaluation::Metrics metrics = evaluation::summarise(results, options.bootstrap);
    const fs::path folder = fs::path(options.output) / variant.name;
    makeFolder(folder);
    nlohmann::ordered_json json = toJson(metrics);
    json["options"] = optionsJson(options, variant);
    writeTextFile(folder / "metrics.json", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    writeTextFile(folder / "objects.csv", objectsCsv(results));
    writeTextFile(folder / "matches.csv", matchesCsv(results));
    MonzaResult written{variant.name, metrics.target.value_or(evaluation::GroupMetrics{}), {}, ""};
    if (options.report) written.worst_scans = writeReport(options, variant, results, metrics);
    if (!variant.name.empty()) std::printf("== %s\n", variant.name.c_str());
    std::fputs(tableText(metrics).c_str(), stdout);
    return written;
}

int run(const EvaluateOptions& options) {
    constexpr std::uint64_t kGiB = std::uint64_t{1} << 30U;
    capAddressSpace(4 * kGiB + static_cast<std::uint64_t>(options.jobs) * (kGiB / 2));
    if (options.report) requireGnuplot();  // to be known before the long part
    makeFolder(options.output);
    const std::vector<evaluation::SetResult> all = runJobs(jobsOf(options), options);
    std::vector<MonzaResult> monza;
    for (std::size_t v = 0; v < options.variants.size(); ++v) {
        const Variant& variant = options.variants[v];
        const auto begin = all.begin() + static_cast<std::ptrdiff_t>(v * options.sets.size());
        const std::vector<evaluation::SetResult> results(begin,
                                                         begin + static_cast<std::ptrdiff_t>(options.sets.size()));
        monza.push_back(writeVariant(options, variant, results));
        if (options.monza && options.report) monza.back().figures = plotFigures(variant.name, results, options.output);
    }
    if (options.monza) {
        writeMonza(monza, options);
        std::fputs(monzaTable(monza).c_str(), stdout);
    }
    std::printf("\nResults in %s\n", options.output.c_str());
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return runApp("obstacle-evaluate", [&] {
        cv::setNumThreads(1);  // --jobs says how many cores are used
        const auto options = parseEvaluateOptions(argc, argv);
        return options ? run(*options) : 0;
    });
}

// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// kitti2rawlog: public labelled recordings as rawlog, truth and ego poses. Parses, wires, reports.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "common/interrupt.h"
#include "common/progress_bar.h"
#include "common/run_app.h"
#include "sequence.h"
#include "writer.h"

namespace {

using namespace lidar_obstacles::apps;
namespace fs = std::filesystem;

constexpr const char* kDescription =
    "Converts a labelled recording of KITTI or nuScenes.\n"
    "\n"
    "Layouts of FOLDER:\n"
    "  object     velodyne/NNNNNN.bin, calib/NNNNNN.txt, label_2/NNNNNN.txt\n"
    "  tracking   velodyne/SSSS/NNNNNN.bin, calib/SSSS.txt, label_02/SSSS.txt, oxts/SSSS.txt   (--sequence SSSS)\n"
    "  odometry   sequences/SS/velodyne/NNNNNN.bin, times.txt and calib.txt, poses/SS.txt   (--sequence SS),\n"
    "             or the folder of one sequence\n"
    "  raw        velodyne_points/, oxts/, tracklet_labels.xml; calib_imu_to_velo.txt one folder up\n"
    "  nuscenes   samples/, sweeps/, v1.0-*/   (--sequence scene-NNNN)\n"
    "\n"
    "Written: PREFIX.rawlog, PREFIX_gt.csv and, where the recording has poses, PREFIX_ego.csv; with\n"
    "--images copies of the camera's images in PREFIX_Images/.\n";

constexpr const char* kFooter =
    "Examples:\n"
    "  kitti2rawlog 2011_09_26/2011_09_26_drive_0001_sync --planes 16 --output sets/kitti_0001_16\n"
    "  kitti2rawlog kitti/tracking/training --sequence 0004 --output sets/tracking_0004\n"
    "  kitti2rawlog nuscenes --sequence scene-0061 --planes 16 --output sets/scene_0061\n"
    "KITTI labels what its camera sees: evaluate with obstacle-evaluate --fov 80.\n"
    "Licences: see datasets/README.md; they do not allow everything that ours does.\n"
    "\n"
    "Exit code: 0 all went well; 1 a file is missing or not right, or nothing can be written; 2 the command line is\n"
    "not right; 130 interrupted (Ctrl-C). The files hold the whole scans before that.\n";

struct Options {
    SequenceOptions sequence;
    WriterOptions writer;
    std::string layout = "auto";
    std::size_t from = 0;
    std::size_t to = std::numeric_limits<std::size_t>::max();
};

/// The layout that the folder's contents speak for. @throws std::runtime_error if none.
std::string layoutOf(const fs::path& folder) {
    if (!fs::is_directory(folder)) throw std::runtime_error(folder.string() + ": no such folder");
    if (fs::exists(folder / "velodyne_points")) return "raw";
    if (fs::exists(folder / "sequences")) return "odometry";
    if (fs::exists(folder / "velodyne") && fs::exists(folder / "times.txt")) return "odometry";
    if (fs::exists(folder / "label_02") || fs::exists(folder / "velodyne" / "0000")) return "tracking";
    if (fs::exists(folder / "velodyne")) return "object";
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().filename().string().rfind("v1.0-", 0) == 0) return "nuscenes";
    }
    throw std::runtime_error(folder.string() + ": neither velodyne/, velodyne_points/, sequences/ nor v1.0-*/ in it");
}

Sequence open(const Options& o) {
    const std::string layout = o.layout == "auto" ? layoutOf(o.sequence.folder) : o.layout;
    if (layout == "raw") return openKittiRaw(o.sequence);
    if (layout == "tracking") return openKittiTracking(o.sequence);
    if (layout == "odometry") return openKittiOdometry(o.sequence);
    if (layout == "object") return openKittiObject(o.sequence);
    return openNuScenes(o.sequence);
}

void addOptions(CLI::App& app, Options& o) {
    app.footer(kFooter);
    app.add_option("FOLDER", o.sequence.folder, "where the recording is")->required();
    app.add_option("--output", o.writer.prefix, "beginning of the names of what is written")
        ->type_name("PREFIX")
        ->required();
    app.add_option("--layout", o.layout, "how the files are laid out; auto: by what is there")
        ->check(CLI::IsMember({"auto", "object", "tracking", "odometry", "raw", "nuscenes"}))
        ->capture_default_str();
    app.add_option("--sequence", o.sequence.sequence, "which one, where the folder has several")->type_name("NAME");
    app.add_option("--planes", o.writer.planes, "keep N of the sensor's rings, evenly spaced; 0: all")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app.add_option("--sensor-height", o.sequence.sensor_height, "of KITTI's sensor above the ground [m]")
        ->capture_default_str();
    app.add_option("--start-time", o.sequence.start_time, "of recordings without times [s since the epoch]")
        ->capture_default_str();
    app.add_option_function<std::string>(
           "--scan-class",
           [&o](const std::string& word) {
               o.writer.scan_class = word == "velodyne" ? ScanClass::Velodyne : ScanClass::PointCloud;
           },
           "CObservationVelodyneScan, which keeps the rings, or CObservationPointCloud, which RawLogViewer shows")
        ->check(CLI::IsMember({"velodyne", "pointcloud"}))
        ->default_str("velodyne");
    app.add_flag("--images", o.sequence.images,
                 "also images: of the left colour camera (KITTI: image_2, image_02) or of CAM_FRONT (nuScenes)");
    app.add_option("--from", o.from, "number of the first scan");
    app.add_option("--to", o.to, "number of the last scan");
    app.set_version_flag("--version", "kitti2rawlog " LIDAR_OBSTACLES_VERSION);
}

/// What was converted.
struct Converted {
    std::size_t scans = 0;
    std::size_t labels = 0;
    std::size_t poses = 0;
    std::size_t images = 0;  ///< scans with one
    std::string error;       ///< of the scan after them; empty if there was none
};

/// Scans from..end-1, as far as they can be read. @throws what the first one throws.
Converted convert(const Options& o, const Sequence& sequence, std::size_t end, SequenceWriter& writer) {
    Converted done;
    ProgressBar progress;
    for (std::size_t k = o.from; k < end && !isInterrupted(); ++k) {
        Frame frame;
        try {
            frame = sequence.load(k);
            writer.add(frame);
        } catch (const std::runtime_error& e) {
            if (done.scans == 0) throw;
            done.error = e.what();
            break;
        }
        ++done.scans;
        done.labels += frame.objects.size();
        done.poses += frame.T_world_vehicle ? 1 : 0;
        done.images += frame.image ? 1 : 0;
        progress.update(static_cast<double>(done.scans) / static_cast<double>(end - o.from), done.scans);
    }
    progress.clear();
    return done;
}

int run(const Options& o) {
    const Sequence sequence = open(o);
    const std::size_t end =
        std::min(sequence.frames, o.to == std::numeric_limits<std::size_t>::max() ? o.to : o.to + 1);
    if (o.from >= end)
        throw std::runtime_error(o.sequence.folder + ": " + std::to_string(sequence.frames) +
                                 " scans; --from and --to leave none");
    SequenceWriter writer(o.writer, sequence.planes);
    const Converted done = convert(o, sequence, end, writer);
    if (done.scans > 0) {
        try {
            writer.finish();
        } catch (const std::exception& e) {
            throw std::runtime_error((done.error.empty() ? "" : done.error + "; ") + e.what());
        }
        std::printf("%zu scans, %zu labels, %zu poses: see %s.rawlog and %s_gt.csv\n", done.scans, done.labels,
                    done.poses, o.writer.prefix.c_str(), o.writer.prefix.c_str());
        if (!sequence.remark.empty()) std::fprintf(stderr, "kitti2rawlog: %s\n", sequence.remark.c_str());
        if (done.poses > 0 && done.poses < done.scans)
            std::fprintf(stderr, "kitti2rawlog: %zu scans have no pose: the recording lacks it\n",
                         done.scans - done.poses);
        if (o.sequence.images && done.images < done.scans)
            std::fprintf(stderr, "kitti2rawlog: %zu scans have no image: the recording lacks it\n",
                         done.scans - done.images);
    }
    if (!done.error.empty()) throw std::runtime_error(done.error + "; the scans before it are written");
    return o.from + done.scans == end ? 0 : exitCode("kitti2rawlog", o.from + done.scans);
}

}  // namespace

int main(int argc, char** argv) {
    return runApp("kitti2rawlog", [&] {
        Options options;
        CLI::App app(kDescription, "kitti2rawlog");
        addOptions(app, options);
        if (!parse(app, argc, argv)) return 0;
        catchInterrupts();
        return run(options);
    });
}

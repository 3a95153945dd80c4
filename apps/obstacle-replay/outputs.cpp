#include "outputs.h"

#include <charconv>
#include <cstdio>
#include <stdexcept>

#include "lidar_obstacles/mrpt_bridge/maps.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

/// Fixed decimals, whatever the locale.
std::string fixed(double value, int decimals) {
    char buffer[400];  // the largest double has 309 digits
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals).ptr};
}

std::string shortest(double value) {
    char buffer[32];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

void require(bool written, const fs::path& file) {
    if (!written) throw std::runtime_error(file.string() + ": cannot write");
}

}  // namespace

std::string csvHeader() {
    return "timestamp,scan_index,id,class,x,y,z,length,width,height,yaw,heading_valid,num_points,"
           "heading_std,num_rings,distance\n";
}

std::string csvRows(double timestamp, std::size_t scan_index, const std::vector<Obstacle>& obstacles) {
    std::string rows;
    for (const Obstacle& o : obstacles) {
        rows +=
            fixed(timestamp, 6) + ',' + std::to_string(scan_index) + ',' + std::to_string(o.id) + ',' + toString(o.cls);
        for (int k = 0; k < 3; ++k) rows += ',' + fixed(o.box.center[k], 4);
        for (int k = 0; k < 3; ++k) rows += ',' + fixed(o.box.size[k], 4);
        rows += ',' + fixed(o.box.yaw, 5) + (o.heading_valid ? ",1," : ",0,") + std::to_string(o.num_points);
        rows += ',' + fixed(o.heading_std, 5) + ',' + std::to_string(o.num_rings) + ',' + fixed(distanceTo(o.box), 4) +
                '\n';
    }
    return rows;
}

Outputs::Outputs(const Options& options)
    : scenes_(options.scenes), grids_(options.grids), pictures_(options.pictures), folder_(options.output) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error || !fs::is_directory(folder_)) {
        throw std::runtime_error(folder_.string() + ": cannot make the output folder" +
                                 (error ? ": " + error.message() : ": there is a file of that name"));
    }
    if (pictures_.every > 0) renderer_.emplace(1280, 800);
    fs::remove(folder_ / "summary.json", error);  // of an earlier run: never beside the rows of this one
    csv_.emplace(folder_ / "obstacles.csv");
    csv_->append(csvHeader());
}

void Outputs::add(std::size_t processed, std::size_t scan_index, const PointCloud& cloud,
                  const DetectionResult& result) {
    csv_->append(csvRows(cloud.timestamp, scan_index, result.obstacles));
    if (grids_.has(processed)) writeGrid(scan_index, result.grid);
    const bool with_scene = scenes_.has(processed);
    const bool with_picture = pictures_.has(processed);
    if (!with_scene && !with_picture) return;
    const auto scene = toScene(cloud, result);
    if (with_scene) {
        const fs::path file = fileOf("scene", scan_index, ".3Dscene");
        require(scene->saveToFile(file.string()), file);
    }
    if (with_picture) {
        CameraView view;
        view.target.z() = result.ground.heightAt(view.target.x(), view.target.y());
        const fs::path file = fileOf("picture", scan_index, ".png");
        require(renderer_->render(*scene, view).saveToFile(file.string()), file);
    }
}

void Outputs::finish(const std::string& summary) {
    csv_->close();
    writeTextFile(folder_ / "summary.json", summary);
}

fs::path Outputs::fileOf(const char* kind, std::size_t scan_index, const char* extension) const {
    char number[32];
    std::snprintf(number, sizeof number, "_%06zu", scan_index);
    return folder_ / (std::string(kind) + number + extension);
}

void Outputs::writeGrid(std::size_t scan_index, const OccupancyGrid& grid) const {
    if (grid.empty()) return;
    const fs::path picture = fileOf("grid", scan_index, ".png");
    require(toOccupancyGridMap(grid).saveAsBitmapFile(picture.string()), picture);
    const OccupancyThresholds thresholds;
    writeTextFile(fileOf("grid", scan_index, ".yaml"),
                  "image: " + picture.filename().string() + "\nresolution: " + shortest(grid.resolution) +
                      "\norigin: [" + shortest(grid.origin.x()) + ", " + shortest(grid.origin.y()) +
                      ", 0]\nnegate: 0\noccupied_thresh: " + shortest(thresholds.occupied) +
                      "\nfree_thresh: " + shortest(thresholds.free) + "\n");
}

}  // namespace lidar_obstacles::apps

// SPDX-License-Identifier: BSD-3-Clause
// A peer: what the Point Cloud Library's own tutorials make of the same scans. Points near the vehicle, thinned to a
// voxel grid, without the plane that RANSAC takes for the ground, in Euclidean clusters; around each the rectangle of
// the closeness criterion (Zhang, Xu, Dong, Dolan 2017).
// usage: lidar_obstacles_pcl_peer RECORDING OUTPUT.csv [RINGS]
// Writes the boxes, in the columns of obstacles.csv that a judge of boxes reads, and prints a row of a table: the time
// of a scan, from the cloud in memory to boxes, of this chain and of the detector, in turn in one run.
#include <pcl/filters/extract_indices.h>
#include <pcl/filters/passthrough.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/io/pcd_io.h>  // asked for by the headers of MRPT where they find PCL
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "lidar_obstacles/pipelines.h"

namespace lidar_obstacles::bench {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

// As in the tutorials, for cars instead of a table.
constexpr float kReach = 40.0F;         // to each side [m]
constexpr float kVoxel = 0.1F;          // [m]
constexpr double kGround = 0.2;         // from the plane [m]
constexpr double kApart = 0.5;          // of clusters [m]
constexpr int kFewest = 5;              // points of a cluster
constexpr double kStep = M_PI / 180.0;  // of the angles that are tried [rad]
constexpr double kClose = 0.01;         // closer to an edge counts as that close [m]

struct Box {
    Eigen::Vector3d center{0, 0, 0}, size{0, 0, 0};
    double yaw = 0.0;
};

Cloud::Ptr nearOf(const PointCloud& scan) {
    auto cloud = std::make_shared<Cloud>();
    for (const Eigen::Vector3f& p : scan.xyz) cloud->emplace_back(p.x(), p.y(), p.z());
    for (const char* axis : {"x", "y"}) {
        pcl::PassThrough<pcl::PointXYZ> pass;
        pass.setInputCloud(cloud);
        pass.setFilterFieldName(axis);
        pass.setFilterLimits(-kReach, kReach);
        auto kept = std::make_shared<Cloud>();
        pass.filter(*kept);
        cloud = kept;
    }
    return cloud;
}

Cloud::Ptr thinned(const Cloud::Ptr& cloud) {
    pcl::VoxelGrid<pcl::PointXYZ> grid;
    grid.setInputCloud(cloud);
    grid.setLeafSize(kVoxel, kVoxel, kVoxel);
    auto kept = std::make_shared<Cloud>();
    grid.filter(*kept);
    return kept;
}

Cloud::Ptr withoutGround(const Cloud::Ptr& cloud) {
    pcl::SACSegmentation<pcl::PointXYZ> segmentation;
    segmentation.setModelType(pcl::SACMODEL_PERPENDICULAR_PLANE);
    segmentation.setAxis(Eigen::Vector3f::UnitZ());
    segmentation.setEpsAngle(10.0 * M_PI / 180.0);
    segmentation.setMethodType(pcl::SAC_RANSAC);
    segmentation.setMaxIterations(100);
    segmentation.setDistanceThreshold(kGround);
    segmentation.setOptimizeCoefficients(true);
    segmentation.setInputCloud(cloud);
    auto plane = std::make_shared<pcl::PointIndices>();
    pcl::ModelCoefficients coefficients;
    segmentation.segment(*plane, coefficients);
    pcl::ExtractIndices<pcl::PointXYZ> extract;
    extract.setInputCloud(cloud);
    extract.setIndices(plane);
    extract.setNegative(true);
    auto kept = std::make_shared<Cloud>();
    extract.filter(*kept);
    return kept;
}

std::vector<pcl::PointIndices> clustersOf(const Cloud::Ptr& cloud) {
    std::vector<pcl::PointIndices> clusters;
    if (cloud->empty()) return clusters;
    auto tree = std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>();
    tree->setInputCloud(cloud);
    pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
    extraction.setClusterTolerance(kApart);
    extraction.setMinClusterSize(kFewest);
    extraction.setSearchMethod(tree);
    extraction.setInputCloud(cloud);
    extraction.extract(clusters);
    return clusters;
}

/// The limits of points along an axis, and how close all of them are to the nearer limit of either axis.
struct Fit {
    Eigen::AlignedBox2d box;
    double closeness = 0.0;
};

Fit fitAt(double yaw, const std::vector<Eigen::Vector2d>& points) {
    const Eigen::Rotation2Dd turn(-yaw);
    Fit fit;
    for (const Eigen::Vector2d& p : points) fit.box.extend(turn * p);
    for (const Eigen::Vector2d& p : points) {
        const Eigen::Vector2d q = turn * p;
        const double edge = std::min((q - fit.box.min()).minCoeff(), (fit.box.max() - q).minCoeff());
        fit.closeness += 1.0 / std::max(edge, kClose);
    }
    return fit;
}

Box boxOf(const pcl::PointIndices& cluster, const Cloud& cloud) {
    std::vector<Eigen::Vector2d> points;
    double low = 1e9, high = -1e9;
    for (const int i : cluster.indices) {
        const pcl::PointXYZ& p = cloud[static_cast<std::size_t>(i)];
        points.emplace_back(p.x, p.y);
        low = std::min(low, static_cast<double>(p.z));
        high = std::max(high, static_cast<double>(p.z));
    }
    double yaw = 0.0;
    Fit best = fitAt(yaw, points);
    for (int k = 1; k < 90; ++k) {
        const Fit fit = fitAt(k * kStep, points);
        if (fit.closeness <= best.closeness) continue;
        best = fit;
        yaw = k * kStep;
    }
    Box box;
    box.center << Eigen::Rotation2Dd(yaw) * best.box.center(), 0.5 * (low + high);
    box.size << best.box.sizes(), high - low;
    box.yaw = yaw;
    if (box.size.x() < box.size.y()) {
        std::swap(box.size.x(), box.size.y());
        box.yaw -= 0.5 * M_PI;
    }
    return box;
}

std::vector<Box> peerBoxes(const PointCloud& scan) {
    const Cloud::Ptr cloud = withoutGround(thinned(nearOf(scan)));
    std::vector<Box> boxes;
    for (const pcl::PointIndices& cluster : clustersOf(cloud)) boxes.push_back(boxOf(cluster, *cloud));
    return boxes;
}

template <class Work>
double millisecondsOf(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double quantile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values.at(static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

void writeRows(std::ofstream& file, std::size_t scan, double time, const std::vector<Box>& boxes) {
    char row[300];
    for (std::size_t k = 0; k < boxes.size(); ++k) {
        const Box& b = boxes[k];
        std::snprintf(row, sizeof row, "%.6f,%zu,%zu,unknown,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.4f,1\n", time, scan, k,
                      b.center.x(), b.center.y(), b.center.z(), b.size.x(), b.size.y(), b.size.z(), b.yaw);
        file << row;
    }
}

void run(const std::string& recording, const std::string& output, int rings) {
    std::ofstream file(output);
    file << "timestamp,scan_index,id,class,x,y,z,length,width,height,yaw,heading_valid\n";
    DetectorParams params;
    params.sensor.planes = rings;
    std::vector<double> peer, own, ratio;
    const auto source = openScanSource(recording);
    while (const auto item = source->next()) {
        if (!item->observation || !isLidarScan(*item->observation)) continue;
        const PointCloud cloud = *toPointCloud(*item->observation, params.sensor);
        std::vector<Box> boxes;
        peer.push_back(millisecondsOf([&] { boxes = peerBoxes(cloud); }));
        own.push_back(millisecondsOf([&] { detect(cloud, params); }));
        ratio.push_back(peer.back() / own.back());
        writeRows(file, peer.size() - 1, cloud.timestamp, boxes);
    }
    if (peer.empty()) throw std::runtime_error(recording + ": no lidar scans");
    if (!file.flush()) throw std::runtime_error(output + ": cannot be written");
    std::printf("%.1f / %.1f | %.1f / %.1f | %.1f |\n", quantile(peer, 0.5), quantile(peer, 0.95), quantile(own, 0.5),
                quantile(own, 0.95), quantile(ratio, 0.5));
}

}  // namespace
}  // namespace lidar_obstacles::bench

int main(int argc, char** argv) {
    try {
        if (argc < 3 || argc > 4)
            throw std::runtime_error("usage: lidar_obstacles_pcl_peer RECORDING OUTPUT.csv [RINGS]");
        cv::setNumThreads(1);
        lidar_obstacles::bench::run(argv[1], argv[2], argc == 4 ? std::stoi(argv[3]) : 0);
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "error: " << e.what() << "\n";
        return 1;
    }
}

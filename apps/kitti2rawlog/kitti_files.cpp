// SPDX-License-Identifier: BSD-3-Clause
#include "kitti_files.h"

#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

/// The numbers behind one of the names; names may end with a colon.
std::vector<double> numbersOf(const fs::path& file, const std::vector<std::string>& names, std::size_t count) {
    for (const Words& words : wordsOf(file)) {
        std::string name = words.text(0);
        if (name.back() == ':') name.pop_back();
        if (std::find(names.begin(), names.end(), name) == names.end()) continue;
        if (words.size() != count + 1)
            words.fail(name + ": " + std::to_string(words.size() - 1) + " numbers, expected " + std::to_string(count));
        std::vector<double> numbers;
        for (std::size_t k = 1; k <= count; ++k) numbers.push_back(words.number(k));
        return numbers;
    }
    throw std::runtime_error(file.string() + ": no " + names.front() + " in it");
}

Eigen::Isometry3d isometryOf(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = rotation;
    T.translation() = translation;
    return T;
}

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajor34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

Eigen::Isometry3d isometryOf(const std::vector<double>& numbers) {
    const RowMajor34 m = Eigen::Map<const RowMajor34>(numbers.data());
    return isometryOf(Eigen::Matrix3d(m.leftCols<3>()), Eigen::Vector3d(m.col(3)));
}

/// The number in a child element. @throws std::runtime_error naming file and line.
double childNumber(const fs::path& file, const tinyxml2::XMLElement& element, const char* name) {
    double value = 0.0;
    const tinyxml2::XMLElement* child = element.FirstChildElement(name);
    if (child == nullptr || child->QueryDoubleText(&value) != tinyxml2::XML_SUCCESS)
        throw std::runtime_error(file.string() + ':' + std::to_string(element.GetLineNum()) + ": no number <" + name +
                                 ">");
    return value;
}

const tinyxml2::XMLElement& child(const fs::path& file, const tinyxml2::XMLElement& element, const char* name) {
    const tinyxml2::XMLElement* found = element.FirstChildElement(name);
    if (found == nullptr)
        throw std::runtime_error(file.string() + ':' + std::to_string(element.GetLineNum()) + ": no <" + name + ">");
    return *found;
}

/// The box at one pose of a tracklet, which is told for the middle of its bottom.
OrientedBox boxOfPose(const fs::path& file, const tinyxml2::XMLElement& pose, const Eigen::Vector3d& size,
                      const Eigen::Isometry3d& T_vehicle_velo) {
    OrientedBox box;
    box.size = size;
    const Eigen::Vector3d bottom(childNumber(file, pose, "tx"), childNumber(file, pose, "ty"),
                                 childNumber(file, pose, "tz"));
    box.center = T_vehicle_velo * bottom + Eigen::Vector3d(0, 0, 0.5 * size.z());
    box.yaw = normalizeAngle(childNumber(file, pose, "rz"));
    return box;
}

bool isNumber(const fs::path& file) {
    const std::string stem = file.stem().string();
    return !stem.empty() && stem.size() <= 15 && stem.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

Eigen::Isometry3d vehicleVelo(const SequenceOptions& options) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation().z() = options.sensor_height;
    return T;
}

std::vector<fs::path> scansIn(const fs::path& folder) {
    std::vector<fs::path> scans = filesIn(folder, ".bin");
    if (scans.empty()) throw std::runtime_error(folder.string() + ": no .bin files in it");
    if (std::all_of(scans.begin(), scans.end(), isNumber))  // 10.bin comes after 9.bin
        std::stable_sort(scans.begin(), scans.end(),
                         [](const fs::path& a, const fs::path& b) { return numberOf(a) < numberOf(b); });
    return scans;
}

std::string missingOf(const std::vector<fs::path>& scans) {
    std::size_t missing = 0;
    std::string first;
    for (std::size_t k = 1; k < scans.size() && isNumber(scans[k - 1]) && isNumber(scans[k]); ++k) {
        const std::size_t before = numberOf(scans[k - 1]), now = numberOf(scans[k]);
        if (now <= before + 1) continue;
        if (missing == 0) first = std::to_string(before + 1);
        missing += now - before - 1;
    }
    return missing == 0 ? "" : std::to_string(missing) + " scans between the others are missing, the first is " + first;
}

std::size_t numberOf(const fs::path& file) {
    if (!isNumber(file)) throw std::runtime_error(file.string() + ": a scan's name is its number");
    return static_cast<std::size_t>(std::stoull(file.stem().string()));
}

std::string kittiType(const std::string& word) {
    std::string type = word;
    std::transform(type.begin(), type.end(), type.begin(),
                   [](unsigned char c) { return c == ' ' ? '_' : static_cast<char>(std::tolower(c)); });
    return type == "person_(sitting)" || type == "sitter" ? "person_sitting" : type;
}

KittiCalibration readCameraCalibration(const fs::path& file) {
    const std::vector<double> rect = numbersOf(file, {"R0_rect", "R_rect"}, 9);
    const Eigen::Isometry3d T_camera_velo = isometryOf(numbersOf(file, {"Tr_velo_to_cam", "Tr_velo_cam"}, 12));
    const Eigen::Isometry3d T_rect_camera =
        isometryOf(Eigen::Matrix3d(Eigen::Map<const RowMajor3>(rect.data())), Eigen::Vector3d::Zero());
    KittiCalibration calibration;
    calibration.T_velo_camera = (T_rect_camera * T_camera_velo).inverse();
    calibration.T_velo_imu = isometryOf(numbersOf(file, {"Tr_imu_to_velo", "Tr_imu_velo"}, 12));
    return calibration;
}

Eigen::Isometry3d readImuToVelo(const fs::path& file) {
    const std::vector<double> r = numbersOf(file, {"R"}, 9);
    const std::vector<double> t = numbersOf(file, {"T"}, 3);
    return isometryOf(Eigen::Matrix3d(Eigen::Map<const RowMajor3>(r.data())), Eigen::Vector3d(t[0], t[1], t[2]));
}

Eigen::Isometry3d readOdometryCalibration(const fs::path& file) { return isometryOf(numbersOf(file, {"Tr"}, 12)); }

KittiCamera readColourCamera(const fs::path& file, const Eigen::Isometry3d& T_vehicle_rect0) {
    const std::vector<double> numbers = numbersOf(file, {"P2", "P_rect_02"}, 12);
    const RowMajor34 P = Eigen::Map<const RowMajor34>(numbers.data());
    KittiCamera camera{P(0, 0), P(1, 1), P(0, 2), P(1, 2), T_vehicle_rect0};
    if (!(camera.fx > 0.0 && camera.fy > 0.0)) throw std::runtime_error(file.string() + ": no focal length in P2");
    // P = K [I | t]: the camera sees a point of the rectified camera 0 shifted by t
    const double z = P(2, 3);
    camera.T_vehicle_camera.translate(
        -Eigen::Vector3d((P(0, 3) - camera.cx * z) / camera.fx, (P(1, 3) - camera.cy * z) / camera.fy, z));
    return camera;
}

Eigen::Isometry3d readRawCamera(const fs::path& day) {
    const fs::path file = day / "calib_velo_to_cam.txt";
    const std::vector<double> r = numbersOf(file, {"R"}, 9), t = numbersOf(file, {"T"}, 3);
    const std::vector<double> rect = numbersOf(day / "calib_cam_to_cam.txt", {"R_rect_00"}, 9);
    const Eigen::Isometry3d T_camera_velo =
        isometryOf(Eigen::Matrix3d(Eigen::Map<const RowMajor3>(r.data())), Eigen::Vector3d(t[0], t[1], t[2]));
    const Eigen::Isometry3d T_rect_camera =
        isometryOf(Eigen::Matrix3d(Eigen::Map<const RowMajor3>(rect.data())), Eigen::Vector3d::Zero());
    return (T_rect_camera * T_camera_velo).inverse();
}

std::optional<FrameImage> KittiCamera::image(const fs::path& file, double timestamp) const {
    std::error_code ec;
    if (!fs::is_regular_file(file, ec)) return std::nullopt;
    return FrameImage{file, "camera_2", timestamp, fx, fy, cx, cy, T_vehicle_camera};
}

void requireImages(const fs::path& folder) {
    if (!fs::is_directory(folder)) throw std::runtime_error(folder.string() + ": no such folder: --images needs it");
}

Eigen::Isometry3d isometryOf(const Words& row) {
    if (row.size() != 12) row.fail(std::to_string(row.size()) + " numbers, expected 12");
    std::vector<double> numbers;
    for (std::size_t k = 0; k < row.size(); ++k) numbers.push_back(row.number(k));
    return isometryOf(numbers);
}

std::optional<LabelledObject> objectOfLabel(const Words& words, std::size_t first,
                                            const Eigen::Isometry3d& T_vehicle_camera) {
    LabelledObject object;
    object.type = kittiType(words.text(first));
    if (object.type == "dontcare") return std::nullopt;
    object.occluded = words.integer(first + 2);
    const double height = words.number(first + 8);
    object.box.size = {words.number(first + 10), words.number(first + 9), height};
    const Eigen::Vector3d bottom(words.number(first + 11), words.number(first + 12), words.number(first + 13));
    // the camera looks along z, its y points down: the label's place is the middle of the bottom
    object.box.center = T_vehicle_camera * Eigen::Vector3d(bottom.x(), bottom.y() - 0.5 * height, bottom.z());
    const double rotation_y = words.number(first + 14);
    const Eigen::Vector3d along =
        T_vehicle_camera.linear() * Eigen::Vector3d(std::cos(rotation_y), 0.0, -std::sin(rotation_y));
    object.box.yaw = normalizeAngle(std::atan2(along.y(), along.x()));
    return object;
}

std::map<std::size_t, std::vector<LabelledObject>> readTracklets(const fs::path& file,
                                                                 const Eigen::Isometry3d& T_vehicle_velo) {
    tinyxml2::XMLDocument document;
    if (document.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS)
        throw std::runtime_error(file.string() + ": " + document.ErrorStr());
    const tinyxml2::XMLElement* root = document.RootElement();
    const tinyxml2::XMLElement& list = child(file, *root, "tracklets");
    std::map<std::size_t, std::vector<LabelledObject>> objects;
    int number = 0;
    for (const auto* t = list.FirstChildElement("item"); t != nullptr; t = t->NextSiblingElement("item"), ++number) {
        const char* type = child(file, *t, "objectType").GetText();
        const Eigen::Vector3d size(childNumber(file, *t, "l"), childNumber(file, *t, "w"), childNumber(file, *t, "h"));
        auto frame = static_cast<std::size_t>(childNumber(file, *t, "first_frame"));
        const tinyxml2::XMLElement& poses = child(file, *t, "poses");
        for (const auto* p = poses.FirstChildElement("item"); p != nullptr; p = p->NextSiblingElement("item")) {
            LabelledObject object{std::to_string(number), kittiType(type ? type : ""), {}, 0};
            object.box = boxOfPose(file, *p, size, T_vehicle_velo);
            object.occluded = static_cast<int>(childNumber(file, *p, "occlusion"));
            objects[frame++].push_back(std::move(object));
        }
    }
    return objects;
}

Eigen::Isometry3d poseOfOxts(const Words& words, double latitude_deg) {
    constexpr double kEarthRadius = 6378137.0;  // [m]
    const double scale = std::cos(latitude_deg * M_PI / 180.0);
    const double x = scale * kEarthRadius * words.number(1) * M_PI / 180.0;
    const double y = scale * kEarthRadius * std::log(std::tan((90.0 + words.number(0)) * M_PI / 360.0));
    const Eigen::Matrix3d rotation = (Eigen::AngleAxisd(words.number(5), Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(words.number(4), Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(words.number(3), Eigen::Vector3d::UnitX()))
                                         .toRotationMatrix();
    return isometryOf(rotation, Eigen::Vector3d(x, y, words.number(2)));
}

double secondsOf(const std::string& date_and_time) {
    std::tm t{};
    double seconds = 0.0;
    if (std::sscanf(date_and_time.c_str(), "%d-%d-%d %d:%d:%lf", &t.tm_year, &t.tm_mon, &t.tm_mday, &t.tm_hour,
                    &t.tm_min, &seconds) != 6)
        throw std::runtime_error("'" + date_and_time + "' is not a time like 2011-09-26 13:02:25.964389445");
    t.tm_year -= 1900;
    t.tm_mon -= 1;
    return static_cast<double>(timegm(&t)) + seconds;
}

}  // namespace lidar_obstacles::apps

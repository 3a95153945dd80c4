// SPDX-License-Identifier: BSD-3-Clause
#include "content.h"

#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <openssl/evp.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>
#include <stdexcept>

#include "lidar_obstacles/mrpt_bridge/external_files.h"
#include "lidar_obstacles/mrpt_bridge/rawlog_reader.h"

namespace lidar_obstacles::fleet {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const char* what) {
    throw std::runtime_error(file.string() + ": " + what +
                             (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
}

/// The name of the file that holds the points or the image of an observation; "" if it holds them itself.
std::string externalFileOf(const mrpt::obs::CObservation& observation) {
    if (const auto* cloud = dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation))
        return cloud->isExternallyStored() ? cloud->getExternalStorageFile() : "";
    if (const auto* camera = dynamic_cast<const mrpt::obs::CObservationImage*>(&observation))
        return camera->image.isExternallyStored() ? camera->image.getExternalStorageFile() : "";
    return "";
}

struct NamedFile {
    std::string name;  ///< in the rawlog
    fs::path path;
};

/// Those of the named files that are there.
std::vector<NamedFile> findNamed(const fs::path& recording, const std::vector<std::string>& named) {
    const ExternalFiles files(recording.string());
    std::vector<NamedFile> found;
    for (const std::string& name : named)
        if (const auto place = files.find(name)) found.push_back({name, place->folder / place->file});
    return found;
}

void addStamp(const fs::path& file, Stamp& stamp) {
    struct stat status{};
    errno = 0;
    if (stat(file.c_str(), &status) != 0) fail(file, "cannot read");
    errno = 0;
    if (!S_ISREG(status.st_mode)) fail(file, "not a file");
    constexpr std::int64_t kSecond = 1000000000;
    stamp.bytes += static_cast<std::uint64_t>(status.st_size);
    stamp.changed_ns = std::max(stamp.changed_ns, status.st_mtim.tv_sec * kSecond + status.st_mtim.tv_nsec);
}

}  // namespace

struct Sha256::Context {
    EVP_MD_CTX* of = EVP_MD_CTX_new();
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
    if (context_->of == nullptr || EVP_DigestInit_ex(context_->of, EVP_sha256(), nullptr) != 1)
        throw std::runtime_error("no SHA-256 in the system's OpenSSL");
}

Sha256::~Sha256() { EVP_MD_CTX_free(context_->of); }

void Sha256::add(const void* bytes, std::size_t count) { EVP_DigestUpdate(context_->of, bytes, count); }

std::string Sha256::hex() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned count = 0;
    EVP_DigestFinal_ex(context_->of, digest.data(), &count);
    std::string text;
    text.reserve(std::size_t{2} * count);
    for (unsigned k = 0; k < count; ++k) {
        text += "0123456789abcdef"[digest[k] >> 4U];
        text += "0123456789abcdef"[digest[k] & 15U];
    }
    return text;
}

std::string sha256Of(const std::string& text) {
    Sha256 sum;
    sum.add(text);
    return sum.hex();
}

std::string sha256OfFile(const fs::path& file) {
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in) fail(file, "cannot read");
    Sha256 sum;
    std::vector<char> block(std::size_t{1} << 20U);
    while (in) {
        errno = 0;
        in.read(block.data(), static_cast<std::streamsize>(block.size()));
        sum.add(block.data(), static_cast<std::size_t>(in.gcount()));
    }
    if (in.bad() || (errno != 0 && !in.eof())) fail(file, "cannot read");
    return sum.hex();
}

std::vector<std::string> filesNamedIn(const fs::path& recording) {
    std::set<std::string> names;
    try {
        InputOptions options;
        options.with_clouds = false;
        const auto source = openScanSource(recording.string(), options);
        if (dynamic_cast<const RawlogReader*>(source.get()) == nullptr) return {};  // a capture names no files
        while (const auto item = source->next())
            if (item->observation) names.insert(externalFileOf(*item->observation));
    } catch (const std::exception&) {  // no recording: the run says so
    }
    names.erase("");
    return {names.begin(), names.end()};
}

Stamp stampOf(const fs::path& recording, const std::vector<std::string>& named) {
    Stamp stamp;
    addStamp(recording, stamp);
    for (const NamedFile& file : findNamed(recording, named)) addStamp(file.path, stamp);
    return stamp;
}

std::string contentOf(const fs::path& recording, const std::vector<std::string>& named) {
    std::string whole = sha256OfFile(recording);
    const std::vector<NamedFile> files = findNamed(recording, named);
    if (files.empty()) return whole;
    for (const NamedFile& file : files) whole += '\n' + file.name + ' ' + sha256OfFile(file.path);
    return sha256Of(whole);
}

}  // namespace lidar_obstacles::fleet

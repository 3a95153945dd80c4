// SPDX-License-Identifier: BSD-3-Clause
#include "content.h"

#include <openssl/evp.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace lidar_obstacles::fleet {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const char* what) {
    throw std::runtime_error(file.string() + ": " + what +
                             (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
}

/// The files beside a rawlog that hold its clouds, in the order of their names; none for other recordings.
std::vector<fs::path> cloudsOf(const fs::path& recording) {
    fs::path name = recording.stem();
    if (recording.extension() == ".gz") name = name.stem();
    std::vector<fs::path> files;
    for (const char* end : {"_Images", "_images", "_IMAGES"}) {
        std::error_code ignored;
        const fs::path folder = recording.parent_path() / (name.string() + end);
        for (const auto& file : fs::recursive_directory_iterator(folder, ignored))
            if (file.is_regular_file(ignored)) files.push_back(file.path());
    }
    std::sort(files.begin(), files.end());
    return files;
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

Stamp stampOf(const fs::path& recording) {
    Stamp stamp;
    addStamp(recording, stamp);
    for (const fs::path& cloud : cloudsOf(recording)) addStamp(cloud, stamp);
    return stamp;
}

std::string contentOf(const fs::path& recording) {
    const std::vector<fs::path> clouds = cloudsOf(recording);
    std::string whole = sha256OfFile(recording);
    if (clouds.empty()) return whole;
    for (const fs::path& cloud : clouds)
        whole += '\n' + cloud.lexically_relative(recording.parent_path()).generic_string() + ' ' + sha256OfFile(cloud);
    return sha256Of(whole);
}

}  // namespace lidar_obstacles::fleet

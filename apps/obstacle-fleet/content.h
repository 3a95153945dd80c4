// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a recording holds, told by its bytes: the same wherever it lies and whatever it is called.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace lidar_obstacles::fleet {

/// SHA-256, as `sha256sum` prints it.
class Sha256 {
  public:
    /// @throws std::runtime_error if there is no SHA-256 in the system's library.
    Sha256();
    ~Sha256();
    Sha256(const Sha256&) = delete;
    Sha256& operator=(const Sha256&) = delete;

    void add(const void* bytes, std::size_t count);
    void add(const std::string& text) { add(text.data(), text.size()); }
    /// 64 hexadecimal digits; nothing may be added after that.
    std::string hex();

  private:
    struct Context;
    std::unique_ptr<Context> context_;
};

std::string sha256Of(const std::string& text);

/// @throws std::runtime_error naming the file and the reason if it cannot be read.
std::string sha256OfFile(const std::filesystem::path& file);

/// Size and time of a recording, without a look into it.
struct Stamp {
    std::uint64_t bytes = 0;      ///< with the files that it names
    std::int64_t changed_ns = 0;  ///< when it was changed last, the newest of its files [ns]

    bool operator==(const Stamp& other) const { return bytes == other.bytes && changed_ns == other.changed_ns; }
};

/// The names that a rawlog has for clouds and images in files of their own, each once, in order; none of other files.
/// What stands behind a damage is not among them.
std::vector<std::string> filesNamedIn(const std::filesystem::path& recording);

/// @param named  filesNamedIn() the recording; those that ExternalFiles finds count.
/// @throws std::runtime_error naming the file if it is not there or no file.
Stamp stampOf(const std::filesystem::path& recording, const std::vector<std::string>& named = {});

/// SHA-256 of a recording. Where it names files that are there: of the digests of all of them and of their names, so
/// that a changed cloud is another recording, wherever its file lies.
/// @param named  filesNamedIn() the recording.
/// @throws std::runtime_error naming the file and the reason.
std::string contentOf(const std::filesystem::path& recording, const std::vector<std::string>& named = {});

}  // namespace lidar_obstacles::fleet

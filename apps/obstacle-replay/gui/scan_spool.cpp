// SPDX-License-Identifier: BSD-3-Clause
#include "scan_spool.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "common/nameless_file.h"

namespace lidar_obstacles::apps {
namespace {

[[noreturn]] void fail(const std::string& what) {
    throw std::runtime_error("temporary file in " + temporaryFolder() + ": " + what + ": " + std::strerror(errno));
}

}  // namespace

ScanSpool::ScanSpool() : file_(openNamelessFile()) {}

ScanSpool::~ScanSpool() { close(file_); }

ScanSpool::Place ScanSpool::append(const mrpt::obs::CObservation& scan) {
    mrpt::io::CMemoryStream memory;
    mrpt::serialization::archiveFrom(memory).WriteObject(scan);
    const auto* data = static_cast<const char*>(memory.getRawBufferData());
    const Place place{end_, memory.getTotalBytesCount()};
    for (std::uint64_t done = 0; done < place.size;) {
        const ssize_t n = pwrite(file_, data + done, place.size - done, static_cast<off_t>(end_ + done));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) fail("cannot be written");
        done += static_cast<std::uint64_t>(n);
    }
    end_ += place.size;
    return place;
}

mrpt::obs::CObservation::Ptr ScanSpool::read(const Place& place) const {
    std::vector<char> data(place.size);
    for (std::uint64_t done = 0; done < place.size;) {
        const ssize_t n = pread(file_, data.data() + done, place.size - done, static_cast<off_t>(place.begin + done));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) fail("cannot be read");
        done += static_cast<std::uint64_t>(n);
    }
    mrpt::io::CMemoryStream memory(data.data(), data.size());
    return std::dynamic_pointer_cast<mrpt::obs::CObservation>(mrpt::serialization::archiveFrom(memory).ReadObject());
}

}  // namespace lidar_obstacles::apps

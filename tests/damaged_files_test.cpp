// SPDX-License-Identifier: BSD-3-Clause
// 280 cut, spliced or bit-flipped files (LIDAR_OBSTACLES_DAMAGED_FILES in each chunk, if that is set): reading and
// decoding them must neither crash, nor hang, nor eat the machine's memory, nor lose what stands before the damage, and
// must say so where a file was cut. Each chunk of cases runs in a process of its own under a cap on its memory.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "apps/common/address_space.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "support/capture_files.h"
#include "support/rawlog_files.h"
#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

using namespace test;

constexpr std::uint64_t kMemory = std::uint64_t{2} << 30U;  // half of what the tools allow themselves
constexpr unsigned kSecondsPerCase = 20;  // of the processor: on a busy machine the clock on the wall tells nothing

enum class Damage { Cut, FlippedBits, FlippedBitsInTheHeader, LastBytesFlipped, Spliced };

/// Files to damage: rawlogs of packets, plain and gzip, and of points, captures of whole and of fragmented packets.
enum class Original { PlainRawlog, GzipRawlog, PointCloudRawlog, MapRawlog, Capture, FragmentedCapture };

/// A quarter of a turn of each of three sensors, every packet in three fragments.
std::string fragmentedCapture() {
    CaptureFile file;
    unsigned identification = 0;
    for (const std::uint8_t model : {0x22, 0x24, 0x28}) {
        Turn turn;
        turn.packets = 19;
        for (VelodynePacket packet : makeScan(turn, wallAt(10.0)).scan_packets) {
            packet.velodyne_model_ID = model;
            for (const std::string& fragment : ipv4Fragments(payloadOf(packet), 552, ++identification))
                file.add(ethernet(fragment), 1000.0 + 0.001 * identification);
        }
    }
    return file.content();
}

/// The points of a turn, without rings.
mrpt::obs::CObservationPointCloud::Ptr mapOfATurn() {
    auto scan = mrpt::obs::CObservationPointCloud::Create();
    auto points = mrpt::maps::CSimplePointsMap::Create();
    for (const auto& p : toPointCloud(*scanLabelled("a"), SensorParams{}).xyz) points->insertPoint(p.x(), p.y(), p.z());
    scan->pointcloud = points;
    return scan;
}

std::string original(Original which, const TempFolder& folder) {
    if (which == Original::Capture) {
        CaptureFile file;
        file.add(*scanLabelled("a"), 1000.0);
        return file.content();
    }
    if (which == Original::FragmentedCapture) return fragmentedCapture();
    if (which == Original::MapRawlog) {
        writeRawlog(folder.file("original"), {mapOfATurn(), mapOfATurn()}, false);
        return readFile(folder.file("original"));
    }
    auto last = scanLabelled("a");
    if (which == Original::PointCloudRawlog) {
        last->generatePointCloud();
        last->scan_packets.clear();
    }
    writeRawlog(folder.file("original"), {scanLabelled("a"), last}, which == Original::GzipRawlog);
    return readFile(folder.file("original"));
}

std::string damaged(std::string content, Damage damage, std::mt19937& random) {
    const auto below = [&random](std::size_t n) {
        return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
    };
    if (damage == Damage::Cut) return content.substr(0, 1 + below(content.size() - 1));
    if (damage == Damage::Spliced) {  // a part is missing, another stands in its place
        const std::size_t from = below(content.size()), to = below(content.size());
        return content.replace(from, below(content.size() - from) / 4, content.substr(to, below(2000)));
    }
    const std::size_t n = content.size(), header = std::min<std::size_t>(n, 300);
    const std::size_t flips = damage == Damage::FlippedBits ? 1 + below(20) : 1 + below(3);
    for (std::size_t i = 0; i < flips; ++i) {
        const std::size_t at = damage == Damage::FlippedBits              ? below(n)
                               : damage == Damage::FlippedBitsInTheHeader ? below(header)
                                                                          : n - 1 - below(header);
        content[at] = static_cast<char>(content[at] ^ static_cast<char>(1U << below(8)));
    }
    return content;
}

/// What was read of a file.
struct Content {
    std::size_t scans = 0;
    std::size_t packets = 0;  ///< in them
};

/// Reads and decodes everything as the tools do. @return what the source says at its end.
SourceStatus readToTheEnd(const std::string& path, Content& read) {
    try {
        const auto source = openScanSource(path);
        while (const auto item = source->next()) {
            if (!item->observation) continue;
            ++read.scans;
            if (const auto* scan = dynamic_cast<const VelodyneScan*>(item->observation.get()))
                read.packets += scan->scan_packets.size();
            try {
                const auto cloud = toPointCloud(*item->observation, SensorParams{});
                if (!cloud) continue;
                for (const auto& p : cloud->xyz)
                    if (!p.allFinite()) _exit(3);
            } catch (const std::exception&) {
                // A scan that cannot be right is refused: that is what it is for.
            }
        }
        const bool tells_why = source->message().find(path) != std::string::npos;
        if ((source->status() == SourceStatus::Damaged) != tells_why) _exit(4);
        return source->status();
    } catch (const std::runtime_error&) {
        return SourceStatus::Damaged;  // not even opened
    }
}

/// What stands whole before the first byte that is not as it was. Of a compressed file nobody knows.
Content intactBefore(std::size_t damage, Original which, const std::string& content) {
    constexpr std::size_t kFile = 24, kRecord = 16 + 14 + 28 + 1206;  // headers of a capture, and a record of it
    if (which == Original::GzipRawlog || which == Original::FragmentedCapture) return {};
    if (which == Original::Capture)
        return {damage >= kFile + kRecord ? 1U : 0U, (std::max(damage, kFile) - kFile) / kRecord};
    const std::size_t name = static_cast<unsigned char>(content[0]) & 0x7fU;  // of the class: so begins the second, too
    return {damage >= content.find(content.substr(0, 1 + name), 1) ? 1U : 0U, 0};
}

struct Chunk {
    Original original;
    Damage damage;
    unsigned first_seed;
};

unsigned casesPerChunk() {
    const char* const asked = std::getenv("LIDAR_OBSTACLES_DAMAGED_FILES");
    return asked ? static_cast<unsigned>(std::strtoul(asked, nullptr, 10)) : 20;
}

volatile unsigned seed_now = 0;  ///< of the case that is running

/// Says which case takes too long, and lets the alarm end the process.
void tellSeed(int signal_number) {
    std::fprintf(stderr, "seed %u: no end within %u s\n", seed_now, kSecondsPerCase);
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
}

/// The process gets a signal when it has used so much of the processor from now on [s].
void limitSeconds(unsigned seconds) {
    const itimerval limit{{0, 0}, {static_cast<time_t>(seconds), 0}};
    setitimer(ITIMER_PROF, &limit, nullptr);
}

/// The child process: a case after the other.
[[noreturn]] void runCases(const Chunk& chunk, const std::string& content, const std::string& path) {
    if (!capAddressSpace(kMemory)) _exit(5);
    for (unsigned i = 0; i < casesPerChunk(); ++i) {
        seed_now = chunk.first_seed + i;
        std::signal(SIGPROF, tellSeed);
        limitSeconds(kSecondsPerCase);
        std::mt19937 random(chunk.first_seed + i);
        const std::string bad = damaged(content, chunk.damage, random);
        writeFile(path, bad);
        Content read;
        const SourceStatus status = readToTheEnd(path, read);
        const auto first_bad =
            std::mismatch(bad.begin(), bad.end(), content.begin(), content.end()).first - bad.begin();
        const Content whole = intactBefore(static_cast<std::size_t>(first_bad), chunk.original, content);
        if (read.scans < whole.scans || read.packets < whole.packets) {
            std::fprintf(stderr, "seed %u: %zu scans of %zu packets, %zu of %zu stand before byte %td\n", seed_now,
                         read.scans, read.packets, whole.scans, whole.packets, first_bad);
            _exit(7);
        }
        // Only a cut just between two objects of a plain file cannot be told; no seed makes one.
        if (chunk.damage == Damage::Cut && status != SourceStatus::Damaged) {
            std::fprintf(stderr, "seed %u: cut to %zu of %zu bytes, not reported\n", chunk.first_seed + i,
                         readFile(path).size(), content.size());
            _exit(6);
        }
    }
    _exit(0);
}

class DamagedFiles : public testing::TestWithParam<Chunk> {};

TEST_P(DamagedFiles, NeitherCrashNorHangNorEatMemory) {
    if (!canCapAddressSpace()) GTEST_SKIP() << "AddressSanitizer does not live with a cap on the address space";
    const TempFolder folder;
    const std::string content = original(GetParam().original, folder);
    const pid_t child = fork();
    if (child == 0) runCases(GetParam(), content, folder.file("damaged"));
    ASSERT_GT(child, 0);
    int status = 0;
    rusage usage{};
    ASSERT_EQ(wait4(child, &status, 0, &usage), child);
    EXPECT_FALSE(WIFSIGNALED(status)) << "signal " << WTERMSIG(status) << (WTERMSIG(status) == SIGPROF ? ": hang" : "");
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : 0, 0)
        << "3: a return that is not finite; 4: damage without message; 5: no cap; 6: a cut was not noticed; "
           "7: something before the damage was lost";
    EXPECT_LT(static_cast<std::uint64_t>(usage.ru_maxrss) * 1024, kMemory);
}

std::string nameOf(const testing::TestParamInfo<Chunk>& test) {
    const char* const originals[] = {"PlainRawlog", "GzipRawlog", "PointCloudRawlog",
                                     "MapRawlog",   "Capture",    "FragmentedCapture"};
    const char* const damages[] = {"Cut", "FlippedBits", "FlippedHeader", "FlippedEnd", "Spliced"};
    return std::string(originals[static_cast<int>(test.param.original)]) +
           damages[static_cast<int>(test.param.damage)] + std::to_string(test.param.first_seed);
}

INSTANTIATE_TEST_SUITE_P(Chunks, DamagedFiles,
                         testing::Values(Chunk{Original::PlainRawlog, Damage::Cut, 100},
                                         Chunk{Original::GzipRawlog, Damage::Cut, 200},
                                         Chunk{Original::Capture, Damage::Cut, 300},
                                         Chunk{Original::PlainRawlog, Damage::FlippedBits, 400},
                                         Chunk{Original::GzipRawlog, Damage::FlippedBits, 500},
                                         Chunk{Original::PointCloudRawlog, Damage::FlippedBits, 600},
                                         Chunk{Original::Capture, Damage::FlippedBits, 700},
                                         Chunk{Original::PlainRawlog, Damage::FlippedBitsInTheHeader, 800},
                                         Chunk{Original::PointCloudRawlog, Damage::FlippedBitsInTheHeader, 900},
                                         Chunk{Original::PlainRawlog, Damage::LastBytesFlipped, 1000},
                                         Chunk{Original::MapRawlog, Damage::FlippedBits, 1100},
                                         Chunk{Original::FragmentedCapture, Damage::FlippedBits, 1200},
                                         Chunk{Original::FragmentedCapture, Damage::Spliced, 1300},
                                         Chunk{Original::PlainRawlog, Damage::Spliced, 1400}),
                         nameOf);

/// Reads a rawlog of a scan and a damaged one in a process of its own, whose memory is capped. @param status  of its
/// end; 0: the scan came, then the damage was told.
void readOneThenDamage(const std::string& rawlog, int& status) {
    const pid_t child = fork();
    if (child == 0) {
        limitSeconds(kSecondsPerCase);
        if (!capAddressSpace(kMemory)) _exit(5);
        const auto source = openScanSource(rawlog);
        const bool one = source->next().has_value() && !source->next().has_value();
        _exit(one && source->status() == SourceStatus::Damaged && source->objects() == 1 ? 0 : 1);
    }
    ASSERT_EQ(waitpid(child, &status, 0), child);
}

TEST(DamagedLength, AScanOfBillionsOfPacketsIsDamageNotMemory) {
    if (!canCapAddressSpace()) GTEST_SKIP() << "AddressSanitizer does not live with a cap on the address space";
    const TempFolder folder;
    writeRawlog(folder.file("log"), {scanLabelled("a"), scanLabelled("a")}, false);
    std::string content = readFile(folder.file("log"));
    const std::string count = little(75, 4);  // the packets of the second scan
    const std::size_t at = content.rfind(count, content.rfind(payloadOf(scanLabelled("a")->scan_packets[0])));
    ASSERT_NE(at, std::string::npos);
    content.replace(at, 4, little(0x7fffffffU, 4));
    writeFile(folder.file("log"), content);
    int status = 0;
    ASSERT_NO_FATAL_FAILURE(readOneThenDamage(folder.file("log"), status));
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST(DamagedLength, APlanarScanOfBillionsOfRaysIsDamageNotACrash) {
    if (!canCapAddressSpace()) GTEST_SKIP() << "AddressSanitizer does not live with a cap on the address space";
    constexpr std::uint32_t kRays = 4660;
    const TempFolder folder;
    auto scan = mrpt::obs::CObservation2DRangeScan::Create();
    scan->resizeScan(kRays);
    writeRawlog(folder.file("log"), {scan, scan}, false);
    std::string content = readFile(folder.file("log"));
    const std::size_t second = content.rfind("CObservation2DRangeScan");
    const std::size_t at = content.find(little(kRays, 4), second);
    ASSERT_NE(at, std::string::npos);
    content.replace(at, 4, little(0x7fffffffU, 4));
    writeFile(folder.file("log"), content);
    int status = 0;
    ASSERT_NO_FATAL_FAILURE(readOneThenDamage(folder.file("log"), status));
    EXPECT_FALSE(WIFSIGNALED(status)) << "signal " << WTERMSIG(status);
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : 0, 0);
}

}  // namespace
}  // namespace lidar_obstacles

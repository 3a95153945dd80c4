// SPDX-License-Identifier: BSD-3-Clause
// Queue, latencies, addresses, sockets, captures, recordings: each by itself.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "lidar_obstacles/live/latency.h"
#include "lidar_obstacles/live/live_scanner.h"
#include "lidar_obstacles/live/pcap_source.h"
#include "lidar_obstacles/live/udp_source.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "support/capture_files.h"
#include "support/rawlog_files.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::live {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Queue, AFullOneDropsTheOldest) {
    BoundedQueue<int> queue(2);
    EXPECT_TRUE(queue.push(1));
    EXPECT_TRUE(queue.push(2));
    EXPECT_FALSE(queue.push(3));
    EXPECT_EQ(queue.pop(), 2);
    EXPECT_EQ(queue.pop(), 3);
    EXPECT_EQ(queue.pop(0.001), std::nullopt);
}

TEST(Queue, WhatIsInAClosedOneCanStillBeTaken) {
    BoundedQueue<int> queue(2);
    queue.push(1);
    queue.close();
    queue.push(2);
    EXPECT_FALSE(queue.ended());
    EXPECT_EQ(queue.pop(), 1);
    EXPECT_TRUE(queue.ended());
    EXPECT_EQ(queue.pop(), std::nullopt);
}

TEST(Queue, AWaitingGiverLosesNothing) {
    BoundedQueue<int> queue(1);
    std::thread giver([&] {
        for (int i = 0; i < 1000; ++i) queue.pushWaiting(i);
        queue.close();
    });
    int expected = 0;
    while (const auto i = queue.pop()) EXPECT_EQ(*i, expected++);
    EXPECT_EQ(expected, 1000);
    giver.join();
}

TEST(Latency, QuantilesAreRightWithinAStep) {
    LatencyHistogram latency;
    EXPECT_EQ(latency.quantile(0.5), 0.0);
    for (int i = 1; i <= 1000; ++i) latency.add(0.01 * i);  // 0.01 .. 10 ms
    EXPECT_NEAR(latency.quantile(0.50), 5.0, 0.051);
    EXPECT_NEAR(latency.quantile(0.95), 9.5, 0.051);
    EXPECT_NEAR(latency.quantile(0.99), 9.9, 0.051);
    latency.add(2000.0);
    latency.add(-1.0);
    EXPECT_EQ(latency.quantile(1.0), 2000.0);
    EXPECT_EQ(latency.max(), 2000.0);
    EXPECT_EQ(latency.count(), 1002u);
}

TEST(Endpoint, IsReadStrictly) {
    const auto read = [](const char* text) { return toString(parseEndpoint(text, {})); };
    EXPECT_EQ(read("192.168.1.77:5000"), "192.168.1.77:5000");
    EXPECT_EQ(read("192.168.1.77"), "192.168.1.77:2368");
    EXPECT_EQ(read(":99"), "127.0.0.1:99");
    for (const char* bad : {"", "localhost", "1.2.3", "1.2.3.4:", "1.2.3.4:65536", "1.2.3.4:-1", "1.2.3.4:5x", "::1"})
        EXPECT_THROW(parseEndpoint(bad, {}), std::invalid_argument) << bad;
}

/// Sends datagrams to an endpoint.
class Plug {
  public:
    explicit Plug(const Endpoint& to) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
        to_.sin_family = AF_INET;
        to_.sin_port = htons(to.port);
        to_.sin_addr.s_addr = htonl(to.address);
    }
    ~Plug() { ::close(socket_); }
    void send(const std::string& bytes) const {
        ASSERT_EQ(::sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_),
                  static_cast<ssize_t>(bytes.size()));
    }

  private:
    int socket_;
    sockaddr_in to_{};
};

TEST(Udp, DatagramsArriveWithLengthSenderAndTime) {
    UdpSource source(Endpoint{0x7f000001U, 0});
    const Plug plug(source.endpoint());
    const BothClocks before = bothClocks();
    plug.send("");
    plug.send("abc");
    plug.send(std::string(1400, 'x'));
    std::vector<Datagram> got;
    for (int i = 0; i < 10 && got.size() < 3; ++i) source.receive(1.0, [&](const Datagram& d) { got.push_back(d); });
    ASSERT_EQ(got.size(), 3u);
    EXPECT_EQ(got[0].length, 0u);
    EXPECT_EQ(got[1].length, 3u);
    EXPECT_EQ(std::string(got[1].bytes.begin(), got[1].bytes.begin() + 3), "abc");
    EXPECT_EQ(got[2].length, 1400u) << "as it was sent, although only the beginning is kept";
    EXPECT_EQ(got[1].sender, 0x7f000001U);
    for (const Datagram& d : got) {
        EXPECT_GT(d.time, before.wall - 0.01);
        EXPECT_LT(d.time, wallClock() + 0.01);
        EXPECT_GT(d.arrival, before.steady - 0.01);
        EXPECT_LT(d.arrival, steadyClock() + 0.01);
        EXPECT_EQ(d.steady_time, d.arrival);
    }
    EXPECT_EQ(source.overflows(), 0u);
}

TEST(Udp, ArrivalsAreRightWhateverTheClockOfTheSystemIsSetTo) {
    SteadyArrivals arrivals(100.0);
    EXPECT_NEAR(arrivals.next(5000.9, {5001.0, 101.0}), 100.9, 1e-9) << "it waited for 0.1 s";
    EXPECT_EQ(arrivals.next(5001.5, {1401.6, 101.6}), 101.6) << "put back by an hour while it waited";
    EXPECT_NEAR(arrivals.next(1401.9, {1402.0, 102.0}), 101.9, 1e-9);
    EXPECT_NEAR(arrivals.next(1402.3, {9002.4, 102.4}), 101.9, 1e-9) << "put forward: not before the one before";
    EXPECT_NEAR(arrivals.next(9002.9, {9003.0, 103.0}), 102.9, 1e-9);
}

TEST(Udp, AnAddressInUseOrNotOursIsAnErrorThatNamesIt) {
    UdpSource source(Endpoint{0x7f000001U, 0});
    try {
        UdpSource again(source.endpoint());
        FAIL();
    } catch (const std::runtime_error& e) {
        EXPECT_THAT(e.what(), HasSubstr(toString(source.endpoint())));
    }
    EXPECT_THROW(UdpSource(Endpoint{0x08080808U, 0}), std::runtime_error);
}

TEST(Udp, WhatIsNotFetchedIsThrownAwayAndCounted) {
    UdpSource source(Endpoint{0x7f000001U, 0});
    const Plug plug(source.endpoint());
    const std::string packet(1206, 'x');
    const int sent = 2 * source.bufferSize() / 1206;
    for (int i = 0; i < sent; ++i) plug.send(packet);
    int got = 0;
    for (int last = -1; last != got;) {
        last = got;
        source.receive(0.05, [&](const Datagram&) { ++got; });
    }
    plug.send(packet);  // brings the count along
    source.receive(1.0, [&](const Datagram&) { ++got; });
    EXPECT_GT(got, 0);
    EXPECT_EQ(static_cast<std::size_t>(sent + 1 - got), source.overflows());
}

class Files : public testing::Test {
  protected:
    /// Two and a half turns from azimuth 90 deg on, 0.248 s.
    void writeCapture() {
        Turn turn;
        turn.start = 9000;
        turn.packets = 187;
        CaptureFile file;
        file.add(makeScan(turn, sphere(20.0)), 1000.0);
        writeFile(capture_, file.content());
    }
    std::vector<LiveScan> scansOf(std::unique_ptr<PacketSource> source, ScannerOptions options) {
        options.may_drop = false;
        LiveScanner scanner(std::move(source), options);
        std::vector<LiveScan> scans;
        while (!scanner.ended())
            if (const auto scan = scanner.next(1.0)) scans.push_back(*scan);
        counts_ = scanner.counts();
        damage_ = scanner.damage();
        return scans;
    }

    TempFolder folder_;
    std::string capture_ = folder_.file("capture.pcap");
    ScannerCounts counts_;
    std::string damage_;
};

TEST_F(Files, ACaptureComesAtFullSpeedWithoutADroppedScan) {
    writeCapture();
    const auto scans = scansOf(std::make_unique<PcapSource>(capture_, Pace::Maximum), {});
    ASSERT_EQ(scans.size(), 4u) << "90 deg up to the cut, two turns, the rest";
    EXPECT_EQ(scans[1].observation->scan_packets.size(), 75u);
    EXPECT_EQ(counts_.stream.packets, 187u);
    EXPECT_EQ(counts_.stream.lost, 0u);
    EXPECT_EQ(counts_.dropped, 0u);
    EXPECT_EQ(damage_, "");
}

TEST_F(Files, ACaptureIsReadFromThePortOfItsFirstDataPacketOrTheOneThatIsSaid) {
    CaptureFile file;
    file.add(ethernet(ipv4(std::string(512, 'p'), 8308)), 999.0);
    file.add(makeScan({}, sphere(20.0)), 1000.0, 0xc0a801c9U, 2369);
    file.add(makeScan({}, sphere(20.0)), 1000.1, 0xc0a801caU, 2370);
    writeFile(capture_, file.content());
    scansOf(std::make_unique<PcapSource>(capture_, Pace::Maximum), {});
    EXPECT_EQ(counts_.stream.packets, 75u);
    EXPECT_EQ(counts_.stream.foreign + counts_.stream.malformed, 0u);
    scansOf(std::make_unique<PcapSource>(capture_, Pace::Maximum, 2370), {});
    EXPECT_EQ(counts_.stream.packets, 75u);
    scansOf(std::make_unique<PcapSource>(capture_, Pace::Maximum, 2368), {});
    EXPECT_EQ(counts_.stream.datagrams, 0u);
}

TEST_F(Files, ACaptureInRealTimeTakesItsTime) {
    writeCapture();
    const double start = steadyClock();
    const auto scans = scansOf(std::make_unique<PcapSource>(capture_, Pace::Real), {});
    EXPECT_GE(steadyClock() - start, 0.24);
    EXPECT_EQ(counts_.stream.packets, 187u);
    EXPECT_NEAR(mrpt::Clock::toDouble(scans[0].observation->timestamp), 1000.0, 1e-3) << "stamps are the capture's";
}

TEST_F(Files, ADamagedCaptureDeliversWhatCameBefore) {
    writeCapture();
    const std::string content = readFile(capture_);
    writeFile(capture_, content.substr(0, content.size() - 100));
    EXPECT_EQ(scansOf(std::make_unique<PcapSource>(capture_, Pace::Maximum), {}).size(), 4u);
    EXPECT_EQ(counts_.stream.packets, 186u);
    EXPECT_THAT(damage_, HasSubstr(capture_));
}

TEST_F(Files, ARecordingHoldsEveryScan) {
    writeCapture();
    const std::string rawlog = folder_.file("drive.rawlog");
    Recorder recorder(rawlog);
    ScannerOptions options;
    options.recorder = &recorder;
    const auto scans = scansOf(std::make_unique<PcapSource>(capture_, Pace::Maximum), options);
    recorder.finish();
    EXPECT_EQ(recorder.written(), scans.size());
    const auto source = openScanSource(rawlog);
    for (const LiveScan& scan : scans) {
        const auto item = source->next();
        ASSERT_TRUE(item && item->observation);
        const auto& read = dynamic_cast<const VelodyneScan&>(*item->observation);
        ASSERT_EQ(read.scan_packets.size(), scan.observation->scan_packets.size());
        EXPECT_EQ(payloadOf(read.scan_packets.back()), payloadOf(scan.observation->scan_packets.back()));
        EXPECT_EQ(read.timestamp, scan.observation->timestamp);
    }
    EXPECT_FALSE(source->next());
    EXPECT_EQ(source->status(), SourceStatus::End);
}

TEST_F(Files, AnUnfinishedRecordingIsWholeUpToTheLastObject) {
    const std::string file = folder_.file("drive.rawlog");
    RawlogWriter writer(file);
    for (int k = 0; k < 3; ++k) writer.append(*scanLabelled("lidar"));
    const auto source = openScanSource(file + ".part");  // as after a crash
    int scans = 0;
    while (source->next()) ++scans;
    EXPECT_EQ(scans, 3);
    EXPECT_EQ(source->status(), SourceStatus::End) << source->message();
}

TEST_F(Files, AFullDiskEndsARecordingWithAWholeObject) {
    const auto child = fork();
    const std::string file = folder_.file("drive.rawlog");
    if (child == 0) {  // a limit on files is one of the process
        signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{40'000, 40'000};
        setrlimit(RLIMIT_FSIZE, &limit);
        Recorder recorder(file);
        const LiveScan scan{scanLabelled("lidar"), 0, 0.0};
        for (int k = 0; k < 20; ++k) recorder.add(scan, false);
        try {
            recorder.finish();
        } catch (const std::runtime_error& e) {
            _exit(std::string(e.what()).find(file) != std::string::npos && recorder.written() > 0 ? 0 : 2);
        }
        _exit(1);
    }
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    const auto source = openScanSource(file);
    int scans = 0;
    while (source->next()) ++scans;
    EXPECT_GT(scans, 0);
    EXPECT_EQ(source->status(), SourceStatus::End) << source->message();
}

TEST(Scanner, ASlowReaderGetsTheNewestAndTheRestIsCounted) {
    auto udp = std::make_unique<UdpSource>(Endpoint{0x7f000001U, 0});
    const Plug plug(udp->endpoint());
    LiveScanner scanner(std::move(udp), {});
    for (int turns = 0; turns < 10; ++turns) {
        Turn turn;
        turn.clock = 1'000'000 + static_cast<std::uint32_t>(turns * 99533);
        for (const auto& packet : makeScan(turn, sphere(20.0)).scan_packets) {
            plug.send(payloadOf(packet));
            std::this_thread::sleep_for(std::chrono::microseconds(200));
        }
    }
    const double start = steadyClock();
    while (scanner.counts().stream.scans < 11 && steadyClock() - start < 20.0)  // the last one ends by silence
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    scanner.stop();
    std::vector<std::size_t> indices;
    while (!scanner.ended())
        if (const auto scan = scanner.next(1.0)) indices.push_back(scan->index);
    const ScannerCounts counts = scanner.counts();
    EXPECT_EQ(counts.stream.packets, 750u);
    EXPECT_EQ(indices.size(), 2u) << "what fits into the queue";
    EXPECT_EQ(indices.back() + 1, counts.stream.scans) << "the newest";
    EXPECT_EQ(counts.dropped + indices.size(), counts.stream.scans);
}

}  // namespace
}  // namespace lidar_obstacles::live

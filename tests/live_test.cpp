// SPDX-License-Identifier: BSD-3-Clause
// obstacle-live and velodyne-send from end to end: each test runs the programs, over loopback.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <future>
#include <thread>
#include <utility>

#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "support/live_program.h"
#include "support/rawlog_files.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using testing::HasSubstr;

TEST_F(Live, AnInterruptEndsItCleanlyWithCompleteFiles) {
    auto live = startListening({"--record", file("drive.rawlog")});
    std::thread sender([&] { send({"--duration", "3"}); });
    std::this_thread::sleep_for(std::chrono::milliseconds(2050));  // within a scan
    live->interrupt();
    EXPECT_EQ(live->wait(), 0) << err();
    sender.join();
    const auto results = lines(out());  // every line is whole
    EXPECT_GT(results.size(), 5u);
    EXPECT_EQ(statistics()["recorded"], results.size() + statistics()["scans_dropped"].get<std::size_t>());
    const auto source = openScanSource(file("drive.rawlog"));
    std::vector<double> times;
    while (const auto item = source->next()) times.push_back(mrpt::Clock::toDouble(item->observation->timestamp));
    for (const Json& line : results) {
        const std::size_t scan = line["scan_index"];
        EXPECT_NEAR(line["timestamp"].get<double>(), times.at(scan), 2e-6) << "as recorded";
    }
    EXPECT_EQ(source->status(), SourceStatus::End) << source->message();
    EXPECT_EQ(times.size(), statistics()["recorded"]);
}

TEST_F(Live, TheStreetsCarsAreFoundInEveryWholeScan) {
    auto live = startListening({"--sensor-pose", "0,0,1.8,0,0,0"});
    send({"--duration", "2"});
    live->interrupt();
    ASSERT_EQ(live->wait(), 0) << err();
    const auto results = lines(out());
    ASSERT_GT(results.size(), 3u);
    for (std::size_t k = 1; k + 1 < results.size(); ++k) {
        int vehicles = 0;
        for (const Json& o : results[k]["obstacles"]) vehicles += o["class"] == "vehicle";
        EXPECT_GE(vehicles, 3) << k;
        EXPECT_GT(results[k]["latency_ms"].get<double>(), 0.0);
    }
}

/// Exit code and words on the standard error of velodyne-send, to a port where nobody listens.
std::pair<int, std::string> sendAlone(const std::string& input, const TempFolder& folder) {
    const int code = Program({VELODYNE_SEND, input, "--to", "127.0.0.1:23692", "--duration", "0.1"},
                             folder.file("alone"), folder.file("alone_err"))
                         .wait();
    return {code, readFile(folder.file("alone_err"))};
}

TEST_F(Live, TheSenderSendsWhatIsGoodOfADamagedRecordingAndSaysSo) {
    const std::string whole = readFile(kStreet);
    writeFile(file("cut.rawlog"), whole.substr(0, whole.size() * 3 / 4));
    const auto [code, words] = sendAlone(file("cut.rawlog"), folder_);
    EXPECT_EQ(code, 1);
    EXPECT_THAT(words, HasSubstr("cut.rawlog: object "));
    EXPECT_GT(Json::parse(readFile(file("alone")))["packets"], 50);
    EXPECT_EQ(sendAlone(kStreet, folder_), std::pair(0, std::string()));
}

TEST_F(Live, TheSenderCountsTurnsThatLackPackets) {
    Objects scans;
    for (int k = 0; k < 6; ++k) {
        auto scan = scanLabelled("top", 1000.0 + 0.1 * k);
        if (k == 0 || k == 2 || k == 3) scan->scan_packets.resize(scan->scan_packets.size() / 2);
        scans.push_back(scan);
    }
    writeRawlog(file("gaps.rawlog"), scans, true);
    const auto [code, words] = sendAlone(file("gaps.rawlog"), folder_);
    EXPECT_EQ(code, 1);
    EXPECT_THAT(words, HasSubstr("2 of 6 turns lack more than a tenth of their packets and are left out"));
    EXPECT_GT(Json::parse(readFile(file("alone")))["packets"], 50);
}

TEST_F(Live, TwoSensorsAreOne) {
    auto live = startListening({"--sensor-pose", "0,0,1.8,0,0,0", "--beside", "127.0.0.1:23691=0,0,1.8,0,0,0"});
    const std::string first = endpoint_;
    std::thread other([&] {
        Program({VELODYNE_SEND, kStreet, "--to", "127.0.0.1:23691", "--duration", "2.5"}, file("sent2"), file("err2"))
            .wait();
    });
    send({"--duration", "2"});
    live->interrupt();
    EXPECT_EQ(live->wait(), 0) << err();
    other.join();
    const auto results = lines(out());
    ASSERT_GT(results.size(), 3u);
    int returns = 0;
    for (const Json& o : results[results.size() / 2]["obstacles"]) returns += o["num_points"].get<int>();
    EXPECT_GT(returns, 4000) << "a turn of one has some 3000 on obstacles";
    EXPECT_LT(statistics()["scans_missing_beside"], results.size() / 2);
    EXPECT_THAT(err(), HasSubstr("127.0.0.1:23691: data of a VLP-16"));
}

TEST_F(Live, TheTrackersTimeIsToldAsPartOfTheLatency) {
    auto live = startListening({"--standing-at", "0,0,0,0,0,0", "--to", "none"});
    send({"--duration", "1"});
    live->interrupt();
    ASSERT_EQ(live->wait(), 0) << err();
    const Json s = statistics();
    EXPECT_LE(s["tracking_ms"]["p50"], s["tracking_ms"]["p99"]);
    EXPECT_LT(s["tracking_ms"]["max"], s["latency_ms"]["max"]);
    EXPECT_THAT(err(), testing::HasSubstr("of it tracks "));
}

TEST_F(Live, ResultsAreServedToEveryClient) {
    std::vector<std::future<std::string>> texts;
    auto live = startListening({"--to", "none", "--serve", "127.0.0.1:0"});
    const std::string endpoint = waitFor("serving results on ");
    const auto port = static_cast<std::uint16_t>(std::stoi(endpoint.substr(endpoint.find(':') + 1)));
    std::vector<int> clients;
    for (int i = 0; i < 2; ++i) {
        clients.push_back(::socket(AF_INET, SOCK_STREAM, 0));
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(port);
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        ASSERT_EQ(connect(clients.back(), reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
    }
    const auto readAll = [](int client) {
        std::string text;
        char buffer[65536];
        for (ssize_t n; (n = read(client, buffer, sizeof buffer)) > 0;)
            text.append(buffer, static_cast<std::size_t>(n));
        close(client);
        return text;
    };
    for (const int client : clients) texts.push_back(std::async(std::launch::async, readAll, client));
    send({"--duration", "1.5"});
    live->interrupt();
    ASSERT_EQ(live->wait(), 0) << err();
    for (std::future<std::string>& text : texts) EXPECT_EQ(lines(text.get()).size(), statistics()["detected"]);
    EXPECT_EQ(out(), "");
    EXPECT_EQ(statistics()["clients_cut_off"], 0);
}

TEST_F(Live, ASecondSensorIsForeignAndToldOnce) {
    auto live = startListening({"--source", "127.0.0.1"});
    std::thread other([&] {
        Program({VELODYNE_SEND, kStreet, "--to", endpoint_, "--from", "127.0.0.2", "--duration", "1"}, file("sent2"),
                file("err2"))
            .wait();
    });
    const Json sent = send({"--duration", "1.5"});
    other.join();
    live->interrupt();
    ASSERT_EQ(live->wait(), 0) << err();
    EXPECT_EQ(statistics()["packets"], sent["packets"]);
    EXPECT_EQ(statistics()["foreign"], Json::parse(readFile(file("sent2")))["packets"]);
    const std::string text = err();
    const auto first = text.find("another sensor from 127.0.0.2");
    ASSERT_NE(first, std::string::npos);
    EXPECT_EQ(text.find("another sensor", first + 10), std::string::npos) << "told once";
}

TEST_F(Live, AFloodOfGarbageDoesNotGrowMemory) {
    auto live = startListening({});
    send({"--duration", "1"});
    const long before = live->residentKb();
    const int plug = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(endpoint_.substr(endpoint_.find(':') + 1))));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    std::string bytes(1206, '\xa5');
    for (int i = 0; i < 300'000; ++i) {
        bytes[static_cast<std::size_t>(i) % 1206] = static_cast<char>(i);
        const std::size_t size = i % 3 ? 1206 : static_cast<std::size_t>(i) % 1400 % 1206;
        sendto(plug, bytes.data(), size, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    }
    close(plug);
    const Json sent = send({"--duration", "1"});
    const long after = live->residentKb();
    live->interrupt();
    ASSERT_EQ(live->wait(), 0) << err();
    EXPECT_LT(after - before, 4096) << "kB";
    EXPECT_EQ(statistics()["malformed"].get<std::size_t>() + statistics()["overflows"].get<std::size_t>(), 300'000u);
    EXPECT_EQ(statistics()["restarts"], 1) << "the second sender's clock began anew";
    EXPECT_EQ(statistics()["packets"], 2 * sent["packets"].get<int>() - 2);
}

TEST_F(Live, SilenceAndARestartedSensorAreSurvived) {
    auto live = startListening({"--no-data", "0.5"});
    send({"--duration", "1"});
    std::this_thread::sleep_for(std::chrono::seconds(2));  // the sender's clock begins anew: a restart
    send({"--duration", "1"});
    live->interrupt();
    ASSERT_EQ(live->wait(), 0) << err();
    EXPECT_EQ(statistics()["restarts"], 1);
    EXPECT_EQ(statistics()["unclear"], 2);
    EXPECT_GE(statistics()["outages"], 1);
    EXPECT_THAT(err(), HasSubstr("no data for 0.5 s"));
    EXPECT_THAT(err(), HasSubstr("the sensor restarted"));
    EXPECT_GE(lines(out()).size() + statistics()["scans_dropped"].get<std::size_t>(), 20u);
}

}  // namespace
}  // namespace lidar_obstacles

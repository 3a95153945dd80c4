// obstacle-live and velodyne-send from end to end: each test runs the programs, over loopback.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "lidar_obstacles/static_map.h"
#include "support/capture_files.h"
#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

constexpr const char* kStreet = DATASETS "street_sample.rawlog";

/// A program that runs beside the test; killed if it still does at the end.
class Program {
  public:
    /// @param limit  size of files [byte]; 0: none.
    Program(std::vector<std::string> command, const std::string& out, const std::string& err, rlim_t limit = 0) {
        process_ = fork();
        if (process_ != 0) return;
        dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), STDOUT_FILENO);
        dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), STDERR_FILENO);
        if (limit > 0) {
            const rlimit files{limit, limit};
            signal(SIGXFSZ, SIG_IGN);
            setrlimit(RLIMIT_FSIZE, &files);
        }
        std::vector<char*> words;
        for (std::string& word : command) words.push_back(word.data());
        words.push_back(nullptr);
        setenv("ASAN_OPTIONS", "quarantine_size_mb=0", 1);  // what is freed is freed: memory is measured
        execv(words[0], words.data());
        _exit(127);
    }
    ~Program() {
        if (process_ <= 0) return;
        kill(process_, SIGKILL);
        wait();
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    void interrupt() const { kill(process_, SIGINT); }
    /// Its exit code; -1 if it was killed.
    int wait() {
        int status = -1;
        if (process_ > 0) waitpid(std::exchange(process_, 0), &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    /// Memory it has [kB].
    long residentKb() const {
        std::istringstream in(readFile("/proc/" + std::to_string(process_) + "/status"));
        for (std::string line; std::getline(in, line);)
            if (line.rfind("VmRSS:", 0) == 0) return std::stol(line.substr(6));
        return -1;
    }

  private:
    pid_t process_ = 0;
};

class Live : public testing::Test {
  protected:
    std::unique_ptr<Program> start(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), OBSTACLE_LIVE);
        arguments.insert(arguments.end(), {"--statistics", file("statistics.json"), "--report", "0"});
        writeFile(file("err"), "");
        return std::make_unique<Program>(arguments, file("out"), file("err"), limit_);
    }
    std::unique_ptr<Program> startListening(std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--listen", "127.0.0.1:0"});
        auto program = start(arguments);
        endpoint_ = waitFor("listening on ");
        return program;
    }
    /// The word after `mark` in what the program says.
    std::string waitFor(const std::string& mark) {
        for (int i = 0; i < 600; ++i) {
            const std::string text = err();
            const auto at = text.find(mark);
            if (at != std::string::npos && text.find('\n', at) != std::string::npos) {
                const auto begin = at + mark.size();
                return text.substr(begin, text.find_first_of(" ,\n", begin) - begin);
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        ADD_FAILURE() << "no '" << mark << "' in: " << err();
        return "";
    }
    Json send(std::vector<std::string> arguments) {
        const std::vector<std::string> first{VELODYNE_SEND, kStreet, "--to", endpoint_};
        arguments.insert(arguments.begin(), first.begin(), first.end());
        EXPECT_EQ(Program(arguments, file("sent"), file("send_err")).wait(), 0) << readFile(file("send_err"));
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        return Json::parse(readFile(file("sent")));
    }

    std::string file(const std::string& name) const { return folder_.file(name); }
    std::string err() const { return readFile(file("err")); }
    std::string out() const { return readFile(file("out")); }
    Json statistics() const { return Json::parse(readFile(file("statistics.json"))); }
    std::vector<Json> lines(const std::string& text) const {
        std::vector<Json> all;
        std::istringstream in(text);
        for (std::string line; std::getline(in, line);) all.push_back(Json::parse(line));
        return all;
    }

    TempFolder folder_;
    std::string endpoint_;
    rlim_t limit_ = 0;
};

TEST_F(Live, AnInterruptEndsItCleanlyWithCompleteFiles) {
    auto live = startListening({"--record", file("drive.rawlog")});
    std::thread sender([&] { send({"--duration", "3"}); });
    std::this_thread::sleep_for(std::chrono::milliseconds(2050));  // within a scan
    live->interrupt();
    EXPECT_EQ(live->wait(), 0) << err();
    sender.join();
    const auto results = lines(out());  // every line is whole
    EXPECT_GT(results.size(), 5u);
    EXPECT_EQ(statistics()["recorded"], results.size());
    const auto source = openScanSource(file("drive.rawlog"));
    std::size_t scans = 0;
    while (const auto item = source->next()) {
        const double time = mrpt::Clock::toDouble(item->observation->timestamp);
        EXPECT_NEAR(results.at(scans)["timestamp"].get<double>(), time, 2e-6);
        EXPECT_EQ(results.at(scans)["scan_index"], scans);
        ++scans;
    }
    EXPECT_EQ(source->status(), SourceStatus::End) << source->message();
    EXPECT_EQ(scans, results.size());
}

TEST_F(Live, TheStreetsCarsAreFoundInEveryWholeScan) {
    auto live = startListening({"--sensor-pose", "0,0,1.8,0,0,0"});
    send({"--duration", "2"});
    live->interrupt();
    ASSERT_EQ(live->wait(), 0) << err();
    const auto results = lines(out());
    ASSERT_GT(results.size(), 10u);
    for (std::size_t k = 1; k + 1 < results.size(); ++k) {
        int vehicles = 0;
        for (const Json& o : results[k]["obstacles"]) vehicles += o["class"] == "vehicle";
        EXPECT_GE(vehicles, 3) << k;
        EXPECT_GT(results[k]["latency_ms"].get<double>(), 0.0);
    }
}

TEST_F(Live, ResultsAreServedToEveryClient) {
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
    send({"--duration", "1.5"});
    live->interrupt();
    ASSERT_EQ(live->wait(), 0) << err();
    for (const int client : clients) {
        std::string text;
        char buffer[65536];
        for (ssize_t n; (n = read(client, buffer, sizeof buffer)) > 0;)
            text.append(buffer, static_cast<std::size_t>(n));
        close(client);
        EXPECT_EQ(lines(text).size(), statistics()["detected"]);
    }
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
    EXPECT_GE(lines(out()).size(), 20u);
}

TEST_F(Live, ACaptureAtFullSpeedIsTakenWhole) {
    Turn turn;
    turn.packets = 750;  // ten turns
    CaptureFile capture;
    capture.add(makeScan(turn, wallAt(10.0)), 1000.0);
    writeFile(file("capture.pcap"), capture.content());
    auto live = start({file("capture.pcap"), "--speed", "max", "--cut-azimuth", "0"});
    EXPECT_EQ(live->wait(), 0) << err();
    EXPECT_EQ(lines(out()).size(), 10u);
    EXPECT_EQ(statistics()["packets"], 750);
    EXPECT_EQ(statistics()["lost"], 0);
    EXPECT_EQ(statistics()["scans_dropped"], 0);
}

TEST_F(Live, WithoutPosesItSaysOnceWhatItDoesWithout) {
    auto live = startListening({"--set", "octomap.mode=spurious", "--set", "grid.scans=2"});
    send({"--duration", "1"});
    live->interrupt();
    ASSERT_EQ(live->wait(), 0) << err();
    EXPECT_GT(lines(out()).size(), 5u);
    const std::string text = err();
    const auto first = text.find("no poses are known: scans are not de-skewed, a grid holds one scan, the 3D filter");
    ASSERT_NE(first, std::string::npos) << text;
    EXPECT_EQ(text.find("no poses", first + 10), std::string::npos) << "told once";
}

/// Flat ground 1.8 m below the sensor and the rear of a van 10 m ahead.
double vanAhead(double azimuth, double elevation) {
    const double forward = std::cos(azimuth) * std::cos(elevation);
    const double rear = forward > 0.0 ? 10.0 / forward : 1e9;
    const double across = rear * std::sin(azimuth) * std::cos(elevation);
    const double up = rear * std::sin(elevation);
    if (std::abs(across) < 0.95 && up > -1.8 && up < 0.3) return rear;
    return elevation < -0.02 ? -1.8 / std::sin(elevation) : 0.0;
}

TEST_F(Live, AVehicleThatStandsInAMapSeesOnlyWhatIsNotInIt) {
    Turn turns;
    turns.packets = 225;  // three of them
    const VelodyneScan scan = makeScan(turns, vanAhead);
    CaptureFile capture;
    capture.add(scan, 1000.0);
    writeFile(file("capture.pcap"), capture.content());
    StaticMapBuilder map(0.2, 40.0);
    map.insert(toPointCloud(scan, SensorParams{}), Eigen::Isometry3d::Identity());
    map.save(file("map.bt"));
    const std::vector<std::string> common{
        file("capture.pcap"),           "--speed", "max", "--set", "octomap.mode=static", "--set",
        "octomap.map=" + file("map.bt")};
    EXPECT_EQ(start(common)->wait(), 0) << err();
    EXPECT_GE(statistics()["obstacles"], 3) << "where it stands is not known";
    EXPECT_THAT(err(), HasSubstr("no poses are known: the map of what stands still is not used"));
    std::vector<std::string> standing = common;
    standing.insert(standing.end(), {"--standing-at", "0,0,0,0,0,0"});
    EXPECT_EQ(start(standing)->wait(), 0) << err();
    EXPECT_EQ(statistics()["obstacles"], 0);
    EXPECT_THAT(err(), Not(HasSubstr("no poses")));
    EXPECT_GE(statistics()["detected"], 3);
}

TEST_F(Live, AReaderThatWentAwayIsAnErrorAndTheRecordingIsComplete) {
    ASSERT_EQ(mkfifo(file("out").c_str(), 0600), 0);
    std::thread reader([&] {
        char byte = 0;
        const int pipe = open(file("out").c_str(), O_RDONLY);
        EXPECT_EQ(read(pipe, &byte, 1), 1);
        close(pipe);
    });
    auto live = startListening({"--record", file("drive.rawlog")});
    send({"--duration", "2"});
    reader.join();
    EXPECT_EQ(live->wait(), 1) << "by itself";
    EXPECT_THAT(err(), HasSubstr("cannot write to the standard output"));
    const auto source = openScanSource(file("drive.rawlog"));
    EXPECT_TRUE(source->next());
}

TEST_F(Live, AFullDiskEndsTheRecordingAndIsTold) {
    limit_ = 60'000;  // bytes of a file: two or three scans
    auto live = startListening({"--record", file("drive.rawlog"), "--to", "none"});
    send({"--duration", "2"});
    EXPECT_THAT(err(), HasSubstr(file("drive.rawlog") + ": cannot write: File too large; the recording ends here"));
    live->interrupt();
    EXPECT_EQ(live->wait(), 1);
    EXPECT_GE(statistics()["detected"], 20) << "the run goes on";
    EXPECT_GE(statistics()["recorded"], 1);
    const auto source = openScanSource(file("drive.rawlog"));
    std::size_t scans = 0;
    while (source->next()) ++scans;
    EXPECT_EQ(source->status(), SourceStatus::End) << source->message();
    EXPECT_EQ(scans, statistics()["recorded"]);
}

TEST_F(Live, WhatIsWrongWithTheCommandLineIsSaid) {
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{"--listen", "localhost"}, "not an IPv4 address"},
        {{"--source", "1.2.3"}, "not an IPv4 address"},
        {{"--sensor-pose", "1,2,3"}, "X,Y,Z,YAW,PITCH,ROLL"},
        {{"--serve", "127.0.0.1"}, ":PORT"},
        {{"--standing-at", "1,2"}, "--standing-at 1,2"},
        {{"a.pcap", "--listen", "127.0.0.1"}, "either"},
        {{"--set", "grid.resolution=x"}, "grid"},
        {{"--config", "/nonexistent.ini"}, "/nonexistent.ini"},
        {{"--speed", "fast"}, "--speed"},
    };
    for (const auto& [arguments, message] : cases) {
        EXPECT_EQ(start(arguments)->wait(), 2) << arguments[0];
        EXPECT_THAT(err(), HasSubstr(message));
    }
    EXPECT_EQ(start({"/nonexistent.pcap"})->wait(), 1);
    EXPECT_THAT(err(), HasSubstr("/nonexistent.pcap"));
    EXPECT_EQ(start({"--set", "octomap.mode=static", "--set", "octomap.map=/nonexistent.bt"})->wait(), 1);
    EXPECT_THAT(err(), HasSubstr("/nonexistent.bt: cannot open the map"));
    EXPECT_EQ(start({"--record", "/nonexistent/drive.rawlog", "--listen", "127.0.0.1:0"})->wait(), 1);
    EXPECT_THAT(err(), HasSubstr("/nonexistent/drive.rawlog"));
}

}  // namespace
}  // namespace lidar_obstacles

// SPDX-License-Identifier: BSD-3-Clause
// Clients of obstacle-live --serve: what they get, what they may ask, what they cannot do to it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <set>
#include <thread>

#include "lidar_obstacles/detector.h"
#include "support/line_client.h"
#include "support/live_program.h"

namespace lidar_obstacles::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kEverything =
    R"({"subscribe": ["health", "obstacles", "tracks", "structure", "points", "virtual_scan", "grid", "low"]})";

/// A vehicle that stands on a street, and a sensor that sends until the test ends.
class Clients : public Live {
  protected:
    void serve(std::vector<std::string> arguments = {}, const std::string& place = "127.0.0.1:0") {
        const std::vector<std::string> usual{"--to",          "none",        "--sensor-pose", "0,0,1.8,0,0,0",
                                             "--standing-at", "0,0,0,0,0,0", "--serve",       place};
        arguments.insert(arguments.end(), usual.begin(), usual.end());
        live_ = startListening(arguments);
        place_ = waitFor("serving results on ");
    }
    void beginToSend(const std::string& seconds = "60") {
        sender_ = std::make_unique<Program>(
            std::vector<std::string>{VELODYNE_SEND, kStreet, "--to", endpoint_, "--duration", seconds}, file("sent"),
            file("send_err"));
    }
    Json end() {
        live_->interrupt();
        EXPECT_EQ(live_->wait(), 0) << err();
        return statistics();
    }

    std::unique_ptr<Program> live_, sender_;
    std::string place_;
};

TEST_F(Clients, GetThePartsTheyAskFor) {
    serve();
    LineClient all(place_), silent(place_), usual(place_);
    EXPECT_EQ(all.ask(kEverything), "");
    EXPECT_EQ(silent.ask(R"({"subscribe": []})"), "");
    beginToSend();
    Json scan;
    for (int i = 0; i < 8; ++i) scan = all.next("scan_index");
    EXPECT_GT(scan["latency_ms"], 0.0);
    EXPECT_FALSE(scan.contains("zones"));
    EXPECT_GE(scan["tracks"].size(), 3u);
    for (const Json& o : scan["tracks"]) EXPECT_TRUE(o["class"] != "structure" && o.contains("velocity"));
    ASSERT_GE(scan["structure"].size(), 1u);
    for (const Json& o : scan["structure"]) EXPECT_EQ(o["class"], "structure");
    std::size_t scraps = 0;
    for (const Json& o : scan["obstacles"])
        scraps += o["class"] == "unknown" && o["id"].get<int>() >= kFirstUntrackedId ? 1 : 0;
    EXPECT_EQ(scan["obstacles"].size(), scan["structure"].size() + scan["tracks"].size() + scraps);
    EXPECT_EQ(scan["points"].size() % 3, 0u);
    EXPECT_GT(scan["points"].size(), 3000u);
    const Json& around = scan["virtual_scan"];
    ASSERT_EQ(around["ranges"].size(), 720u);
    EXPECT_NEAR(around["angle_min"].get<double>() + 719.5 * around["angle_increment"].get<double>(), 3.14159, 1e-4);
    EXPECT_TRUE(scan["low"].is_array());
    const Json& grid = scan["grid"];
    int cells = 0;
    std::set<int> states;
    for (const Json& run : grid["runs"]) {
        states.insert(run[0].get<int>());
        cells += run[1].get<int>();
    }
    EXPECT_EQ(cells, grid["width"].get<int>() * grid["height"].get<int>());
    EXPECT_EQ(states, (std::set<int>{0, 1, 2}));
    scan = usual.next("obstacles");
    EXPECT_TRUE(scan.contains("health"));
    EXPECT_FALSE(scan.contains("tracks") || scan.contains("grid"));
    silent.send("{\"subscribe\": [\"grid\"]}\n");
    EXPECT_TRUE(Json::parse(silent.line().value()).contains("ok")) << "and nothing before";
    EXPECT_TRUE(silent.next("grid").contains("timestamp"));
    EXPECT_EQ(end()["clients"], 3);
}

TEST_F(Clients, AreToldWhatWasExpected) {
    serve();
    LineClient client(place_);
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"hello", "expected a line of JSON with one key"},
        {"[]", "expected a line of JSON with one key"},
        {"{}", "expected a line of JSON with one key"},
        {R"({"detection": "stop", "detection": "start"})", "with one key"},
        {std::string(60000, '['), "expected a line of JSON"},
        {"{\"\xff\": 1}", "expected a line of JSON"},
        {R"({"subscribed": []})", R"(unknown request "subscribed" (did you mean "subscribe"?); expected)"},
        {R"({"subscribe": "grid"})", "subscribe: expected a list of zones, health, obstacles, tracks, structure"},
        {R"({"subscribe": [1]})", "subscribe: expected a list"},
        {R"({"subscribe": ["tracks", "gird"]})",
         R"("gird" is not known (did you mean "grid"?); expected some of zones)"},
        {R"({"subscribe": ["zones"]})", "runs without --zones"},
        {R"({"detection": "halt"})", R"(expected "start" or "stop")"},
        {R"({"set": {"grid.resolution": 1}})", R"(set: expected a list of "SECTION.KEY=VALUE")"},
        {R"({"set": []})", "at least one"},
        {R"({"set": ["grid.resolution=0,2"]})", "[grid] resolution = 0,2: "},
        {R"({"set": ["grid.resolutoin=0.2"]})", "resolution"},
        {R"({"set": ["grid.scans=2", "grid.resolution=-1"]})", "[grid] resolution = -1"},
        {R"({"set": ["sensor.planes=8"]})", "once a scan has come"},
        {R"({"set": ["ego.source=matching"]})", "without --poses and --standing-at"},
        {R"({"set": ["octomap.mode=static", "octomap.map=/nonexistent.bt"]})", "/nonexistent.bt"},
        {R"({"pose": {"x": 1}})", "a pose needs a number \"timestamp\""},
        {R"({"pose": )" + std::string(30000, '[') + std::string(30000, ']') + "}", "a pose is a line of JSON"},
    };
    for (const auto& [request, message] : cases) EXPECT_THAT(client.ask(request), HasSubstr(message)) << request;
    EXPECT_EQ(client.ask(R"({"subscribe": ["grid"]})"), "") << "it is still served";
    EXPECT_THAT(LineClient(place_).ask("POST / HTTP/1.1\r\n\r\n{\"detection\": \"stop\"}"), HasSubstr("expected"));
    LineClient browser(place_);
    browser.send("POST / HTTP/1.1\r\nHost: x\r\n\r\n{\"detection\": \"stop\"}\n");
    EXPECT_TRUE(browser.line());
    EXPECT_FALSE(browser.line()) << "its connection is closed";
    LineClient endless(place_);
    endless.send(std::string(70000, 'x'));
    EXPECT_THAT(endless.line().value_or(""), HasSubstr("65536 bytes at most"));
    EXPECT_FALSE(endless.line());
    const Json s = end();
    EXPECT_EQ(s["requests_refused"], cases.size() + 3);
    EXPECT_EQ(s["requests"], cases.size() + 4);
    EXPECT_THAT(err(), testing::Not(HasSubstr("a client")));
}

TEST_F(Clients, StopStartAndChangeParameters) {
    serve();
    LineClient client(place_);
    beginToSend();
    ASSERT_EQ(client.ask(R"({"subscribe": ["tracks", "grid"]})"), "");
    Json scan = client.next("tracks");
    for (int i = 0; i < 5; ++i) scan = client.next("tracks");
    std::set<int> ids;
    for (const Json& o : scan["tracks"]) ids.insert(o["id"].get<int>());
    const double cell = scan["grid"]["resolution"];
    EXPECT_THAT(client.ask(R"({"set": ["grid.fine_resolution=0.3", "sensor.planes=7"]})"),
                HasSubstr("[sensor] planes = 7 does not divide"));
    EXPECT_EQ(client.next("grid")["grid"]["resolution"], cell) << "nothing was changed";
    EXPECT_EQ(client.ask(R"({"set": ["pipeline.algorithm=16-plane", "grid.resolution=0.45"]})"), "");
    scan = client.next("grid");
    EXPECT_EQ(scan["grid"]["resolution"], 0.45);
    for (const Json& o : scan["tracks"]) EXPECT_EQ(ids.count(o["id"].get<int>()), 0u) << "no id is used again";
    ASSERT_EQ(client.ask(R"({"subscribe": ["tracks", "structure"]})"), "");
    EXPECT_EQ(client.ask(R"({"set": ["grid.resolution=0.4"]})"), "");
    scan = client.next("structure");
    ASSERT_FALSE(scan["tracks"].empty() || scan["structure"].empty());
    for (const Json& o : scan["tracks"]) EXPECT_LT(o["id"].get<int>(), kFirstUntrackedId);
    for (const Json& o : scan["structure"]) {
        if (o.contains("age")) continue;  // followed, and found to be structure
        EXPECT_GE(o["id"].get<int>(), kFirstUntrackedId);
        EXPECT_LT(o["id"].get<int>(), kFirstUntrackedId + 10000) << "it begins anew in each scan";
    }
    ASSERT_EQ(client.ask(R"({"subscribe": ["tracks", "grid"]})"), "");
    EXPECT_EQ(client.ask(R"({"detection": "stop"})"), "");
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    client.send("{\"detection\": \"start\"}\n");
    int waiting = 0;
    for (Json line; !line.contains("ok"); ++waiting) line = Json::parse(client.line().value());
    EXPECT_EQ(waiting, 1) << "no results while it stood";
    EXPECT_TRUE(client.next("tracks").contains("timestamp"));
    EXPECT_GE(end()["scans_not_searched"], 2);
    EXPECT_THAT(err(), HasSubstr("a client changed grid.resolution=0.45"));
    EXPECT_THAT(err(), HasSubstr("a client stopped it"));
}

TEST_F(Clients, ZonesAreUnknownWhileDetectionStands) {
    serve({"--zones", PRESETS "zones.yaml"});
    LineClient client(place_);
    beginToSend();
    ASSERT_EQ(client.ask(R"({"subscribe": ["zones"]})"), "");
    EXPECT_EQ(client.next("zones")["zones"].size(), 4u);
    ASSERT_EQ(client.ask(R"({"detection": "stop"})"), "");
    const Json line = client.next("zones");
    EXPECT_EQ(line["zones"][0]["reason"], "no_scan");
    EXPECT_TRUE(line["scan_index"].is_null());
    end();
}

TEST_F(Clients, OneAtATimeGivesCommands) {
    serve();
    {
        LineClient first(place_), second(place_);
        EXPECT_EQ(first.ask(R"({"detection": "start"})"), "");
        EXPECT_THAT(second.ask(R"({"detection": "stop"})"), HasSubstr("another client gives commands"));
        first.send("{\"pose\": {\"timestamp\": 5, \"x\": 0, \"y\": 0, \"yaw\": 0}}\n");  // no answer
        first.sayNoMore();
        std::string answer = "another";
        for (int i = 0; i < 100 && answer.find("another") == 0; ++i) answer = second.ask(R"({"detection": "start"})");
        EXPECT_EQ(answer, "");
    }
    beginToSend("1");
    EXPECT_TRUE(LineClient(place_).next("obstacles").contains("timestamp"));
    EXPECT_EQ(end()["poses_of_clients"], 1);
}

TEST_F(Clients, CommandsCanBeForbidden) {
    serve({"--commands", "none"});
    EXPECT_THAT(LineClient(place_).ask(R"({"detection": "stop"})"), HasSubstr("not taken from here"));
    EXPECT_EQ(LineClient(place_).ask(R"({"subscribe": ["tracks"]})"), "");
    end();
    EXPECT_EQ(start({"--commands", "none"})->wait(), 2);
    EXPECT_THAT(err(), HasSubstr("--commands needs --serve"));
}

TEST_F(Clients, OfAUnixSocketAreServedToo) {
    const std::string path = file("live.sock");
    serve({}, path);
    struct stat info{};
    ASSERT_EQ(::stat(path.c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777U, 0660U) << "nobody else's";
    EXPECT_EQ(LineClient(path).ask(R"({"detection": "start"})"), "");
    beginToSend();
    Program client({"/usr/bin/env", "python3", LIVE_CLIENT_PY, path, "tracks", "grid"}, file("client"),
                   file("client_err"));
    Program wrong({"/usr/bin/env", "python3", LIVE_CLIENT_PY, path, "boxes"}, file("wrong"), file("wrong_err"));
    EXPECT_EQ(wrong.wait(), 1);
    EXPECT_THAT(readFile(file("wrong_err")), HasSubstr("\"boxes\" is not known"));
    for (int i = 0; i < 400 && readFile(file("client")).empty(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    Program second({OBSTACLE_LIVE, "--listen", "127.0.0.1:0", "--serve", path}, file("out2"), file("err2"));
    EXPECT_EQ(second.wait(), 1);
    EXPECT_THAT(readFile(file("err2")), HasSubstr(path + ": cannot listen: Address already in use"));
    live_->interrupt(SIGKILL);
    live_->wait();
    EXPECT_EQ(client.wait(), 0) << readFile(file("client_err"));
    EXPECT_THAT(readFile(file("client")), HasSubstr(" tracks: "));
    serve({}, path);  // the socket that was left behind is no hindrance
    EXPECT_TRUE(LineClient(path).isConnected());
    end();
    EXPECT_NE(::stat(path.c_str(), &info), 0) << "taken away";
}

TEST_F(Clients, TheExampleInCppReadsTracksAndGivesACommand) {
    serve();
    beginToSend();
    LineClient(place_).next("obstacles");
    Program client(
        {LIVE_CLIENT, "127.0.0.1", place_.substr(place_.find(':') + 1), R"({"set": ["sensor.max_range=60"]})"},
        file("client"), file("client_err"));
    for (int i = 0; i < 400 && readFile(file("client")).find("vehicle") == std::string::npos; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    end();
    EXPECT_EQ(client.wait(), 0) << readFile(file("client_err"));
    EXPECT_THAT(readFile(file("client")), StartsWith("nearest "));
    EXPECT_THAT(readFile(file("client")), HasSubstr("; vehicle "));
    EXPECT_THAT(err(), HasSubstr("a client changed sensor.max_range=60"));
}

TEST_F(Clients, AHundredThatNeverReadCostNoMemoryAndNoLine) {
    serve();
    beginToSend();
    LineClient good(place_);
    ASSERT_EQ(good.ask(R"({"subscribe": ["health"]})"), "");
    for (int i = 0; i < 3; ++i) good.next("health");
    const long before = live_->residentKb();
    std::vector<std::unique_ptr<LineClient>> deaf;
    for (int i = 0; i < 100; ++i) {
        deaf.push_back(std::make_unique<LineClient>(place_, 4096));
        deaf.back()->send(std::string(kEverything) + "\n");
    }
    long most = before;
    int last = good.next("health")["scan_index"], missed = 0;
    for (int i = 0; i < 60; ++i) {
        const Json scan = good.next("health");
        ASSERT_TRUE(scan.contains("scan_index"));
        missed += scan["scan_index"].get<int>() - last - 1;
        last = scan["scan_index"];
        most = std::max(most, live_->residentKb());
    }
    const Json s = end();
    EXPECT_LE(missed, s["scans_dropped"]) << "only what the detector was too slow for";
    EXPECT_EQ(s["clients_cut_off"], 100);
    EXPECT_LT(most - before, 40 * 1024) << "kB: 16 lines for all of them";
    EXPECT_THAT(err(), HasSubstr("100 clients cut off"));
}

TEST_F(Clients, AreRefusedWhereThereAreTooMany) {
    serve();
    std::vector<std::unique_ptr<LineClient>> many;
    for (int i = 0; i < 256; ++i) many.push_back(std::make_unique<LineClient>(place_));
    EXPECT_EQ(many.back()->ask(R"({"subscribe": []})"), "");
    EXPECT_THAT(LineClient(place_).line().value_or(""), HasSubstr("256 clients"));
    many.clear();
    for (int i = 0; i < 100 && LineClient(place_).ask(R"({"subscribe": []})") != ""; ++i) {
    }
    EXPECT_EQ(LineClient(place_).ask(R"({"subscribe": []})"), "") << "there is room again";
    EXPECT_GE(end()["clients_refused"], 1);
}

}  // namespace
}  // namespace lidar_obstacles::test

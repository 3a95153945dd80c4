// SPDX-License-Identifier: BSD-3-Clause
// Parts of obstacle-live by themselves: a client whose request fails, the server, the time without scans.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/streambuf.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <functional>
#include <istream>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "obstacle-live/client.h"
#include "obstacle-live/scan_silence.h"
#include "support/line_client.h"

namespace lidar_obstacles::apps {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A server that cannot do what it is asked for.
class FailingHost final : public ClientHost {
  public:
    void subscribed() override {}
    void gone(Client&, bool) override { ++gone_; }
    bool give(Client&, const Request&) override { throw std::runtime_error("no room is left"); }
    void ended(Client&) override {}
    void countRequest(bool error) override { errors_ += error ? 1 : 0; }
    void failed(const std::string& why) override { failures_.push_back(why); }
    bool hasZones() const override { return false; }

    int gone_ = 0, errors_ = 0;
    std::vector<std::string> failures_;
};

TEST(AClient, WhoseRequestFailsIsToldAndServedOn) {
    using Socket = boost::asio::local::stream_protocol::socket;
    boost::asio::io_context io;
    Socket ours(io), theirs(io);
    boost::asio::local::connect_pair(ours, theirs);
    FailingHost host;
    std::make_shared<Client>(Client::Socket(std::move(ours)), host, true)->start();
    boost::asio::streambuf got;
    std::istream lines(&got);
    const auto ask = [&](const std::string& request) {
        boost::asio::write(theirs, boost::asio::buffer(request + "\n"));
        for (int k = 0; k < 10; ++k) io.poll();
        boost::asio::read_until(theirs, got, '\n');
        std::string line;
        std::getline(lines, line);
        return line;
    };
    EXPECT_THAT(ask(R"({"detection": "stop"})"), HasSubstr(R"({"error":"the request failed: no room is left")"));
    EXPECT_THAT(host.failures_, ElementsAre("no room is left"));
    EXPECT_THAT(ask("hello"), HasSubstr("expected a line of JSON"));
    EXPECT_EQ(host.failures_.size(), 1U) << "a fault of the client's own";
    EXPECT_THAT(ask(R"({"subscribe": ["tracks"]})"), HasSubstr("ok"));
    EXPECT_EQ(host.errors_, 2);
    EXPECT_EQ(host.gone_, 0);
}

TEST(TheServer, AnswersWhateverACommandThrowsAndGoesOn) {
    ServeOptions options;
    options.tcp.port = 0;
    ClientServer server(options);
    test::LineClient client(server.place());
    const auto ask = [&](const std::function<void(const Request&)>& execute) {
        std::string answer;
        std::atomic<bool> answered{false};
        std::thread asking([&] {
            answer = client.ask(R"({"detection": "stop"})");
            answered = true;
        });
        while (!answered) {
            server.obey(execute);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        asking.join();
        return answer;
    };
    EXPECT_EQ(ask([](const Request&) { throw std::invalid_argument("not now"); }), "not now");
    EXPECT_EQ(ask([](const Request&) { throw std::runtime_error("no such file"); }), "no such file");
    EXPECT_THAT(server.takeReports(), IsEmpty()) << "these are refusals";
    EXPECT_THAT(ask([](const Request&) { throw std::bad_alloc(); }), HasSubstr("the request failed: "));
    EXPECT_THAT(server.takeReports(), ElementsAre(HasSubstr("bad_alloc")));
    EXPECT_THAT(server.takeReports(), IsEmpty()) << "told once";
    EXPECT_EQ(ask([](const Request&) {}), "");
}

TEST(Silence, IsToldAgainAndAgainByTheStampsOfTheScans) {
    ScanSilence silence(100.0);  // by the steady clock
    silence.end(110.0, 5000.0);
    EXPECT_EQ(silence.tell(110.3, 9000.0), std::nullopt);
    EXPECT_EQ(silence.tell(110.5, 9000.0), 5000.5) << "whatever the clock of the system was set to meanwhile";
    EXPECT_EQ(silence.tell(110.8, 9000.0), std::nullopt);
    EXPECT_EQ(silence.tell(111.0, 1000.0), 5001.0);
    silence.end(111.1, 5001.1);
    EXPECT_EQ(silence.tell(111.4, 9000.0), std::nullopt);
}

TEST(Silence, BeforeTheFirstScanIsStampedByTheClockIfAtAll) {
    ScanSilence silence(100.0);
    EXPECT_EQ(silence.tell(100.3, 7000.3), std::nullopt);
    EXPECT_EQ(silence.tell(100.5, std::nullopt), std::nullopt) << "a capture";
    EXPECT_EQ(silence.tell(100.5, 7000.5), 7000.5);
}

}  // namespace
}  // namespace lidar_obstacles::apps

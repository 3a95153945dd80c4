// SPDX-License-Identifier: BSD-3-Clause
// obstacle-live beside a test.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "support/program.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::test {

using Json = nlohmann::json;

inline constexpr const char* kStreet = DATASETS "street_sample.rawlog";

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

}  // namespace lidar_obstacles::test

// obstacle-live beside a test.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "support/temp_folder.h"

namespace lidar_obstacles::test {

using Json = nlohmann::json;

inline constexpr const char* kStreet = DATASETS "street_sample.rawlog";

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

}  // namespace lidar_obstacles::test

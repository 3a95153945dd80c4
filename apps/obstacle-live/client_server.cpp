// SPDX-License-Identifier: BSD-3-Clause
#include "client_server.h"

#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <deque>
#include <future>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include "client.h"
#include "common/message_of.h"

namespace lidar_obstacles::apps {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using Unix = asio::local::stream_protocol;

constexpr int kSendBuffer = 256 * 1024;  // of each client, in the kernel [byte]

/// A socket of a program that was killed is left behind: taken away, unless somebody listens.
void removeLeftBehind(const std::string& path, asio::io_context& io) {
    struct stat info{};
    if (::lstat(path.c_str(), &info) != 0 || !S_ISSOCK(info.st_mode)) return;  // another file: bind() fails
    Unix::socket probe(io);
    error_code error;
    probe.connect(Unix::endpoint(path), error);
    if (error == asio::error::connection_refused) ::unlink(path.c_str());
}

template <class Protocol>
typename Protocol::acceptor listenAt(asio::io_context& io, const typename Protocol::endpoint& place,
                                     const std::string& name) {
    try {
        typename Protocol::acceptor acceptor(io);
        acceptor.open(place.protocol());
        acceptor.set_option(asio::socket_base::reuse_address(true));
        acceptor.bind(place);
        acceptor.listen();
        return acceptor;
    } catch (const boost::system::system_error& e) {
        throw std::runtime_error(name + ": cannot listen: " + e.code().message());
    }
}

/// For its user and group alone.
Unix::acceptor listenAtPath(asio::io_context& io, const std::string& path) {
    constexpr std::size_t kLongest = 107;  // of the system
    if (path.size() > kLongest)
        throw std::runtime_error(path + ": the name of a socket has " + std::to_string(kLongest) + " bytes at most");
    removeLeftBehind(path, io);
    const mode_t before = ::umask(0117);
    try {
        auto acceptor = listenAt<Unix>(io, Unix::endpoint(path), path);
        ::umask(before);
        return acceptor;
    } catch (...) {
        ::umask(before);
        throw;
    }
}

bool isLocal(const tcp::socket& socket) {
    error_code error;
    return socket.remote_endpoint(error).address().is_loopback() && !error;
}
bool isLocal(const Unix::socket&) { return true; }

}  // namespace

class ClientServer::Impl final : private ClientHost {
  public:
    explicit Impl(const ServeOptions& options) : options_(options), retry_(io_) {
        if (options.path.empty()) {
            const tcp::endpoint place(asio::ip::address_v4(options.tcp.address), options.tcp.port);
            tcp_ = listenAt<tcp>(io_, place, "TCP " + toString(options.tcp));
            options_.tcp.port = tcp_->local_endpoint().port();
            accept(*tcp_);
        } else {
            unix_ = listenAtPath(io_, options.path);
            accept(*unix_);
        }
        ended_ = std::async(std::launch::async, [this] { serve(); });
    }
    ~Impl() {
        finish();
        if (unix_) ::unlink(options_.path.c_str());
    }

    std::string place() const { return options_.path.empty() ? toString(options_.tcp) : options_.path; }
    Parts wanted() const { return Parts(wanted_); }

    void publish(Message message) {
        auto shared = std::make_shared<const Message>(std::move(message));
        asio::post(io_, [this, shared = std::move(shared)] {
            const auto clients = clients_;  // those that are cut off leave the set
            for (const auto& client : clients) client->send(shared);
        });
    }

    void obey(const std::function<void(const Request&)>& execute) {
        for (const Command& command : taken(commands_)) {
            std::string error;
            try {
                execute(command.request);
            } catch (const std::invalid_argument& e) {
                error = e.what();
            } catch (const std::runtime_error& e) {
                error = e.what();
            } catch (const std::exception& e) {
                failed(messageOf(e));
                error = kFailed + messageOf(e);
            }
            asio::post(io_, [client = command.client, error] { client->resume(error); });
        }
    }

    void takePoses(const std::function<void(const StampedPose&)>& take) {
        for (const StampedPose& pose : taken(poses_)) take(pose);
    }

    void finish() {
        if (!ended_.valid()) return;
        asio::post(io_, [this] {
            stopAccepting();
            const auto clients = clients_;
            for (const auto& client : clients) client->finish();
        });
        if (ended_.wait_for(std::chrono::milliseconds(500)) != std::future_status::ready) io_.stop();
        ended_.get();
        count([this](ClientCounts& c) { c.cut_off += clients_.size(); });  // they did not take what they were sent
        clients_.clear();
    }

    ClientCounts counts() const {
        const std::lock_guard lock(mutex_);
        return counts_;
    }
    std::vector<std::string> takeReports() { return taken(reports_); }

  private:
    struct Command {
        std::shared_ptr<Client> client;
        Request request;
    };

    /// What one client makes fail is no end for the others.
    void serve() {
        while (!io_.stopped()) {
            try {
                io_.run();
            } catch (const std::exception& e) {
                failed(messageOf(e));
            }
        }
    }

    template <class Queue>
    Queue taken(Queue& queue) {
        const std::lock_guard lock(mutex_);
        return std::exchange(queue, {});
    }

    template <class Acceptor>
    void accept(Acceptor& acceptor) {
        acceptor.async_accept([this, &acceptor](const error_code& error, auto socket) {
            if (!acceptor.is_open()) return;
            if (!error) {
                accept(acceptor);
                return welcome(std::move(socket));
            }
            retry_.expires_after(std::chrono::milliseconds(100));  // e.g. no file numbers are left
            retry_.async_wait([this, &acceptor](const error_code& stopped) {
                if (!stopped) accept(acceptor);
            });
        });
    }

    template <class Socket>
    void welcome(Socket socket) {
        error_code ignored;
        const bool too_many = clients_.size() >= kMaxClients;
        count([&](ClientCounts& c) { ++(too_many ? c.refused : c.clients); });
        if (too_many) {
            socket.non_blocking(true, ignored);
            const std::string text =
                errorLine("there are " + std::to_string(kMaxClients) + " clients, more are not served", "");
            socket.send(asio::buffer(text), 0, ignored);
            return;
        }
        socket.set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
        const bool is_local = isLocal(socket);
        ClientHost& host = *this;
        auto client = std::make_shared<Client>(Client::Socket(std::move(socket)), host, is_local);
        clients_.insert(client);
        subscribed();
        client->start();
    }

    void stopAccepting() {
        error_code ignored;
        if (tcp_) tcp_->close(ignored);
        if (unix_) unix_->close(ignored);
        retry_.cancel();
    }

    void subscribed() override {
        Parts all;
        for (const auto& client : clients_) all |= client->parts();
        wanted_ = all.to_ulong();
    }

    void gone(Client& client, bool cut_off) override {
        count([&](ClientCounts& c) { c.cut_off += cut_off ? 1 : 0; });
        ended(client);
        clients_.erase(client.shared_from_this());
        subscribed();
    }

    void ended(Client& client) override {
        if (commander_ == &client) commander_ = nullptr;
    }

    bool give(Client& client, const Request& request) override {
        const bool may =
            options_.commanders == Commanders::All || (options_.commanders == Commanders::Local && client.isLocal());
        if (!may) throw std::invalid_argument("commands are not taken from here, see --commands");
        if (commander_ != nullptr && commander_ != &client)
            throw std::invalid_argument("another client gives commands; it is one at a time, until that one goes");
        commander_ = &client;
        const std::lock_guard lock(mutex_);
        if (const auto* given = std::get_if<GivePose>(&request)) {
            poses_.push_back(given->pose);
            if (poses_.size() > kMaxPoses) poses_.pop_front();
            return true;
        }
        commands_.push_back({client.shared_from_this(), request});
        return false;
    }

    void countRequest(bool error) override {
        count([&](ClientCounts& c) {
            ++c.requests;
            c.errors += error ? 1 : 0;
        });
    }

    void failed(const std::string& why) override {
        const std::lock_guard lock(mutex_);
        if (reports_.size() < kMaxReports) reports_.push_back("what a client asked for failed: " + why);
    }

    bool hasZones() const override { return options_.zones; }

    template <class Change>
    void count(const Change& change) {
        const std::lock_guard lock(mutex_);
        change(counts_);
    }

    ServeOptions options_;
    asio::io_context io_;
    asio::steady_timer retry_;
    std::optional<tcp::acceptor> tcp_;
    std::optional<Unix::acceptor> unix_;
    std::set<std::shared_ptr<Client>> clients_;  // of the thread
    const Client* commander_ = nullptr;          // of the thread
    std::atomic<unsigned long> wanted_{0};
    mutable std::mutex mutex_;  ///< of the next four
    ClientCounts counts_;
    std::deque<Command> commands_;  ///< one of a client at most
    std::deque<StampedPose> poses_;
    std::vector<std::string> reports_;
    std::future<void> ended_;
};

ClientServer::ClientServer(const ServeOptions& options) : impl_(std::make_unique<Impl>(options)) {}
ClientServer::~ClientServer() = default;
std::string ClientServer::place() const { return impl_->place(); }
Parts ClientServer::wanted() const { return impl_->wanted(); }
void ClientServer::publish(Message message) { impl_->publish(std::move(message)); }
void ClientServer::obey(const std::function<void(const Request&)>& execute) { impl_->obey(execute); }
void ClientServer::takePoses(const std::function<void(const StampedPose&)>& take) { impl_->takePoses(take); }
void ClientServer::finish() { impl_->finish(); }
ClientCounts ClientServer::counts() const { return impl_->counts(); }
std::vector<std::string> ClientServer::takeReports() { return impl_->takeReports(); }

}  // namespace lidar_obstacles::apps

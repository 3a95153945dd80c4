// SPDX-License-Identifier: BSD-3-Clause
#include "client.h"

#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <istream>
#include <stdexcept>
#include <vector>

#include "common/message_of.h"

namespace lidar_obstacles::apps {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

constexpr std::size_t kPause = ClientServer::kMaxWaiting / 4;  // answers that wait before more requests are read

}  // namespace

void Client::read() {
    asio::async_read_until(socket_, in_, '\n', [self = shared_from_this()](const error_code& error, std::size_t n) {
        if (self->closed_) return;
        std::string line;
        std::istream in(&self->in_);
        if (!error) {
            line.resize(n);
            in.read(line.data(), static_cast<std::streamsize>(n));
            line.pop_back();
            self->takeLine(line);
        } else if (error == asio::error::not_found) {  // the buffer is full
            self->leaving_ = true;
            self->answer("a line has " + std::to_string(ClientServer::kMaxRequest) + " bytes at most", "");
        } else if (error == asio::error::eof) {
            self->ended_ = true;
            if (std::getline(in, line)) self->takeLine(line);  // without an end
            if (self->request_.empty()) self->readOn();
        } else {
            self->close(false);
        }
    });
}

void Client::takeLine(const std::string& line) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) return readOn();
    try {
        handle(line);
    } catch (const std::invalid_argument& e) {
        leaving_ = leaving_ || isHttp(line);
        answer(e.what(), line);
    } catch (const std::exception& e) {
        host_.failed(messageOf(e));
        answer(kFailed + messageOf(e), line);
    }
}

/// @throws std::invalid_argument if it is not right.
void Client::handle(const std::string& line) {
    const Request request = parseRequest(line);
    if (const auto* subscribe = std::get_if<Subscribe>(&request)) {
        if (has(subscribe->parts, Part::Zones) && !host_.hasZones())
            throw std::invalid_argument("subscribe: there are no zones: obstacle-live runs without --zones");
        parts_ = subscribe->parts;
        host_.subscribed();
        return answer("", line);
    }
    const bool done = host_.give(*this, request);
    if (done) {  // a pose: no answer, there are many
        host_.countRequest(false);
        return readOn();
    }
    request_ = line;
}

void Client::resume(const std::string& error) {
    if (!closed_) answer(error, std::exchange(request_, {}));
}

void Client::answer(const std::string& error, const std::string& request) {
    host_.countRequest(!error.empty());
    push({nullptr, {}, error.empty() ? okLine(request) : errorLine(error, request)});
    readOn();
}

void Client::readOn() {
    if (closed_ || leaving_) return;
    if (ended_) {
        host_.ended(*this);
        leaving_ = parts_.none();  // it neither asks nor listens
        if (leaving_ && out_.empty()) close(false);
        return;
    }
    paused_ = out_.size() >= kPause;
    if (!paused_) read();
}

void Client::send(const std::shared_ptr<const Message>& message) {
    if (leaving_ || (parts_ & message->parts()).none()) return;
    push({message, parts_, {}});
}

void Client::push(Waiting waiting) {
    if (closed_) return;
    if (out_.size() >= ClientServer::kMaxWaiting) return close(true);
    out_.push_back(std::move(waiting));
    if (!writing_) write();
}

void Client::write() {
    writing_ = true;
    const Waiting& first = out_.front();
    std::vector<asio::const_buffer> buffers;
    if (first.message) {
        buffers.reserve(kPartCount + 2);
        buffers.push_back(asio::buffer(first.message->head));
        for (std::size_t k = 0; k < kPartCount; ++k)
            if (first.parts.test(k) && first.message->text.at(k))
                buffers.push_back(asio::buffer(*first.message->text[k]));
        buffers.push_back(asio::buffer(Message::kTail, 2));
    } else {
        buffers.push_back(asio::buffer(first.text));
    }
    asio::async_write(socket_, buffers, [self = shared_from_this()](const error_code& error, std::size_t) {
        if (self->closed_) return;
        error ? self->close(false) : self->written();
    });
}

void Client::written() {
    writing_ = false;
    out_.pop_front();
    if (!out_.empty()) {
        write();
    } else if (leaving_) {
        return close(false);
    }
    if (paused_ && out_.size() < kPause) readOn();
}

void Client::finish() {
    leaving_ = true;
    if (out_.empty()) close(false);
}

void Client::close(bool cut_off) {
    if (closed_) return;
    closed_ = true;
    error_code ignored;
    socket_.shutdown(Socket::shutdown_both, ignored);
    socket_.close(ignored);
    host_.gone(*this, cut_off);
}

}  // namespace lidar_obstacles::apps

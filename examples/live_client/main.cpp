// SPDX-License-Identifier: BSD-3-Clause
// A client of obstacle-live --serve: says what is followed, and how far away the nearest return is all around.
//
//     obstacle-live --serve 127.0.0.1:5000 --to none
//     live_client 127.0.0.1 5000
//     live_client 127.0.0.1 5000 '{"set": ["sensor.max_range=60"]}'     # a command first
#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/streambuf.hpp>
#include <boost/asio/write.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

namespace asio = boost::asio;
using asio::ip::tcp;
using Json = nlohmann::json;

namespace {

void show(const Json& scan) {
    double nearest = scan["virtual_scan"]["range_max"];
    for (const Json& range : scan["virtual_scan"]["ranges"])
        if (!range.is_null()) nearest = std::min(nearest, range.get<double>());  // null: nothing in this direction
    std::cout << "nearest " << nearest << " m";
    for (const Json& track : scan["tracks"])
        std::cout << "; " << track["class"].get<std::string>() << ' ' << track["id"] << " at " << track["x"] << ", "
                  << track["y"];
    std::cout << std::endl;
}

int run(const std::string& address, const std::string& port, const std::string& command) {
    asio::io_context io;
    tcp::socket socket(io);
    asio::connect(socket, tcp::resolver(io).resolve(address, port));
    const Json subscribe = {{"subscribe", {"tracks", "virtual_scan"}}};
    asio::write(socket, asio::buffer((command.empty() ? "" : command + '\n') + subscribe.dump() + '\n'));
    asio::streambuf buffer;
    boost::system::error_code error;
    while (asio::read_until(socket, buffer, '\n', error) > 0) {
        std::istream in(&buffer);
        std::string line;
        std::getline(in, line);
        const Json json = Json::parse(line);
        if (json.contains("error")) std::cerr << json["error"].get<std::string>() << '\n';
        if (json.contains("error")) return 1;
        if (json.contains("virtual_scan")) show(json);
    }
    return error == asio::error::eof ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc != 3 && argc != 4) throw std::invalid_argument("usage: live_client ADDRESS PORT [COMMAND]");
    return run(argv[1], argv[2], argc == 4 ? argv[3] : "");
} catch (const std::exception& e) {
    std::cerr << "live_client: " << e.what() << '\n';
    return 1;
}

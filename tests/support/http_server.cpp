#include "tests/support/http_server.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/temporary_folder.h"

namespace reljef::test {
namespace {

std::string request_from(int connection) {
    std::string request;
    std::array<char, 4096> part{};
    while (request.find("\r\n\r\n") == std::string::npos) {
        const auto count = ::recv(connection, part.data(), part.size(), 0);
        if (count <= 0) {
            break;
        }
        request.append(part.data(), static_cast<std::size_t>(count));
    }
    return request;
}

void send_all(int connection, std::string_view bytes) {
    while (!bytes.empty()) {
        const auto count = ::send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (count <= 0) {
            return;
        }
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
}

/// The bytes asked for, first and last; all of them where no range is named.
struct Range {
    std::size_t first = 0;
    std::size_t last = 0;
    bool is_part = false;
};

Range range_of(const std::string& request, std::size_t size) {
    Range range{0, size - 1, false};
    const auto at = request.find("Range: bytes=");
    if (at == std::string::npos) {
        return range;
    }
    unsigned long first = 0;
    unsigned long last = size - 1;
    const int read = std::sscanf(request.c_str() + at, "Range: bytes=%lu-%lu", &first, &last);
    return read < 1 ? range : Range{first, std::min<std::size_t>(last, size - 1), true};
}

std::string header(const Range& range, std::size_t size, std::size_t length) {
    std::string text = range.is_part ? "HTTP/1.1 206 Partial Content\r\n" : "HTTP/1.1 200 OK\r\n";
    text += "Accept-Ranges: bytes\r\nConnection: close\r\n";
    text += "Content-Length: " + std::to_string(length) + "\r\n";
    if (range.is_part) {
        text += "Content-Range: bytes " + std::to_string(range.first) + "-" +
                std::to_string(range.last) + "/" + std::to_string(size) + "\r\n";
    }
    return text + "\r\n";
}

constexpr std::string_view not_found_answer =
    "HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
constexpr std::string_view error_answer =
    "HTTP/1.1 500 Internal Server Error\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";

} // namespace

HttpServer::HttpServer(std::filesystem::path folder)
    : folder_(std::move(folder)), socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    socklen_t length = sizeof(address);
    const bool listens = socket_ >= 0 && ::bind(socket_, generic, length) == 0 &&
                         ::listen(socket_, 64) == 0 &&
                         ::getsockname(socket_, generic, &length) == 0;
    if (!listens) {
        std::perror("a port on the loopback was expected");
        std::abort();
    }
    port_ = ntohs(address.sin_port);
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

HttpServer::~HttpServer() {
    thread_.request_stop();
    thread_.join();
    for (const int connection : stalled_) {
        ::close(connection);
    }
    ::close(socket_);
}

std::string HttpServer::url(const std::string& name) const {
    return "http://127.0.0.1:" + std::to_string(port_) + "/" + name;
}

void HttpServer::serve(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        pollfd waiting{socket_, POLLIN, 0};
        if (::poll(&waiting, 1, 20) <= 0) {
            continue;
        }
        const int connection = ::accept(socket_, nullptr, nullptr);
        if (connection >= 0) {
            ++requests_;
            std::this_thread::sleep_for(std::chrono::milliseconds(delay_));
            if (answer(connection)) {
                ::close(connection);
            } else {
                stalled_.push_back(connection);
            }
        }
    }
}

bool HttpServer::answer(int connection) {
    const std::string request = request_from(connection);
    const auto begin = request.find('/') + 1;
    const std::string name = request.substr(begin, request.find(' ', begin) - begin);
    std::error_code ignored;
    const bool is_file = std::filesystem::is_regular_file(folder_ / name, ignored);
    const std::string bytes = is_file ? read_bytes(folder_ / name) : "";
    const Range range = range_of(request, bytes.size());
    const Fault fault = range.first >= first_byte_ ? fault_.load() : Fault::none;
    if (bytes.empty() || fault == Fault::not_found) {
        send_all(connection, not_found_answer);
        return true;
    }
    if (fault == Fault::stalled) {
        return false;
    }
    if (fault == Fault::server_error) {
        send_all(connection, error_answer);
        return true;
    }
    const std::size_t length = range.last - range.first + 1;
    send_all(connection,
             header(range, bytes.size(), fault == Fault::lying_length ? length + 100000 : length));
    if (!request.starts_with("HEAD")) {
        const std::size_t sent = fault == Fault::cut ? length / 2 : length;
        send_all(connection, std::string_view(bytes).substr(range.first, sent));
    }
    return true;
}

} // namespace reljef::test

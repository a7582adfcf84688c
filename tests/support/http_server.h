#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace reljef::test {

/// Serves the files of a folder on the loopback, ranges too, one request after the other, and as
/// badly as it is told to.
class HttpServer {
public:
    enum class Fault { none, not_found, server_error, cut, lying_length, stalled };

    /// Aborts where there is no port to listen on.
    explicit HttpServer(std::filesystem::path folder);
    ~HttpServer();
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    [[nodiscard]] std::string url(const std::string& name) const;
    /// Of all answers, or of those about bytes of a file from one on.
    void set_fault(Fault fault, std::size_t first_byte = 0) {
        first_byte_ = first_byte;
        fault_ = fault;
    }
    /// Before each answer, milliseconds.
    void set_delay(int milliseconds) { delay_ = milliseconds; }
    [[nodiscard]] int requests() const { return requests_; }

private:
    void serve(const std::stop_token& stop);
    /// False: the connection stays open without an answer.
    bool answer(int connection);

    std::filesystem::path folder_;
    int socket_ = -1;
    int port_ = 0;
    std::atomic<Fault> fault_{Fault::none};
    std::atomic<std::size_t> first_byte_{0};
    std::atomic<int> delay_{0};
    std::atomic<int> requests_{0};
    std::vector<int> stalled_; // connections
    std::jthread thread_;
};

} // namespace reljef::test

#include "tests/support/nginx.h"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <thread>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace reljef::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* program = "/usr/sbin/nginx";
constexpr std::chrono::minutes longest_start{1};

std::string configuration(const fs::path& root, int port, const std::string& rules) {
    return "daemon off;\nmaster_process off;\npid nginx.pid;\nerror_log error.log;\n"
           "events { worker_connections 256; }\n"
           "http {\n"
           "  log_format sent $body_bytes_sent;\n"
           "  access_log access.log sent;\n"
           "  client_body_temp_path body;\n  proxy_temp_path proxy;\n"
           "  fastcgi_temp_path fastcgi;\n  uwsgi_temp_path uwsgi;\n  scgi_temp_path scgi;\n"
           "  default_type application/octet-stream;\n"
           "  server {\n"
           "    listen 127.0.0.1:" +
           std::to_string(port) + " reuseport;\n    root " + root.string() + ";\n" + rules +
           "\n  }\n}\n";
}

[[noreturn]] void become_nginx(const char* const* arguments) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL); // it does not outlive a test that crashes
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr); // the program's interrupts are blocked for all
    ::execv(program, const_cast<char* const*>(arguments));
    ::_exit(127);
}

} // namespace

bool Nginx::is_installed() {
    return ::access(program, X_OK) == 0;
}

Nginx::Nginx(fs::path root, const std::string& rules)
    : root_(std::move(root)), socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    socklen_t length = sizeof(address);
    const int shared = 1;
    const bool has_port =
        socket_ >= 0 &&
        ::setsockopt(socket_, SOL_SOCKET, SO_REUSEPORT, &shared, sizeof(shared)) == 0 &&
        ::bind(socket_, generic, length) == 0 && ::getsockname(socket_, generic, &length) == 0;
    if (!has_port) {
        std::perror("a port on the loopback was expected");
        std::abort();
    }
    port_ = ntohs(address.sin_port);
    start(rules);
}

Nginx::~Nginx() {
    stop();
    ::close(socket_);
}

void Nginx::serve_by(const std::string& rules) {
    stop();
    start(rules);
}

void Nginx::start(const std::string& rules) {
    own_.write("nginx.conf", configuration(root_, port_, rules));
    const std::string folder = own_.path().string() + "/";
    const std::string log = folder + "error.log";
    const std::array arguments{
        program,      "-p", folder.c_str(), "-c",
        "nginx.conf", "-e", log.c_str(),    static_cast<const char*>(nullptr)};
    process_ = ::fork();
    if (process_ == 0) {
        become_nginx(arguments.data());
    }
    const auto deadline = std::chrono::steady_clock::now() + longest_start;
    while (read_bytes(own_.path() / "nginx.pid").empty()) {
        const bool ended = process_ < 0 || ::waitpid(process_, nullptr, WNOHANG) != 0;
        if (ended || std::chrono::steady_clock::now() > deadline) {
            std::fprintf(stderr, "nginx does not serve: %s\n", read_bytes(log).c_str());
            std::abort();
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

void Nginx::stop() {
    ::kill(process_, SIGKILL); // a gentler signal may come just before it waits, and is not seen
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
    std::error_code ignored;
    fs::remove(own_.path() / "nginx.pid", ignored);
}

std::string Nginx::url(const std::string& name) const {
    return "http://127.0.0.1:" + std::to_string(port_) + "/" + name;
}

std::size_t Nginx::bytes_sent() const {
    std::size_t sum = 0;
    std::istringstream log(read_bytes(own_.path() / "access.log"));
    for (std::size_t bytes = 0; log >> bytes;) {
        sum += bytes;
    }
    return sum;
}

} // namespace reljef::test

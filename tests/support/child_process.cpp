#include "tests/support/child_process.h"

#include <chrono>
#include <csignal>
#include <string_view>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace reljef::test {
namespace {

void read_some(pollfd& source, std::string& text) {
    if (source.fd < 0 || source.revents == 0) {
        return;
    }
    std::array<char, 65536> buffer{};
    const ssize_t count = ::read(source.fd, buffer.data(), buffer.size());
    if (count > 0) {
        text.append(buffer.data(), static_cast<std::size_t>(count));
    } else {
        source.fd = -1; // poll() leaves it out from now on
    }
}

} // namespace

Pipe::Pipe() {
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
        ends = {-1, -1};
    }
}

Pipe::~Pipe() {
    close_end(0);
    close_end(1);
}

void Pipe::close_end(std::size_t end) {
    if (ends[end] >= 0) {
        ::close(ends[end]);
        ends[end] = -1;
    }
}

std::vector<std::string>
environment_with(const std::map<std::string, std::optional<std::string>>& changes) {
    std::vector<std::string> result;
    for (char** entry = ::environ; *entry != nullptr; ++entry) {
        const std::string_view text = *entry;
        const std::string name(text.substr(0, text.find('=')));
        // This process may have set it to a folder that is gone (session::set_driver_cache).
        if (!changes.contains(name) && name != "MESA_SHADER_CACHE_DIR") {
            result.emplace_back(text);
        }
    }
    for (const auto& [name, value] : changes) {
        if (value) {
            result.push_back(name + "=" + *value);
        }
    }
    return result;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
    std::vector<char*> result;
    for (std::string& text : texts) {
        result.push_back(text.data());
    }
    result.push_back(nullptr);
    return result;
}

void read_all(const Pipe& out, const Pipe& err, int process, const ProgramOptions& options,
              ProgramResult& result) {
    constexpr int pause = 10; // ms, from look to look
    const auto deadline = std::chrono::steady_clock::now() + options.timeout;
    bool interrupts = options.interruption.signal != 0;
    std::array<pollfd, 2> sources{pollfd{out.ends[0], POLLIN, 0}, pollfd{err.ends[0], POLLIN, 0}};
    while (sources[0].fd >= 0 || sources[1].fd >= 0) {
        if (std::chrono::steady_clock::now() > deadline) {
            result.timed_out = true;
            ::kill(-process, SIGKILL);
            return;
        }
        if (interrupts && options.interruption.when(process)) {
            ::kill(process, options.interruption.signal);
            interrupts = false;
        }
        if (::poll(sources.data(), sources.size(), interrupts ? pause : 100 * pause) > 0) {
            read_some(sources[0], result.out);
            read_some(sources[1], result.err);
        }
    }
}

int exit_code_of_status(int status) {
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

} // namespace reljef::test

#include "tests/support/test_program.h"

#include <array>
#include <csignal>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace reljef::test {
namespace {

using Clock = std::chrono::steady_clock;

struct Pipe {
    Pipe() {
        if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
            ends = {-1, -1};
        }
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    ~Pipe() {
        close_end(0);
        close_end(1);
    }
    void close_end(std::size_t end) {
        if (ends[end] >= 0) {
            ::close(ends[end]);
            ends[end] = -1;
        }
    }

    std::array<int, 2> ends{-1, -1}; // read, write
};

std::vector<std::string>
environment_with(const std::map<std::string, std::optional<std::string>>& changes) {
    std::vector<std::string> result;
    for (char** entry = ::environ; *entry != nullptr; ++entry) {
        const std::string_view text = *entry;
        if (!changes.contains(std::string(text.substr(0, text.find('='))))) {
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

// The process id, or -1 with the reason in `why`.
pid_t spawn(std::vector<std::string> arguments, const ProgramOptions& options, const Pipe& out,
            const Pipe& err, std::string& why) {
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, options.input.c_str(), O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, out.ends[1], STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions, err.ends[1], STDERR_FILENO);
    if (!options.folder.empty()) {
        ::posix_spawn_file_actions_addchdir_np(&actions, options.folder.c_str());
    }
    posix_spawnattr_t attributes;
    ::posix_spawnattr_init(&attributes);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    std::vector<std::string> environment = environment_with(options.environment);
    pid_t process = -1;
    const int failure =
        ::posix_spawn(&process, arguments.front().c_str(), &actions, &attributes,
                      pointers_to(arguments).data(), pointers_to(environment).data());
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) {
        why = std::strerror(failure);
        return -1;
    }
    return process;
}

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

// Reads both until the program has closed them; false when `deadline` came first.
bool read_all(const Pipe& out, const Pipe& err, ProgramResult& result, Clock::time_point deadline) {
    std::array<pollfd, 2> sources{pollfd{out.ends[0], POLLIN, 0}, pollfd{err.ends[0], POLLIN, 0}};
    while (sources[0].fd >= 0 || sources[1].fd >= 0) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
        if (left <= 0) {
            return false;
        }
        ::poll(sources.data(), sources.size(), static_cast<int>(left));
        read_some(sources[0], result.out);
        read_some(sources[1], result.err);
    }
    return true;
}

int exit_code_of(pid_t process) {
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

} // namespace

ProgramResult run_program(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments,
                          const ProgramOptions& options) {
    ProgramResult result;
    Pipe out;
    Pipe err;
    std::vector<std::string> all{std::filesystem::absolute(program).string()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const auto deadline = Clock::now() + options.timeout;
    const pid_t process = spawn(std::move(all), options, out, err, result.err);
    if (process < 0) {
        result.exit_code = 127;
        return result;
    }
    out.close_end(1);
    err.close_end(1);
    result.timed_out = !read_all(out, err, result, deadline);
    if (result.timed_out) {
        ::kill(-process, SIGKILL);
    }
    result.exit_code = exit_code_of(process);
    return result;
}

} // namespace reljef::test

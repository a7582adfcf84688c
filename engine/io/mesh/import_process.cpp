#include "engine/io/mesh/import_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/core/loading/program_part.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool limits_memory = false; // sanitizers reserve terabytes of addresses
#else
constexpr bool limits_memory = true;
#endif

constexpr const char* program_name = "reljef-mesh-import";

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&&) = delete;
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() { close(); }
    void close() {
        if (number_ >= 0) {
            ::close(std::exchange(number_, -1));
        }
    }
    [[nodiscard]] int number() const { return number_; }

private:
    int number_;
};

Error problem_of(const fs::path& file, const std::string& found) {
    return Error{fmt::format("{}: {}, an OBJ or glTF 2.0 file was expected", file.string(), found)};
}

Error no_process(const fs::path& file, int code) {
    return Error{fmt::format("{}: cannot be imported, the program {} does not start ({})",
                             file.string(), program_name,
                             std::error_code(code, std::generic_category()).message())};
}

// The child: standard output is the pipe, nothing else is open to it.
class Child {
public:
    static Result<Child> start(const fs::path& file, const ImportLimits& limits);
    Child(Child&& other) noexcept
        : process_(std::exchange(other.process_, 0)), answer_(std::move(other.answer_)) {}
    Child& operator=(Child&&) = delete;
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        if (process_ > 0) {
            ::kill(process_, SIGKILL);
            wait();
        }
    }
    [[nodiscard]] int answer() const { return answer_.number(); }
    // The status of waitpid().
    int wait() {
        int status = 0;
        while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
        }
        process_ = 0;
        return status;
    }

private:
    Child(pid_t process, Descriptor answer) : process_(process), answer_(std::move(answer)) {}

    pid_t process_;
    Descriptor answer_;
};

Result<Child> Child::start(const fs::path& file, const ImportLimits& limits) {
    std::array<int, 2> ends{-1, -1};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
        return no_process(file, errno);
    }
    Descriptor answer(ends[0]);
    const Descriptor written(ends[1]);
    const std::string program =
        (limits.program.empty() ? program_part(program_name) : limits.program).string();
    std::array<std::string, 4> words{program, fs::absolute(file).string(),
                                     std::to_string(limits.megabytes),
                                     std::to_string(limits.seconds)};
    std::array<char*, 5> arguments{words[0].data(), words[1].data(), words[2].data(),
                                   words[3].data(), nullptr};
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, written.number(), STDOUT_FILENO);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t process = 0;
    const int code =
        ::posix_spawn(&process, program.c_str(), &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    return code == 0 ? Result<Child>(Child(process, std::move(answer))) : no_process(file, code);
}

// All that the child writes until it ends.
Result<std::vector<std::byte>> read_answer(const Child& child, const fs::path& file,
                                           const ImportLimits& limits,
                                           const std::stop_token& stop) {
    const std::chrono::seconds longest(3 * limits.seconds);
    const auto deadline = Clock::now() + longest;
    constexpr int slice = 50; // milliseconds between looks at the stop
    std::vector<std::byte> answer;
    std::vector<std::byte> block(std::size_t{1} << 16U);
    while (true) {
        if (stop.stop_requested()) {
            return Error{fmt::format("{}: the import was stopped", file.string())};
        }
        if (Clock::now() >= deadline) {
            return problem_of(file, fmt::format("takes over {} s to import", longest.count()));
        }
        pollfd waiting{child.answer(), POLLIN, 0};
        if (::poll(&waiting, 1, slice) <= 0) {
            continue;
        }
        const ssize_t size = ::read(child.answer(), block.data(), block.size());
        if (size == 0) {
            return answer;
        }
        if (size < 0 && errno != EINTR) {
            return no_process(file, errno);
        }
        answer.insert(answer.end(), block.begin(), block.begin() + std::max<ssize_t>(size, 0));
        if (answer.size() > limits.max_answer) {
            return problem_of(file,
                              fmt::format("is a mesh of over {} MB", limits.max_answer >> 20U));
        }
    }
}

std::string text_of(const std::vector<std::byte>& answer) {
    constexpr std::size_t longest = 400;
    std::string text;
    for (std::size_t i = 0; i < std::min(answer.size(), longest); ++i) {
        const auto c = static_cast<char>(answer[i]);
        text += c >= ' ' && c <= '~' ? c : ' ';
    }
    return text;
}

} // namespace

Result<void> limit_this_process(int megabytes, int seconds) {
    const auto set = [](auto resource, rlim_t value, rlim_t more = 0) {
        const rlimit limit{value, value + more};
        return ::setrlimit(resource, &limit) == 0;
    };
    const rlim_t bytes = static_cast<rlim_t>(megabytes) << 20U;
    const bool done = set(RLIMIT_CORE, 0) && set(RLIMIT_CPU, static_cast<rlim_t>(seconds), 1) &&
                      set(RLIMIT_FSIZE, 0) && (!limits_memory || set(RLIMIT_AS, bytes));
    return done ? Result<void>() : Error{"cannot be imported within limits"};
}

Result<std::vector<std::byte>> run_import(const fs::path& file, const ImportLimits& limits,
                                          const std::stop_token& stop) {
    auto child = Child::start(file, limits);
    if (!child) {
        return child.error();
    }
    auto answer = read_answer(*child, file, limits, stop);
    if (!answer) {
        return answer;
    }
    const int status = child->wait();
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
        return answer;
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == import_failed) {
        return Error{fmt::format("{}: {}", file.string(), text_of(*answer))};
    }
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
        return problem_of(file, fmt::format("takes over {} s to import", limits.seconds));
    }
    return problem_of(
        file, WIFSIGNALED(status)
                  ? fmt::format("makes its importer crash (signal {})", WTERMSIG(status))
                  : fmt::format("makes its importer fail (status {})", WEXITSTATUS(status)));
}

} // namespace reljef::io

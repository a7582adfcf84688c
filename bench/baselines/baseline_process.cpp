#include "bench/baselines/baseline_process.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace reljef::bench {
namespace {

Result<pid_t> spawn_process(const std::filesystem::path& program,
                            const std::vector<std::string>& arguments, int channel) {
    const std::string name = program.string();
    std::vector<char*> argv{const_cast<char*>(name.c_str())};
    for (const std::string& argument : arguments) {
        argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, channel, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, channel, STDOUT_FILENO);
    pid_t process = -1;
    const int code = posix_spawn(&process, name.c_str(), &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (code != 0) {
        return Error{fmt::format("{}: did not start: {}", name, std::strerror(code))};
    }
    return process;
}

} // namespace

Result<BaselineProcess> BaselineProcess::start(const std::filesystem::path& program,
                                               const std::vector<std::string>& arguments) {
    std::array<int, 2> ends{}; // of a socket, because a broken pipe raises a signal
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
        return Error{
            fmt::format("{}: no channel to it: {}", program.string(), std::strerror(errno))};
    }
    auto process = spawn_process(program, arguments, ends[1]);
    ::close(ends[1]);
    if (!process) {
        ::close(ends[0]);
        return process.error();
    }
    BaselineProcess baseline(program.filename().string(), *process, ends[0],
                             ::fdopen(::dup(ends[0]), "r"));
    auto first = baseline.answer();
    if (!first) {
        return first.error();
    }
    return baseline;
}

BaselineProcess::BaselineProcess(std::string name, pid_t process, int input, std::FILE* output)
    : name_(std::move(name)), process_(process), input_(input), output_(output) {}

BaselineProcess::BaselineProcess(BaselineProcess&& other) noexcept
    : name_(std::move(other.name_)), process_(std::exchange(other.process_, -1)),
      input_(std::exchange(other.input_, -1)), output_(std::exchange(other.output_, nullptr)) {}

BaselineProcess::~BaselineProcess() {
    if (input_ >= 0) {
        ::shutdown(input_, SHUT_RDWR);
        ::close(input_);
    }
    if (output_ != nullptr) {
        static_cast<void>(std::fclose(output_));
    }
    if (process_ > 0) {
        ::waitpid(process_, nullptr, 0);
    }
}

Result<std::string> BaselineProcess::ask(const std::string& line) {
    const std::string whole = line + "\n";
    const auto sent = ::send(input_, whole.data(), whole.size(), MSG_NOSIGNAL);
    if (sent != static_cast<ssize_t>(whole.size())) {
        return Error{fmt::format("{}: it ended, an answer to '{}' was expected", name_, line)};
    }
    return answer();
}

Result<std::string> BaselineProcess::answer() {
    std::string line;
    for (int c = std::fgetc(output_); c != EOF && c != '\n'; c = std::fgetc(output_)) {
        line.push_back(static_cast<char>(c));
    }
    if (line.rfind("ok", 0) == 0) {
        return line.substr(std::min<std::size_t>(3, line.size()));
    }
    return Error{
        fmt::format("{}: {}", name_, line.empty() ? "it ended, an answer was expected" : line)};
}

} // namespace reljef::bench

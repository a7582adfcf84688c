#include "tests/support/test_program.h"

#include <cerrno>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/child_process.h"

namespace reljef::test {
namespace {

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
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
    sigset_t signals; // not ignored even where the tests run in the background
    ::sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        ::sigaddset(&signals, signal);
    }
    ::posix_spawnattr_setsigdefault(&attributes, &signals);
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

int exit_code_of(pid_t process) {
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return exit_code_of_status(status);
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
    const pid_t process = spawn(std::move(all), options, out, err, result.err);
    if (process < 0) {
        result.exit_code = 127;
        return result;
    }
    out.close_end(1);
    err.close_end(1);
    read_all(out, err, process, options, result);
    result.exit_code = exit_code_of(process);
    return result;
}

} // namespace reljef::test

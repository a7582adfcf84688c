#include "tests/support/forks/forked_program.h"

#include <array>
#include <cstdio>
#include <utility>

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace reljef::test {
namespace {

/// Begins before the first test, while this process has no threads but those of libraries.
class Server : public testing::Environment {
public:
    void SetUp() override {
        std::fflush(nullptr); // else each fork would write it again
        std::array<int, 2> ends{-1, -1};
        ASSERT_TRUE(make_fork_sockets(ends));
        process_ = ::fork();
        if (process_ == 0) {
            ::close(ends[0]);
            // What most of the programs open: each of the forks would link it anew.
            ::dlopen(RELJEF_PICTURES, RTLD_NOW | RTLD_LOCAL);
#ifndef __SANITIZE_ADDRESS__
            ::dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
#endif
            serve_forks(ends[1], nullptr);
        }
        ::close(ends[1]);
        socket_ = ends[0];
        ASSERT_GT(process_, 0);
    }
    void TearDown() override {
        ::close(socket_);
        ::waitpid(process_, nullptr, 0);
    }
    [[nodiscard]] int socket() const {
        return socket_;
    }

private:
    int socket_ = -1;
    pid_t process_ = -1;
};

Server& server() {
    static auto* const only = new Server; // GoogleTest's
    return *only;
}

[[maybe_unused]] testing::Environment* const registered =
    testing::AddGlobalTestEnvironment(&server());

} // namespace

ProgramResult run_forked(ProgramMain program, const std::string& name,
                         const std::vector<std::string>& arguments, const ProgramOptions& options) {
    std::vector<std::string> all{name};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run_fork(server().socket(), program, std::move(all), options);
}

} // namespace reljef::test

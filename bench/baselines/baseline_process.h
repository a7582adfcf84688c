#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

#include "engine/core/result.h"

namespace reljef::bench {

/// A child process that answers each line on its stdin with one line on its stdout.
class BaselineProcess {
public:
    /// Starts the program and waits for its first line. Fails as ask() does.
    static Result<BaselineProcess> start(const std::filesystem::path& program,
                                         const std::vector<std::string>& arguments);

    BaselineProcess(BaselineProcess&& other) noexcept;
    BaselineProcess& operator=(BaselineProcess&& other) = delete;
    /// Closes the channel and waits for the process to end.
    ~BaselineProcess();

    /// The answer after "ok". Fails with the answer "failed …", and if the process ended.
    Result<std::string> ask(const std::string& line);

private:
    BaselineProcess(std::string name, pid_t process, int input, std::FILE* output);

    Result<std::string> answer();

    std::string name_;
    pid_t process_;
    int input_;         // its stdin
    std::FILE* output_; // its stdout
};

} // namespace reljef::bench

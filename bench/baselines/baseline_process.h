#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <sys/types.h>

#include "engine/core/result.h"

namespace reljef::bench {

/// A program that is told lines on its stdin and answers each with one on its stdout.
class BaselineProcess {
public:
    /// Starts it and waits for its first line. Fails as ask() does, and where there is none.
    static Result<BaselineProcess> start(const std::filesystem::path& program,
                                         const std::vector<std::string>& arguments);

    BaselineProcess(BaselineProcess&& other) noexcept;
    BaselineProcess& operator=(BaselineProcess&& other) = delete;
    /// Asks it to end, and waits until it has.
    ~BaselineProcess();

    /// What follows "ok" in its answer. Fails with the sentence that follows "failed", and where it
    /// ended.
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

#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <sys/resource.h>

namespace reljef::test {

/// Bytes of this process that are in memory (VmRSS).
std::size_t resident_bytes();
/// Files, sockets and the like that this process has open.
std::size_t open_files();

/// What the processor has done for a process so far, seconds; 0 where there is none. Of its threads
/// whose names begin so, or of all.
double processor_seconds(int process, const std::string& thread_name = "");

/// A variable of this process's environment for as long as this lives, then as it was: other tests
/// run in the same process.
class EnvironmentVariable {
public:
    EnvironmentVariable(std::string name, const std::string& value);
    ~EnvironmentVariable();
    EnvironmentVariable(const EnvironmentVariable&) = delete;
    EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

private:
    std::string name_;
    std::optional<std::string> before_;
};

/// No file of this process grows beyond so many bytes while this lives, as on a full disk.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes);
    ~FileSizeLimit();
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    void (*handler_)(int);
    rlimit before_{};
};

/// Whether memory freed is given back as usual: sanitizers keep it for a while to catch its use.
constexpr bool memory_is_plain() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return false;
#else
    return true;
#endif
}

} // namespace reljef::test

#include "app/cli/standard_input.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "app/cli/usage_error.h"

namespace reljef::cli {
namespace {

namespace fs = std::filesystem;

constexpr int poll_ms = 100; // how late Ctrl-C may be noticed

class TemporaryFolder {
public:
    TemporaryFolder() {
        std::error_code code;
        path_ = (fs::temp_directory_path(code) / "reljef-XXXXXX").string();
        is_made_ = !code && mkdtemp(path_.data()) != nullptr;
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        const int reason = errno; // why standard output was lost
        std::error_code ignored;
        if (is_made_) {
            fs::remove_all(path_, ignored);
        }
        errno = reason;
    }

    [[nodiscard]] bool is_made() const { return is_made_; }
    [[nodiscard]] fs::path path() const { return path_; }

private:
    std::string path_;
    bool is_made_ = false;
};

// The bytes that are there; none at the end.
Result<std::size_t> read_some(std::vector<char>& buffer, const std::stop_token& stop) {
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    int ready = 0;
    while (ready == 0 || (ready < 0 && errno == EINTR)) {
        if (stop.stop_requested()) {
            return Error{"interrupted"};
        }
        ready = ::poll(&input, 1, poll_ms);
    }
    const ssize_t count = ::read(STDIN_FILENO, buffer.data(), buffer.size());
    return count < 0 ? Result<std::size_t>(Error{
                           fmt::format("standard input: cannot be read: {}",
                                       std::error_code(errno, std::generic_category()).message())})
                     : static_cast<std::size_t>(count);
}

Result<void> copy_standard_input(const fs::path& path, const std::stop_token& stop) {
    std::ofstream file(path, std::ios::binary);
    std::vector<char> buffer(std::size_t{1} << 20);
    for (bool is_empty = true;; is_empty = false) {
        const auto count = read_some(buffer, stop);
        if (!count) {
            return count.error();
        }
        if (*count == 0) {
            return is_empty ? Error{"standard input: nothing found, a raster was expected"}
                            : Result<void>();
        }
        if (!file.write(buffer.data(), static_cast<std::streamsize>(*count)).flush()) {
            return Error{
                fmt::format("standard input: does not fit into {}", path.parent_path().string())};
        }
    }
}

} // namespace

Result<void> with_standard_input(std::string& terrain, const std::stop_token& stop,
                                 const std::function<Result<void>()>& run) {
    if (terrain != "-") {
        return run();
    }
    if (isatty(STDIN_FILENO) != 0) {
        fail_usage("TERRAIN: - found, and standard input is a terminal; a pipe or a file was "
                   "expected");
    }
    const TemporaryFolder folder;
    if (!folder.is_made()) {
        return Error{
            "standard input: no folder for temporary files found (TMPDIR), one that can be "
            "written was expected"};
    }
    const fs::path path = folder.path() / "standard input";
    if (auto copied = copy_standard_input(path, stop); !copied) {
        return copied;
    }
    terrain = path.string();
    auto done = run();
    terrain = "-";
    if (done) {
        return done;
    }
    Error error = done.error();
    for (auto at = error.message.find(path.string()); at != std::string::npos;
         at = error.message.find(path.string())) {
        error.message.replace(at, path.string().size(), "standard input");
    }
    return error;
}

} // namespace reljef::cli

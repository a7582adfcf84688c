#include "app/cli/standard_input.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "app/cli/usage_error.h"
#include "engine/core/atomic_file.h"

namespace reljef::cli {
namespace {

namespace fs = std::filesystem;

constexpr int poll_ms = 100; // how late Ctrl-C may be noticed

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

// Why the bytes of a file in one of GDAL's formats are no raster without the file's name, or empty.
std::string_view needed_name(const fs::path& path) {
    std::array<char, 4> start{};
    std::ifstream(path, std::ios::binary).read(start.data(), start.size());
    const std::string_view magic(start.data(), start.size());
    if (magic == "PK\3\4" || magic.starts_with("\x1f\x8b")) {
        return "a .zip or .gz file found, which is read by its name";
    }
    constexpr std::array<std::uintmax_t, 3> sample_counts{1201 * 1201, 3601 * 1801, 3601 * 3601};
    std::error_code ignored;
    const bool may_be_hgt = std::any_of(
        sample_counts.begin(), sample_counts.end(),
        [bytes = fs::file_size(path, ignored)](auto count) { return bytes == 2 * count; });
    return may_be_hgt ? "an .hgt file found, whose name tells its place" : "";
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
    const auto folder = ScratchFolder::create();
    if (!folder) {
        return Error{
            "standard input: no folder for temporary files found (TMPDIR), one that can be "
            "written was expected"};
    }
    const fs::path path = folder->path() / "standard input";
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
    const std::string_view reason = needed_name(path);
    if (!reason.empty() && error.message.starts_with("standard input: ")) {
        error.message = fmt::format("standard input: {}; give it as a file, not as -", reason);
    }
    return error;
}

} // namespace reljef::cli

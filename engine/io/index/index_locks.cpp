// How processes share the file of an index.
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>

#include "engine/io/cache/cache_file.h"
#include "engine/io/index/error_index.h"

namespace reljef::io {
namespace fs = std::filesystem;

namespace {

Result<Descriptor> opened_to_write(const fs::path& path) {
    auto file = open_cache_file(path, CacheAccess::write);
    if (!file) {
        return file.error();
    }
    return *file ? Result<Descriptor>(std::move(**file))
                 : Error{fmt::format("{}: cannot be written: {}", path.string(),
                                     std::strerror(ENOENT))};
}

/// Whether a file is still the one of its path: another process may have removed it meanwhile.
bool is_in_place(const fs::path& path, const Descriptor& file) {
    struct stat named {};
    struct stat opened {};
    return ::stat(path.c_str(), &named) == 0 && ::fstat(file.number(), &opened) == 0 &&
           named.st_ino == opened.st_ino && named.st_dev == opened.st_dev;
}

} // namespace

bool ErrorIndex::has_begun() {
    std::string found(header(true).size(), '\0');
    static_cast<void>(read_at(0, std::as_writable_bytes(std::span(found))));
    is_complete_ = found == header(true);
    return is_complete_ || found == header(false);
}

// A complete index with damaged parts lacks what its coarser levels were made of.
Result<void> ErrorIndex::begin() {
    return has_begun() && (!is_complete_ || (has_all_parts() && has_all_heights())) ? Result<void>()
                                                                                    : clear();
}

// A lock is given back before the other one is taken: of all processes, the last gets it.
bool ErrorIndex::claim() {
    return ::flock(file_.number(), LOCK_EX | LOCK_NB) == 0 && is_in_place(path_, file_) &&
           has_begun();
}

Result<bool> ErrorIndex::lock(IndexAccess access) {
    const int number = file_.number();
    const bool is_alone = ::flock(number, LOCK_EX | LOCK_NB) == 0;
    const bool is_locked =
        is_alone || (access == IndexAccess::shared && ::flock(number, LOCK_SH | LOCK_NB) == 0);
    if (!is_locked && errno != EWOULDBLOCK) {
        return error("locked");
    }
    if (!is_locked || !is_in_place(path_, file_)) {
        return false;
    }
    if (auto begun = is_alone ? begin() : Result<void>(); !begun) {
        return begun.error();
    }
    // Between the two locks another process may have it to itself.
    const bool is_kept =
        access != IndexAccess::shared || !is_alone || ::flock(number, LOCK_SH | LOCK_NB) == 0;
    return is_kept && has_begun();
}

Result<ErrorIndex> ErrorIndex::open_to_write(const IndexSource& source, IndexAccess access,
                                             const std::stop_token& stop,
                                             const std::function<void()>& on_wait) {
    constexpr std::chrono::milliseconds pause{20};
    constexpr int pauses_a_second = 50;
    for (int pauses = 0;; ++pauses) {
        auto file = opened_to_write(source.file);
        if (!file) {
            return file.error();
        }
        ErrorIndex index(source, std::move(*file));
        const auto locked = index.lock(access);
        if (!locked) {
            return locked.error();
        }
        if (*locked) {
            return index;
        }
        if (access == IndexAccess::alone || stop.stop_requested()) {
            return Error{fmt::format("{}: another process indexes {} now, none was expected",
                                     source.file.string(), source.tiles.name())};
        }
        if (pauses == pauses_a_second && on_wait) {
            on_wait();
        }
        std::this_thread::sleep_for(pause);
    }
}

} // namespace reljef::io

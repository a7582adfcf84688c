#include "engine/io/cache/cache_file.h"

#include <cerrno>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/core/atomic_file.h"

namespace reljef::io {
namespace fs = std::filesystem;
namespace {

Error unusable_file(const fs::path& path) {
    return {fmt::format("{}: cannot be used: {}", path.string(), std::strerror(errno))};
}

// Why a file or folder may hold what others wrote; empty if it does not.
std::string_view reason_for_distrust(const struct stat& status) {
    if (status.st_uid != ::geteuid()) {
        return "another user owns it";
    }
    // In a sticky folder only this user can replace this user's files.
    const bool is_sticky_folder = S_ISDIR(status.st_mode) && (status.st_mode & S_ISVTX) != 0;
    const bool is_open_to_others = (status.st_mode & (S_IWGRP | S_IWOTH)) != 0;
    return is_open_to_others && !is_sticky_folder ? "other users can write to it" : "";
}

// Absent if there is none.
Result<std::optional<Descriptor>> open_trusted(const fs::path& path, int folder, const char* name,
                                               int flags, struct stat& status) {
    constexpr mode_t owner_only = 0600;
    Descriptor opened(::openat(folder, name, flags | O_NONBLOCK | O_CLOEXEC, owner_only));
    if (!opened && errno == ENOENT) {
        return std::optional<Descriptor>();
    }
    if (!opened && errno == ELOOP) {
        return Error{fmt::format("{}: a link found, a file was expected", path.string())};
    }
    if (!opened || ::fstat(opened.number(), &status) != 0) {
        return unusable_file(path);
    }
    if (const std::string_view reason = reason_for_distrust(status); !reason.empty()) {
        return Error{fmt::format("{}: {}, one that only this user writes to was expected",
                                 path.string(), reason)};
    }
    return std::optional(std::move(opened));
}

Result<std::optional<Descriptor>> open_folder(const fs::path& folder) {
    struct stat status {};
    return open_trusted(folder, AT_FDCWD, folder.c_str(), O_RDONLY | O_DIRECTORY, status);
}

Result<std::optional<Descriptor>> open_file(const fs::path& path, struct stat& status,
                                            int flags = O_RDONLY) {
    auto folder = open_folder(path.parent_path());
    if (!folder || !*folder) {
        return folder;
    }
    auto file = open_trusted(path, (*folder)->number(), path.filename().c_str(), flags | O_NOFOLLOW,
                             status);
    if (file && *file && !S_ISREG(status.st_mode)) {
        return Error{fmt::format("{}: no regular file found, one was expected", path.string())};
    }
    return file;
}

void make_folder(const fs::path& folder) {
    constexpr mode_t owner_only = 0700;
    std::error_code ignored; // opening the file tells
    fs::create_directories(folder.parent_path(), ignored);
    ::mkdir(folder.c_str(), owner_only);
}

} // namespace

Result<std::optional<Descriptor>> open_cache_file(const fs::path& path, CacheAccess access) {
    struct stat status {};
    if (access == CacheAccess::write) {
        make_folder(path.parent_path());
    }
    return open_file(path, status, access == CacheAccess::write ? O_RDWR | O_CREAT : O_RDONLY);
}

Result<void> make_cache_folder(const fs::path& folder) {
    make_folder(folder);
    const auto opened = open_folder(folder);
    if (!opened) {
        return opened.error();
    }
    return *opened ? Result<void>() : Result<void>(unusable_file(folder));
}

Result<std::optional<std::string>> read_cache_file(const fs::path& path, std::size_t max_bytes) {
    struct stat status {};
    const auto file = open_file(path, status);
    if (!file) {
        return file.error();
    }
    if (!*file) {
        return std::optional<std::string>();
    }
    if (static_cast<std::size_t>(status.st_size) > max_bytes) {
        return Error{fmt::format("{}: a length of {} bytes found, at most {} were expected",
                                 path.string(), status.st_size, max_bytes)};
    }
    std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t count = ::read((*file)->number(), bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno != EINTR) {
            return unusable_file(path);
        }
        if (count == 0) {
            bytes.resize(done); // cut meanwhile
        }
        done += count > 0 ? static_cast<std::size_t>(count) : 0;
    }
    return std::optional(std::move(bytes));
}

Result<void> write_cache_file(const fs::path& path,
                              std::initializer_list<std::span<const std::byte>> parts) {
    const fs::path folder = path.parent_path();
    std::error_code ignored;
    make_folder(folder);
    struct stat status {};
    if (const auto old = open_file(path, status); !old) {
        return old.error();
    }
    remove_leftovers(folder); // what is kept took long to compute
    auto file = AtomicFile::create(path);
    if (!file) {
        return file.error();
    }
    fs::permissions(file->temporary(), fs::perms::owner_read | fs::perms::owner_write, ignored);
    for (const std::span<const std::byte> part : parts) {
        if (auto written = file->write(part); !written) {
            return written;
        }
    }
    return file->commit();
}

} // namespace reljef::io

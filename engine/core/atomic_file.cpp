#include "engine/core/atomic_file.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

namespace reljef {
namespace fs = std::filesystem;

Result<AtomicFile> AtomicFile::create(fs::path target) {
    static std::atomic<unsigned> counter{0};
    if (target.filename().empty()) {
        return Error{
            fmt::format("{}: cannot be written: a file name was expected", target.string())};
    }
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    std::error_code code;
    if (!fs::is_directory(folder, code)) {
        return Error{fmt::format("{}: cannot be written: there is no folder {}", target.string(),
                                 folder.string())};
    }
    if (fs::exists(target, code) &&
        !fs::is_regular_file(target, code)) { // never replaces /dev/null
        return Error{fmt::format("{}: cannot be written: it is a {}, a file was expected",
                                 target.string(),
                                 fs::is_directory(target, code) ? "folder" : "device")};
    }
    fs::path temporary = folder / fmt::format(".{}.{}.{}.part{}", target.stem().string(),
                                              ::getpid(), counter++, target.extension().string());
    if (!std::ofstream(temporary, std::ios::binary)) {
        return Error{
            fmt::format("{}: cannot be written: {}", target.string(), std::strerror(errno))};
    }
    return AtomicFile(std::move(target), std::move(temporary));
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)), temporary_(std::exchange(other.temporary_, {})),
      replaced_(std::exchange(other.replaced_, {})) {}

AtomicFile& AtomicFile::operator=(AtomicFile other) noexcept {
    target_.swap(other.target_);
    temporary_.swap(other.temporary_);
    replaced_.swap(other.replaced_);
    return *this;
}

AtomicFile::~AtomicFile() {
    std::error_code ignored;
    for (const fs::path* const leftover : {&temporary_, &replaced_}) {
        if (!leftover->empty()) {
            fs::remove(*leftover, ignored);
        }
    }
}

Result<void> AtomicFile::commit() {
    std::error_code code;
    fs::rename(temporary_, target_, code);
    if (code) {
        return Error{fmt::format("{}: cannot be written: {}", target_.string(), code.message())};
    }
    temporary_.clear();
    return {};
}

// The backup is a hard link, or a copy if the file system has no hard links.
Result<void> AtomicFile::commit_revertibly() {
    std::error_code code;
    if (fs::exists(target_, code)) {
        fs::path aside = temporary_;
        aside += ".replaced";
        fs::create_hard_link(target_, aside, code);
        if (code && !fs::copy_file(target_, aside, code)) {
            return Error{
                fmt::format("{}: cannot be replaced: {}", target_.string(), code.message())};
        }
        replaced_ = std::move(aside);
    }
    return commit();
}

void AtomicFile::revert() noexcept {
    std::error_code ignored;
    if (replaced_.empty()) {
        fs::remove(target_, ignored);
    } else {
        fs::rename(replaced_, target_, ignored);
        replaced_.clear();
    }
}

Result<void> commit_all(std::span<AtomicFile> files) {
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (auto done = files[i].commit_revertibly(); !done) {
            while (i > 0) {
                files[--i].revert();
            }
            return done;
        }
    }
    return {};
}

Result<void> write_text_file(const fs::path& path, std::string_view text) {
    return write_file(path, std::as_bytes(std::span(text)));
}

Result<AtomicFile> prepare_file(const fs::path& path, std::span<const std::byte> bytes) {
    auto file = AtomicFile::create(path);
    if (!file) {
        return file.error();
    }
    std::ofstream stream(file->temporary(), std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) {
        return Error{fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno))};
    }
    return file;
}

Result<void> write_file(const fs::path& path, std::span<const std::byte> bytes) {
    auto file = prepare_file(path, bytes);
    return file ? file->commit() : file.error();
}

Result<std::string> read_text_file(const fs::path& path, std::size_t limit) {
    std::error_code code;
    if (fs::is_directory(path, code)) {
        return Error{fmt::format("{}: is a folder, a file was expected", path.string())};
    }
    if (fs::is_fifo(path, code) || fs::is_socket(path, code)) { // opening one may never end
        return Error{fmt::format("{}: is no regular file, one was expected", path.string())};
    }
    std::ifstream stream(path, std::ios::binary);
    if (!stream) {
        return Error{fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno))};
    }
    std::string text;
    std::array<char, 65536> buffer{};
    while (stream.read(buffer.data(), buffer.size()) || stream.gcount() > 0) {
        text.append(buffer.data(), static_cast<std::size_t>(stream.gcount()));
        if (text.size() > limit) {
            return Error{fmt::format("{}: holds over {} bytes, at most that many were expected",
                                     path.string(), limit)};
        }
    }
    return text;
}

} // namespace reljef

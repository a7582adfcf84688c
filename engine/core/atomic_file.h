#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/result.h"

namespace reljef {

/// An output file that appears whole or not at all: write to `temporary()`, then `commit()`. The
/// destructor removes a file that is not committed.
class AtomicFile {
public:
    /// Fails with one sentence when the folder of `target` does not exist or cannot be written.
    static Result<AtomicFile> create(std::filesystem::path target);

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile other) noexcept;
    AtomicFile(const AtomicFile&) = delete;
    ~AtomicFile();

    /// Beside the target, with the target's extension.
    [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
    [[nodiscard]] const std::filesystem::path& target() const { return target_; }

    /// Renames the temporary file to the target.
    Result<void> commit();
    /// commit() that keeps a copy of the old target until the destructor.
    Result<void> commit_revertibly();
    /// Restores the old target. Precondition: commit_revertibly() succeeded.
    void revert() noexcept;

private:
    AtomicFile(std::filesystem::path target, std::filesystem::path temporary)
        : target_(std::move(target)), temporary_(std::move(temporary)) {}

    std::filesystem::path target_;
    std::filesystem::path temporary_;
    std::filesystem::path replaced_; // copy of the old target; empty: none
};

/// Commits all files or none. At any time a reader sees each file either old or new.
Result<void> commit_all(std::span<AtomicFile> files);

/// Writes `bytes` to the temporary file of `path`, ready for commit().
Result<AtomicFile> prepare_file(const std::filesystem::path& path,
                                std::span<const std::byte> bytes);
/// Writes a file whole or not at all.
Result<void> write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
Result<void> write_text_file(const std::filesystem::path& path, std::string_view text);

/// The content of a file of at most `limit` bytes.
Result<std::string> read_text_file(const std::filesystem::path& path,
                                   std::size_t limit = std::size_t{1} << 24);

} // namespace reljef

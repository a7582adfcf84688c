#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/result.h"

namespace reljef {

/// An output file that appears whole or not at all: write to `temporary()`, then `commit()`. What
/// is not committed is removed.
class AtomicFile {
public:
    /// Fails with one sentence when the folder of `target` does not exist or cannot be written.
    static Result<AtomicFile> create(std::filesystem::path target);

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&& other) noexcept;
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    /// Beside the target, with the target's extension.
    [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
    [[nodiscard]] const std::filesystem::path& target() const { return target_; }

    /// Renames the temporary file to the target.
    Result<void> commit();
    /// The same, and keeps what was at the target beside it until this is destroyed.
    Result<void> commit_revertibly();
    /// What is there now goes; what was there before comes back. Precondition: commit_revertibly()
    /// was called and succeeded.
    void revert() noexcept;

private:
    AtomicFile(std::filesystem::path target, std::filesystem::path temporary)
        : target_(std::move(target)), temporary_(std::move(temporary)) {}
    void remove() noexcept;

    std::filesystem::path target_;
    std::filesystem::path temporary_;
    std::filesystem::path replaced_; // what the target was; empty: nothing was there
};

/// Commits all files; where one cannot be, those before it are put back as they were. A reader
/// sees each as it was or as it is now, at any time.
Result<void> commit_all(std::span<AtomicFile> files);

/// Writes `bytes` beside `path`; a commit() puts them there.
Result<AtomicFile> prepare_file(const std::filesystem::path& path,
                                std::span<const std::byte> bytes);
/// Writes `bytes` to `path`, whole or not at all.
Result<void> write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
/// The same of a text.
Result<void> write_text_file(const std::filesystem::path& path, std::string_view text);

/// The content of a file of at most `limit` bytes.
Result<std::string> read_text_file(const std::filesystem::path& path,
                                   std::size_t limit = std::size_t{1} << 24);

} // namespace reljef

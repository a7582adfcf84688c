#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "engine/core/result.h"

namespace reljef {

/// A file descriptor that closes itself; false if there is none.
class Descriptor {
public:
    Descriptor() = default;
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    Descriptor(const Descriptor&) = delete;
    ~Descriptor();

    explicit operator bool() const { return number_ >= 0; }
    [[nodiscard]] int number() const { return number_; }

private:
    int number_ = -1;
};

/// Removes the temporary files and folders that killed processes of this user left in a folder; an
/// empty path is the current one. Reads the whole folder: call it once for many files.
void remove_leftovers(const std::filesystem::path& folder);

/// Removes the temporary files and folders of this process. For a program that ends without
/// destructors, while other threads may write.
void remove_own_temporaries();

/// An output file that appears whole or not at all: write to `temporary()`, then `commit()`. The
/// destructor removes a file that is not committed. If the process is killed, the next
/// remove_leftovers() removes it: a file lock shows which processes live.
class AtomicFile {
public:
    /// A target that is a symbolic link stays one: the file that it names is replaced or created.
    /// Fails with one sentence when the folder of `target` does not exist or cannot be written.
    static Result<AtomicFile> create(std::filesystem::path target);

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile other) noexcept;
    AtomicFile(const AtomicFile&) = delete;
    ~AtomicFile();

    /// An empty file beside the target, with the target's extension and a name that nobody can
    /// guess. Writers may truncate it, but not replace it.
    [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
    [[nodiscard]] const std::filesystem::path& target() const { return target_; }

    /// Appends to the temporary file.
    Result<void> write(std::span<const std::byte> bytes);

    /// Renames the temporary file to the target. After a power failure the target is old or new.
    Result<void> commit();

private:
    friend Result<void> commit_all(std::span<AtomicFile> files);

    AtomicFile() = default;
    [[nodiscard]] Error error(std::string_view why) const;
    Result<void> sync();
    Result<void> rename();
    // Keeps a copy of the old target until the destructor.
    Result<void> rename_revertibly();
    // Restores the old target. Precondition: rename_revertibly() succeeded.
    void revert() noexcept;

    std::filesystem::path target_;    // as given
    std::filesystem::path place_;     // the target without links
    std::filesystem::path temporary_; // empty: committed
    std::filesystem::path replaced_;  // copy of the old target; empty: none
    Descriptor file_;                 // of the temporary file, locked
    Descriptor old_;                  // of `replaced_`, locked
};

/// Commits all files or none. At any time a reader sees each file either old or new.
Result<void> commit_all(std::span<AtomicFile> files);

/// Writes `bytes` to the temporary file of `path`, ready for commit().
Result<AtomicFile> prepare_file(const std::filesystem::path& path,
                                std::span<const std::byte> bytes);
/// Writes a file whole or not at all.
Result<void> write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
Result<void> write_text_file(const std::filesystem::path& path, std::string_view text);

/// What lies at a path, for errors: "a file", "a folder", "a device", "a pipe", "a socket" or
/// "nothing". Links are followed.
std::string_view kind_of_file(const std::filesystem::path& path);

/// The content of a file of at most `limit` bytes.
Result<std::string> read_text_file(const std::filesystem::path& path,
                                   std::size_t limit = std::size_t{1} << 24);

/// An empty folder for this user only, with a name that nobody can guess. The destructor removes it
/// and its content, and keeps errno. If the process is killed, the next one in `parent` removes it.
class ScratchFolder {
public:
    /// In `parent`; if that is empty, in the system's folder for temporary files ($TMPDIR or /tmp).
    static Result<ScratchFolder> create(std::filesystem::path parent = {});

    ScratchFolder(ScratchFolder&& other) noexcept = default;
    ScratchFolder(const ScratchFolder&) = delete;
    ~ScratchFolder();

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    ScratchFolder() = default;

    std::filesystem::path path_;
    Descriptor folder_; // locked; none: moved from
};

} // namespace reljef

#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace reljef::test {

/// A fresh, empty folder that is removed, with all it holds, at the end of its scope.
class TemporaryFolder {
public:
    /// Aborts where the system's folder for temporary files cannot be written.
    TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder();

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    /// Writes a file, making the folders it lies in; returns its path.
    std::filesystem::path write(std::string_view relative, std::string_view bytes) const;

    /// The names of all files and folders directly below, hidden ones too, sorted.
    [[nodiscard]] std::vector<std::string> names() const;

private:
    std::filesystem::path path_;
};

/// All bytes of a file; empty where it cannot be read.
std::string read_bytes(const std::filesystem::path& path);

} // namespace reljef::test

#pragma once

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace reljef::fuzz {

/// A property of a result that does not hold. No target catches it.
class Finding : public std::logic_error {
    using std::logic_error::logic_error;
};

/// Throws a Finding if a property of a result does not hold.
void expect(bool property, const char* what);

/// The parts of an input between lines of four dashes.
std::vector<std::string_view> parts_of(std::string_view bytes);

/// A folder of this process for the files of inputs, empty at first, removed at exit.
class InputFolder {
public:
    InputFolder();
    ~InputFolder();
    InputFolder(const InputFolder&) = delete;
    InputFolder& operator=(const InputFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Writes a file anew and returns its path.
    [[nodiscard]] std::filesystem::path write(std::string_view name, std::string_view bytes) const;

private:
    std::filesystem::path path_;
};

/// A name that a reader tells formats by, and a file that may lie beside it (empty: none).
struct FileKind {
    std::string_view name;
    std::string_view sidecar = {};
};

/// Writes an input as a file: its first byte, 'a', 'b', …, chooses the kind. The second part of the
/// rest is the sidecar. Returns the path.
std::filesystem::path write_as_kind(const InputFolder& folder, std::string_view input,
                                    std::span<const FileKind> kinds);

} // namespace reljef::fuzz

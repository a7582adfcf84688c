#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.h"

namespace reljef::app {

/// A named view of a terrain.
struct Bookmark {
    std::string terrain; ///< TERRAIN of the command line
    std::string name;
    std::string camera; ///< as camera_text()

    friend bool operator==(const Bookmark&, const Bookmark&) = default;
};

/// Bookmarks in a text file: a line "TERRAIN<tab>NAME<tab>CAMERA" each. Empty lines, comments (#)
/// and lines that are damaged stay in the file as they are.
class Bookmarks {
public:
    /// `file` need not exist.
    explicit Bookmarks(std::filesystem::path file) : file_(std::move(file)) {}

    struct List {
        std::vector<Bookmark> bookmarks;
        /// One sentence on the damaged lines; empty if there are none.
        std::string note;
    };
    /// Those of a terrain, in the order of the file. No file is no bookmark. Fails if the file
    /// cannot be read.
    [[nodiscard]] Result<List> of(const std::string& terrain) const;

    /// Appends a bookmark. Tabs and line ends in texts become blanks. Reads the file again, so that
    /// those of other windows remain; creates its folder. An error changes nothing.
    [[nodiscard]] Result<void> add(Bookmark bookmark) const;
    /// Removes the first equal bookmark. Fails if there is none.
    [[nodiscard]] Result<void> remove(const Bookmark& bookmark) const;

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }

private:
    std::filesystem::path file_;
};

/// $XDG_DATA_HOME/reljef/bookmarks.txt, else $HOME/.local/share/reljef/bookmarks.txt (XDG Base
/// Directory Specification 0.8); absent without an absolute path.
std::optional<std::filesystem::path> bookmark_file();

} // namespace reljef::app

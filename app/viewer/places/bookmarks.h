#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer/places/bookmark.h"
#include "engine/core/result.h"

namespace reljef::app {

/// Bookmarks in a text file: a line "TERRAIN<tab>NAME<tab>CAMERA" each, with the
/// camera as camera_text(). Empty lines, comments (#)
/// and lines that are damaged stay in the file as they are.
class Bookmarks {
public:
    /// `file` need not exist.
    explicit Bookmarks(std::filesystem::path file) : file_(std::move(file)) {}

    /// Those of a terrain, in the order of the file, and a note on damaged lines. No file is no
    /// bookmark. Fails if the file cannot be read.
    [[nodiscard]] Result<BookmarkContent> of(const std::string& terrain) const;

    /// Appends a bookmark. Tabs and line ends in texts become blanks. Reads the file again, so that
    /// those of other windows remain; creates its folder. An error changes nothing.
    [[nodiscard]] Result<void> add(Bookmark bookmark) const;
    /// Removes the first equal bookmark. Fails if there is none.
    [[nodiscard]] Result<void> remove(const Bookmark& bookmark) const;
    /// Gives the first equal bookmark another name. Fails if there is none, or the name is empty.
    [[nodiscard]] Result<void> rename(const Bookmark& bookmark, const std::string& name) const;

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }

private:
    // `other`: absent: removes it.
    [[nodiscard]] Result<void> replace(const Bookmark& bookmark,
                                       const std::optional<Bookmark>& other) const;

    std::filesystem::path file_;
};

/// $XDG_DATA_HOME/reljef/bookmarks.txt, else $HOME/.local/share/reljef/bookmarks.txt (XDG Base
/// Directory Specification 0.8); absent without an absolute path.
std::optional<std::filesystem::path> bookmark_file();

} // namespace reljef::app

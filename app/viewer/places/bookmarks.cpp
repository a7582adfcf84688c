#include "app/viewer/places/bookmarks.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include "engine/core/atomic_file.h"

namespace reljef::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view heading =
    "# Bookmarks of reljef: TERRAIN, NAME and camera, with tabs.\n";

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::size_t begin = 0;
    while (begin < text.size()) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

std::string line_of(const Bookmark& bookmark) {
    return bookmark.terrain + '\t' + bookmark.name + '\t' + bookmark.camera;
}

std::optional<Bookmark> bookmark_of(std::string_view line) {
    if (line.ends_with('\r')) {
        line.remove_suffix(1);
    }
    const std::size_t first = line.find('\t');
    const std::size_t second = first == line.npos ? first : line.find('\t', first + 1);
    const bool is_whole = second != line.npos && line.find('\t', second + 1) == line.npos &&
                          line.find('\0') == line.npos;
    if (!is_whole) {
        return std::nullopt;
    }
    Bookmark bookmark{std::string(line.substr(0, first)),
                      std::string(line.substr(first + 1, second - first - 1)),
                      std::string(line.substr(second + 1))};
    const bool has_camera =
        bookmark.camera.starts_with("--camera ") || bookmark.camera.starts_with("--eye ");
    return has_camera && !bookmark.terrain.empty() ? std::optional(bookmark) : std::nullopt;
}

bool is_content(const std::string& line) {
    return !line.empty() && line != "\r" && line.front() != '#';
}

// The text of the file; empty if there is none.
Result<std::string> text_of(const fs::path& file) {
    std::error_code ignored;
    if (!fs::exists(fs::symlink_status(file, ignored))) {
        return std::string();
    }
    return read_text_file(file);
}

std::string without_separators(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
    return text;
}

// A file or folder by its whole path: others of its name have bookmarks of their own.
std::string terrain_key(const std::string& terrain) {
    std::error_code failed;
    const fs::path whole = fs::canonical(terrain, failed);
    return without_separators(failed ? terrain : whole.string());
}

std::string note_on(const fs::path& file, int damaged_lines, int first) {
    const std::string lines = damaged_lines == 1
                                  ? "a line found that is"
                                  : fmt::format("{} lines found that are", damaged_lines);
    return fmt::format(
        "{}: {} no bookmark, the first is line {}; other lines are used, and all are "
        "kept",
        file.string(), lines, first);
}

// Other windows wait until this one has changed the file: it is read and written anew.
Result<Descriptor> lock_of(const fs::path& folder) {
    Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!opened || ::flock(opened.number(), LOCK_EX) != 0) {
        return Error{fmt::format("{}: the folder cannot be locked: {}", folder.string(),
                                 std::strerror(errno))};
    }
    return opened;
}

std::optional<fs::path> absolute_path_in(const char* variable) {
    const char* const value = std::getenv(variable);
    return value != nullptr && fs::path(value).is_absolute() ? std::optional(fs::path(value))
                                                             : std::nullopt;
}

} // namespace

Result<BookmarkContent> Bookmarks::of(const std::string& terrain) const {
    const auto text = text_of(file_);
    if (!text) {
        return text.error();
    }
    const std::string key = terrain_key(terrain);
    BookmarkContent list;
    int damaged = 0;
    int first_damaged = 0;
    int number = 0;
    for (const std::string& line : lines_of(*text)) {
        ++number;
        const auto bookmark = is_content(line) ? bookmark_of(line) : std::nullopt;
        if (is_content(line) && !bookmark) {
            first_damaged = damaged++ == 0 ? number : first_damaged;
        } else if (bookmark && bookmark->terrain == key) {
            list.bookmarks.push_back(*bookmark);
        }
    }
    if (damaged > 0) {
        list.note = note_on(file_, damaged, first_damaged);
    }
    return list;
}

Result<void> Bookmarks::add(Bookmark bookmark) const {
    std::error_code failed;
    fs::create_directories(file_.parent_path(), failed);
    if (failed) {
        return Error{fmt::format("{}: the folder cannot be made: {}", file_.parent_path().string(),
                                 failed.message())};
    }
    const auto lock = lock_of(file_.parent_path());
    auto text = lock ? text_of(file_) : lock.error();
    if (!text) {
        return text.error();
    }
    if (text->empty()) {
        *text = heading;
    } else if (text->back() != '\n') {
        *text += '\n';
    }
    bookmark.terrain = terrain_key(bookmark.terrain);
    bookmark.name = without_separators(bookmark.name);
    return write_text_file(file_, *text + line_of(bookmark) + '\n');
}

Result<void> Bookmarks::remove(const Bookmark& bookmark) const {
    return replace(bookmark, std::nullopt);
}

Result<void> Bookmarks::rename(const Bookmark& bookmark, const std::string& name) const {
    Bookmark other = bookmark;
    other.name = without_separators(name);
    return name.empty() ? Error{fmt::format("bookmark {}: an empty name found, a name was expected",
                                            bookmark.name)}
                        : replace(bookmark, other);
}

Result<void> Bookmarks::replace(const Bookmark& bookmark,
                                const std::optional<Bookmark>& other) const {
    const auto lock = lock_of(file_.parent_path());
    const auto text = lock ? text_of(file_) : lock.error();
    if (!text) {
        return text.error();
    }
    std::string kept;
    bool is_found = false;
    for (const std::string& line : lines_of(*text)) {
        if (is_found || !is_content(line) || bookmark_of(line) != bookmark) {
            kept += line + '\n';
            continue;
        }
        is_found = true;
        kept += other ? line_of(*other) + '\n' : std::string();
    }
    return is_found
               ? write_text_file(file_, kept)
               : Error{fmt::format("{}: no bookmark '{}' found", file_.string(), bookmark.name)};
}

std::optional<fs::path> bookmark_file() {
    auto folder = absolute_path_in("XDG_DATA_HOME");
    if (!folder) {
        const auto home = absolute_path_in("HOME");
        folder = home ? std::optional(*home / ".local" / "share") : std::nullopt;
    }
    return folder ? std::optional(*folder / "reljef" / "bookmarks.txt") : std::nullopt;
}

} // namespace reljef::app

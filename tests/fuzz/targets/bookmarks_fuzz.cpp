// Files of bookmarks: what is added is found, what is removed is gone, and all else stays.
#include <algorithm>

#include "app/viewer/places/bookmarks.h"
#include "engine/core/atomic_file.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {
namespace {

constexpr const char* terrain = "natural";

std::vector<app::Bookmark> listed(const app::Bookmarks& bookmarks) {
    const auto list = bookmarks.of(terrain);
    expect(list.has_value(), "a file that can be read");
    for (const app::Bookmark& bookmark : list->bookmarks) {
        expect(bookmark.terrain == terrain, "bookmarks of the terrain");
        expect((bookmark.name + bookmark.camera).find_first_of("\t\n") == std::string::npos,
               "names and cameras without separators");
    }
    return list->bookmarks;
}

} // namespace

void bookmarks_target(std::string_view input) {
    static const InputFolder folder;
    const app::Bookmarks bookmarks(folder.write("bookmarks.txt", input));
    const auto before = listed(bookmarks);
    const app::Bookmark added{terrain, "a view", "--camera 45,6,1000,0,-10"};
    expect(bookmarks.add(added).has_value(), "a file that can be written");
    auto expected = before;
    expected.push_back(added);
    expect(listed(bookmarks) == expected, "the same bookmarks and one more");
    expect(bookmarks.remove(added).has_value(), "a bookmark that can be removed");
    expected.erase(std::find(expected.begin(), expected.end(), added));
    expect(listed(bookmarks) == expected, "the same bookmarks without it");
    const bool was_there = std::find(before.begin(), before.end(), added) != before.end();
    if (!was_there && !input.empty()) {
        const std::string_view end = input.ends_with('\n') ? "" : "\n";
        const auto text = read_text_file(bookmarks.file());
        expect(text && *text == std::string(input) + std::string(end), "the same other lines");
    }
}

} // namespace reljef::fuzz

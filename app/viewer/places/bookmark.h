#pragma once

#include <string>
#include <vector>

namespace reljef::app {

/// A named view of a terrain.
struct Bookmark {
    std::string terrain; ///< TERRAIN of the command line
    std::string name;
    std::string camera; ///< the options that show it

    friend bool operator==(const Bookmark&, const Bookmark&) = default;
};

struct BookmarkContent {
    std::vector<Bookmark> bookmarks; ///< of one terrain
    std::string note;                ///< one sentence on what cannot be read; empty: nothing
};

} // namespace reljef::app

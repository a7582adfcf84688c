#include "tests/architecture/include_table.h"

#include <map>
#include <set>
#include <vector>

namespace reljef::test {
namespace {

using Names = std::vector<std::string_view>;

// What each folder of code may include directly; what lies below these is allowed too. The folders
// of files that are many (io), of imagery and of streams (scene) include each other.
const std::map<std::string_view, Names>& include_table() {
    static const std::map<std::string_view, Names> table{
        {"engine/core", {}},
        {"engine/geo", {"engine/core"}},
        {"engine/material", {"engine/core"}},
        {"engine/terrain/field", {"engine/geo", "engine/material"}},
        {"engine/terrain/mesh", {"engine/terrain/field"}},
        {"engine/terrain/tree", {"engine/terrain/mesh"}},
        {"engine/io/raster", {"engine/terrain/field"}},
        {"engine/io/imagery", {"engine/io/raster", "engine/io"}},
        {"engine/io",
         {"engine/io/raster", "engine/io/imagery", "engine/io/cache", "engine/terrain/tree"}},
        {"engine/io/cache", {"engine/terrain/mesh"}},
        {"engine/io/image", {"engine/io/raster"}},
        {"engine/io/formats", {"engine/io"}},
        {"engine/scene/technique", {"engine/material"}},
        {"engine/scene/graph", {"engine/scene/technique", "engine/terrain/mesh", "engine/scene"}},
        {"engine/scene", {"engine/scene/graph", "engine/terrain/tree"}},
        {"engine/scene/motion", {"engine/scene/graph"}},
        {"engine/truth", {"engine/scene/graph"}},
        {"engine/view", {"engine/scene"}},
        {"engine/gl", {"engine/core"}},
        {"engine/platform", {"engine/gl"}},
        {"shaders/frame", {}},
        {"engine/render/shaders", {"engine/view", "engine/gl", "shaders/frame"}},
        {"engine/render/residency", {"engine/render/shaders"}},
        {"engine/render/passes", {"engine/render/residency"}},
        {"engine/render", {"engine/render/passes"}},
        {"terrains", {"engine/terrain/field"}},
        {"terrains/natural", {"terrains"}},
        {"terrains/urban", {"terrains/natural"}},
        {"terrains/gallery", {"terrains/natural"}},
        {"engine/session",
         {"engine/io/formats", "engine/io/image", "engine/scene/motion", "engine/truth",
          "engine/platform", "engine/render", "terrains/gallery"}},
        {"app/cli", {"engine/session"}},
        {"app/viewer", {"engine/session"}},
        {"app", {"app/cli", "app/viewer"}},
        {"bench/report", {"app/cli"}},
        {"bench/page", {"bench/report"}},
        {"bench/runner", {"bench/report"}},
        {"bench/suites", {"bench/runner"}},
        {"bench/baselines/irrlicht", {}},
        {"bench/baselines", {"bench/runner", "bench/baselines/irrlicht"}},
        {"bench", {"bench/suites", "bench/baselines", "bench/page"}},
    };
    return table;
}

} // namespace

std::string folder_of(std::string_view path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string_view::npos ? "" : std::string(path.substr(0, slash));
}

std::string room_of(std::string_view path) {
    const std::string folder = folder_of(path);
    if (include_table().contains(folder)) {
        return folder;
    }
    return folder == "tests" || folder.starts_with("tests/") ? "tests" : "";
}

bool may_include(std::string_view from, std::string_view to) {
    if (to.starts_with("shaders/")) {
        return from == "engine/render/shaders";
    }
    if (from == "tests") {
        return true;
    }
    std::set<std::string_view> below{from};
    std::vector<std::string_view> open{from};
    while (!open.empty()) {
        const auto row = include_table().find(open.back());
        open.pop_back();
        for (const std::string_view room : row == include_table().end() ? Names() : row->second) {
            if (below.insert(room).second) {
                open.push_back(room);
            }
        }
    }
    return below.contains(to);
}

} // namespace reljef::test

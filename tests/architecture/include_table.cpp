#include "tests/architecture/include_table.h"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

namespace reljef::test {
namespace {

using Names = std::vector<std::string_view>;

// What each folder of code may include directly; what lies below these is allowed too.
const std::map<std::string_view, Names>& include_table() {
    static const std::map<std::string_view, Names> table{
        {"engine/core", {}},
        {"engine/core/loading", {"engine/core"}},
        {"engine/geo", {"engine/core"}},
        {"engine/material", {"engine/core"}},
        {"engine/building", {"engine/core"}},
        {"engine/terrain/field", {"engine/geo", "engine/material"}},
        {"engine/terrain/light", {"engine/terrain/field"}},
        {"engine/terrain/measure", {"engine/terrain/field"}},
        {"engine/terrain/mesh", {"engine/terrain/field"}},
        {"engine/terrain/tree", {"engine/terrain/mesh"}},
        {"engine/io/remote", {"engine/core"}},
        {"engine/io/checks", {"engine/io/remote"}},
        {"engine/io/raster", {"engine/terrain/field", "engine/io/checks"}},
        {"engine/io/files", {"engine/io/raster", "engine/io/cache", "engine/terrain/tree"}},
        {"engine/io/imagery", {"engine/io/files"}},
        {"engine/io", {"engine/io/imagery"}},
        {"engine/io/cache", {"engine/terrain/mesh"}},
        {"engine/io/codec", {}},
        {"engine/io/image",
         {"engine/core/loading", "engine/io/codec", "engine/io/raster", "engine/io/cache"}},
        {"engine/io/index", {"engine/io"}},
        {"engine/io/mesh", {"engine/io/image", "engine/scene/graph"}},
        {"engine/io/footprints", {"engine/io/raster", "engine/building"}},
        {"engine/io/formats", {"engine/io", "engine/building"}},
        {"engine/scene/technique", {"engine/material"}},
        {"engine/scene/streaming",
         {"engine/material", "engine/terrain/light", "engine/terrain/tree"}},
        {"engine/scene/graph", {"engine/scene/technique", "engine/scene/streaming"}},
        {"engine/scene/motion", {"engine/scene/graph"}},
        {"engine/scene/levels", {"engine/scene/graph"}},
        {"engine/truth", {"engine/scene/graph"}},
        {"engine/view/rays", {"engine/scene/graph"}},
        {"engine/view", {"engine/view/rays"}},
        {"engine/view/triangles", {"engine/view"}},
        {"engine/view/choice", {"engine/view/triangles"}},
        {"engine/view/picture", {"engine/view", "shaders/terrain"}},
        {"shaders/terrain", {}},
        {"engine/cast/packet", {"shaders/terrain"}},
        {"engine/cast", {"engine/view", "engine/cast/packet"}},
        {"engine/cast/mesh", {"engine/view"}},
        {"engine/cast/frame", {"engine/cast", "engine/cast/mesh", "engine/view/choice"}},
        {"engine/gl", {"engine/core"}},
        {"engine/platform", {"engine/core/loading", "engine/gl"}},
        {"shaders/frame", {}},
        {"shaders/material", {}},
        {"engine/render/shaders",
         {"engine/view", "engine/gl", "shaders/frame", "shaders/material"}},
        {"engine/render/triangles", {"engine/view/triangles", "engine/gl"}},
        {"engine/render/residency", {"engine/render/shaders", "engine/render/triangles"}},
        {"engine/render/passes", {"engine/render/residency"}},
        {"engine/render", {"engine/render/passes"}},
        {"terrains", {"engine/terrain/field", "engine/building"}},
        {"terrains/natural", {"terrains"}},
        {"terrains/urban", {"terrains/natural"}},
        {"terrains/gallery", {"terrains/natural"}},
        {"engine/session/objects",
         {"engine/io/footprints", "engine/io/formats", "engine/io/mesh", "engine/scene/levels"}},
        {"engine/session",
         {"engine/io/formats", "engine/io/image", "engine/io/index", "engine/scene/motion",
          "engine/truth", "engine/cast/frame", "engine/platform", "engine/render",
          "engine/session/objects", "engine/view/choice", "engine/view/picture",
          "terrains/gallery"}},
        {"engine/session/calibration", {"engine/session"}},
        {"engine/session/comparing", {"engine/session"}},
        {"engine/session/measuring", {"engine/session", "engine/terrain/measure"}},
        {"engine/session/picture", {"engine/session"}},
        {"app/cli", {}},
        {"app/viewer/panels/toolkit", {}},
        {"app/viewer/panels", {}},
        {"app/viewer/appearance", {}},
        {"app/viewer/comparing", {}},
        {"app/viewer/paths", {}},
        {"app/viewer/places", {}},
        {"app/viewer/timing", {}},
        {"app/viewer", {}},
        {"app/choice", {}},
        {"app/comparing", {}},
        {"app/importer", {}},
        {"app/objects", {}},
        {"app/rendering", {}},
        {"app", {}},
        {"bench/report", {}},
        {"bench/page", {}},
        {"bench/runner", {}},
        {"bench/suites", {}},
        {"bench/stress", {}},
        {"bench/claims", {}},
        {"bench/objects", {}},
        {"bench/options", {}},
        {"bench/findings", {}},
        {"bench/baselines/program", {}},
        {"bench/baselines/irrlicht", {"bench/baselines/program"}},
        {"bench/baselines/openscenegraph", {"bench/baselines/program"}},
        {"bench/baselines/embree", {}},
        {"bench/baselines", {}},
        {"bench", {}},
    };
    return table;
}

// What a folder may include beside its row: these rooms alone. What lies below them stays hidden,
// and a room that includes this folder may not include them. The programs name each room here, so
// that a new room of the engine is not theirs by chance.
const std::map<std::string_view, Names>& named_rooms() {
    static const std::map<std::string_view, Names> rooms{
        {"app/cli",
         {"engine/building", "engine/core", "engine/platform", "engine/scene/graph",
          "engine/scene/motion", "engine/scene/technique", "engine/session", "engine/view"}},
        {"app/viewer/panels/toolkit", {"engine/core", "engine/gl"}},
        {"app/viewer/panels",
         {"app/viewer/panels/toolkit", "app/viewer/places", "engine/core", "engine/geo",
          "engine/scene/graph", "engine/scene/technique", "engine/view", "engine/view/picture"}},
        {"app/viewer/appearance",
         {"app/viewer/panels", "engine/core", "engine/scene/graph", "engine/scene/technique",
          "engine/session", "engine/session/objects", "engine/session/picture",
          "engine/terrain/field", "engine/view"}},
        {"app/viewer/comparing",
         {"app/viewer/appearance", "app/viewer/panels", "engine/core", "engine/scene/graph",
          "engine/scene/technique", "engine/session", "engine/session/comparing"}},
        {"app/viewer/paths",
         {"engine/core", "engine/scene/graph", "engine/scene/motion", "engine/session"}},
        {"app/viewer/places", {"engine/core"}},
        {"app/viewer/timing", {"engine/core"}},
        {"app/viewer",
         {"app/viewer/panels",    "app/viewer/panels/toolkit", "app/viewer/appearance",
          "app/objects",          "app/viewer/comparing",      "app/viewer/paths",
          "app/viewer/places",    "app/viewer/timing",         "engine/core",
          "engine/geo",           "engine/io/image",           "engine/platform",
          "engine/scene/graph",   "engine/scene/motion",       "engine/scene/technique",
          "engine/session",       "engine/session/measuring",  "engine/session/picture",
          "engine/terrain/field", "engine/terrain/measure",    "engine/view"}},
        {"app/choice",
         {"app/cli", "engine/core", "engine/platform", "engine/scene/technique", "engine/session",
          "engine/session/calibration"}},
        {"app/comparing", {"app/cli", "engine/core", "engine/session", "engine/session/comparing"}},
        {"app/importer", {"engine/io/mesh"}},
        {"app/objects", {"app/cli", "engine/building", "engine/core", "engine/io/formats"}},
        {"app/rendering",
         {"app/cli", "app/comparing", "engine/core", "engine/io/image", "engine/scene/motion",
          "engine/session", "engine/session/picture"}},
        {"app",
         {"app/choice",
          "app/cli",
          "app/comparing",
          "app/objects",
          "app/rendering",
          "app/viewer",
          "app/viewer/comparing",
          "app/viewer/panels",
          "app/viewer/panels/toolkit",
          "app/viewer/timing",
          "engine/core",
          "engine/io/image",
          "engine/io/raster",
          "engine/material",
          "engine/platform",
          "engine/scene/technique",
          "engine/session",
          "engine/session/measuring",
          "engine/session/picture",
          "engine/terrain/measure",
          "terrains/gallery"}},
        {"bench/report",
         {"app/cli", "engine/core", "engine/io/image", "engine/platform", "engine/scene/motion",
          "engine/scene/technique", "engine/truth", "engine/view"}},
        {"bench/page", {"bench/report", "engine/core"}},
        {"bench/runner",
         {"app/cli", "bench/report", "engine/core", "engine/io/formats", "engine/platform",
          "engine/scene/graph", "engine/scene/technique", "engine/session",
          "engine/session/calibration", "engine/truth", "terrains/gallery"}},
        {"bench/suites",
         {"app/cli", "bench/report", "bench/runner", "engine/core", "engine/io/formats",
          "engine/material", "engine/scene/graph", "engine/scene/motion", "engine/scene/streaming",
          "engine/session", "engine/truth", "engine/view", "engine/view/choice", "terrains"}},
        {"bench/stress",
         {"app/cli", "bench/report", "bench/runner", "bench/suites", "engine/core", "engine/geo",
          "engine/io/formats", "engine/scene/graph", "engine/scene/motion",
          "engine/scene/technique", "engine/session", "engine/terrain/field", "engine/truth",
          "engine/view", "terrains"}},
        {"bench/claims",
         {"app/cli", "bench/report", "bench/runner", "engine/core", "engine/material",
          "engine/render/residency", "engine/scene/graph", "engine/scene/motion", "engine/session",
          "engine/truth", "terrains"}},
        {"bench/options",
         {"app/cli", "bench/page", "bench/report", "bench/runner", "engine/core",
          "engine/io/formats", "engine/scene/technique"}},
        {"bench/objects",
         {"app/cli", "bench/report", "bench/runner", "engine/building", "engine/core",
          "engine/io/formats", "engine/session", "engine/terrain/field", "engine/truth"}},
        {"bench/findings",
         {"app/cli", "bench/report", "bench/suites", "engine/core", "engine/scene/technique"}},
        {"bench/baselines/embree", {"engine/core", "engine/scene/graph"}},
        {"bench/baselines",
         {"app/cli", "bench/baselines/embree", "bench/baselines/program", "bench/report",
          "bench/runner", "engine/core", "engine/scene/graph", "engine/scene/motion",
          "engine/scene/technique", "engine/session", "engine/terrain/mesh", "engine/truth",
          "engine/view"}},
        {"bench",
         {"app/cli", "bench/baselines", "bench/claims", "bench/findings", "bench/objects",
          "bench/options", "bench/page", "bench/report", "bench/runner", "bench/stress",
          "bench/suites", "engine/core", "engine/io/formats", "engine/scene/motion",
          "engine/scene/technique", "engine/view"}},
    };
    return rooms;
}

bool names_room(std::string_view from, std::string_view to) {
    const auto row = named_rooms().find(from);
    return row != named_rooms().end() &&
           std::find(row->second.begin(), row->second.end(), to) != row->second.end();
}

bool lies_below(std::string_view from, std::string_view to) {
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
    if (from == "tests") {
        return true;
    }
    if (to.starts_with("shaders/")) { // only by the rooms that share numbers with them
        const auto row = include_table().find(from);
        return row != include_table().end() &&
               std::find(row->second.begin(), row->second.end(), to) != row->second.end();
    }
    return names_room(from, to) || lies_below(from, to);
}

} // namespace reljef::test

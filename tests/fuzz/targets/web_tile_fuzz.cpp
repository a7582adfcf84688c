// The name of web tiles (first part), and a tile of heights in a folder (second part).
#include "engine/io/raster/web_tiles.h"
#include "engine/io/tile_set.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {

void web_tile_target(std::string_view input) {
    static const InputFolder folder;
    static const bool made =
        std::filesystem::create_directories(folder.path() / "tiles" / "0" / "0");
    expect(made, "a new folder");
    const auto parts = parts_of(input);
    const std::string name(parts.front());
    if (io::is_web_tiles(name) && name.find("://") == std::string::npos) {
        static_cast<void>(io::web_tile_source(name));
    } else if (io::is_web_tiles(name)) {
        const auto source = io::web_tile_source(name); // asks no server
        static_cast<void>(source && !source->name({1, 2}, 3).empty());
    }
    static_cast<void>(
        folder.write("tiles/0/0/0.png", parts.size() > 1 ? parts[1] : std::string_view()));
    const auto tiles =
        io::TileSet::open("terrarium+" + (folder.path() / "tiles").string(), {.threads = 1});
    if (tiles) {
        io::TileTerrainOptions options;
        options.raster.memory_budget = std::size_t{2} << 20;
        options.threads = 1;
        static_cast<void>(tiles->terrain(options));
    }
}

} // namespace reljef::fuzz

// Rasters of all formats, as `reljef` reads them: whole, as a set of tiles, and their metadata.
#include <array>
#include <cmath>

#include "engine/io/terrain_file.h"
#include "engine/io/tile_set.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/made_dem.h"

namespace {

using namespace reljef;

constexpr std::array kinds{fuzz::FileKind{"a.tif"},          fuzz::FileKind{"a.zip"},
                           fuzz::FileKind{"a.gz"},           fuzz::FileKind{"a.gtx"},
                           fuzz::FileKind{"a.byn"},          fuzz::FileKind{"a.tga"},
                           fuzz::FileKind{"a.xyz"},          fuzz::FileKind{"a.bt"},
                           fuzz::FileKind{"a.vrt"},          fuzz::FileKind{"a.asc", "a.prj"},
                           fuzz::FileKind{"a.bil", "a.hdr"}, fuzz::FileKind{"a.rst", "a.rdc"},
                           fuzz::FileKind{"a.png", "a.pgw"}, fuzz::FileKind{"a.sdat", "a.sgrd"}};

constexpr double max_samples = 1 << 20; // larger ones take their time by right

bool is_finite(const terrain::Terrain& read) {
    for (const float height : read.heightfield.heights.samples()) {
        if (!std::isfinite(height)) {
            return false;
        }
    }
    return true;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const fuzz::InputFolder folder;
    static const auto source = folder.write("source.asc", fuzz::made_dem(17)); // for a.vrt
    const auto path = fuzz::write_as_kind(folder, fuzz::text_of(data, size), kinds);
    const auto info = io::read_raster_info(path);
    if (info && static_cast<double>(info->cols) * info->rows > max_samples) {
        return 0;
    }
    io::RasterOptions options;
    options.memory_budget = std::size_t{2} << 20;
    if (const auto read = io::read_terrain(path, options)) {
        fuzz::expect(is_finite(*read), "finite heights");
    }
    if (const auto tiles = io::TileSet::open(path, {.threads = 1})) {
        io::TileTerrainOptions part;
        part.raster.memory_budget = options.memory_budget;
        part.threads = 1;
        const auto read = tiles->terrain(part);
        fuzz::expect(!read || is_finite(*read), "finite heights of tiles");
    }
    return 0;
}

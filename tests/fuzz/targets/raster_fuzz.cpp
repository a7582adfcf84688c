// Rasters of all formats, as `reljef` reads them: whole, as a set of tiles, and their metadata.
#include <array>
#include <cmath>

#include "engine/io/terrain_file.h"
#include "engine/io/tile_set.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/made_dem.h"

namespace reljef::fuzz {
namespace {

constexpr std::array raster_kinds{FileKind{"a.tif"},          FileKind{"a.zip"},
                                  FileKind{"a.gz"},           FileKind{"a.gtx"},
                                  FileKind{"a.byn"},          FileKind{"a.tga"},
                                  FileKind{"a.xyz"},          FileKind{"a.bt"},
                                  FileKind{"a.vrt"},          FileKind{"a.asc", "a.prj"},
                                  FileKind{"a.bil", "a.hdr"}, FileKind{"a.rst", "a.rdc"},
                                  FileKind{"a.png", "a.pgw"}, FileKind{"a.sdat", "a.sgrd"}};

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

void raster_target(std::string_view input) {
    static const InputFolder folder;
    static const auto source = folder.write("source.asc", made_dem(17)); // for a.vrt
    const auto path = write_as_kind(folder, input, raster_kinds);
    const auto info = io::read_raster_info(path);
    if (info && static_cast<double>(info->cols) * info->rows > max_samples) {
        return;
    }
    io::RasterOptions options;
    options.memory_budget = std::size_t{2} << 20;
    if (const auto read = io::read_terrain(path, options)) {
        expect(is_finite(*read), "finite heights");
    }
    if (const auto tiles = io::TileSet::open(path, {.threads = 1})) {
        io::TileTerrainOptions part;
        part.raster.memory_budget = options.memory_budget;
        part.threads = 1;
        const auto read = tiles->terrain(part);
        expect(!read || is_finite(*read), "finite heights of tiles");
    }
}

} // namespace reljef::fuzz

// Images that are draped over a terrain.
#include <array>

#include "engine/io/terrain_file.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/made_dem.h"

namespace reljef::fuzz {

void imagery_target(std::string_view input) {
    constexpr std::array kinds{FileKind{"i.png", "i.pgw"}, FileKind{"i.jpg", "i.jgw"},
                               FileKind{"i.tif"}, FileKind{"i.jp2"}, FileKind{"i.vrt"}};
    constexpr double max_pixels = 1 << 20;
    static const InputFolder folder;
    static const auto dem = folder.write("dem.asc", made_dem(17));
    const auto image = write_as_kind(folder, input, kinds);
    const auto info = io::read_raster_info(image);
    if (info && static_cast<double>(info->cols) * info->rows > max_pixels) {
        return;
    }
    io::RasterOptions options;
    options.memory_budget = std::size_t{2} << 20;
    options.imagery = {image};
    static_cast<void>(io::read_terrain(dem, options));
}

} // namespace reljef::fuzz

// Images that are draped over a terrain.
#include <array>

#include "engine/io/terrain_file.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/made_dem.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace reljef;
    constexpr std::array kinds{fuzz::FileKind{"i.png", "i.pgw"}, fuzz::FileKind{"i.jpg", "i.jgw"},
                               fuzz::FileKind{"i.tif"}, fuzz::FileKind{"i.jp2"},
                               fuzz::FileKind{"i.vrt"}};
    constexpr double max_pixels = 1 << 20;
    static const fuzz::InputFolder folder;
    static const auto dem = folder.write("dem.asc", fuzz::made_dem(17));
    const auto image = fuzz::write_as_kind(folder, fuzz::text_of(data, size), kinds);
    const auto info = io::read_raster_info(image);
    if (info && static_cast<double>(info->cols) * info->rows > max_pixels) {
        return 0;
    }
    io::RasterOptions options;
    options.memory_budget = std::size_t{2} << 20;
    options.imagery = {image};
    static_cast<void>(io::read_terrain(dem, options));
    return 0;
}

// Geoids of GeographicLib and of GDAL.
#include <array>

#include "engine/io/formats/geoid_file.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace reljef;
    constexpr std::array kinds{fuzz::FileKind{"g.pgm"}, fuzz::FileKind{"g.tif"},
                               fuzz::FileKind{"g.gtx"}, fuzz::FileKind{"g.asc"},
                               fuzz::FileKind{"g.byn"}};
    static const fuzz::InputFolder folder;
    const auto path = fuzz::write_as_kind(folder, fuzz::text_of(data, size), kinds);
    if (const auto geoid = io::read_geoid(path)) {
        for (const double latitude : {-90.0, -45.5, 0.0, 45.0005, 90.0}) {
            for (const double longitude : {-180.0, -0.1, 6.0005, 180.0, 359.9}) {
                static_cast<void>(geoid->undulation(latitude, longitude));
            }
        }
    }
    return 0;
}

// Geoids of GeographicLib and of GDAL.
#include <array>

#include "engine/io/formats/geoid_file.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {

void geoid_target(std::string_view input) {
    constexpr std::array kinds{FileKind{"g.pgm"}, FileKind{"g.tif"}, FileKind{"g.gtx"},
                               FileKind{"g.asc"}, FileKind{"g.byn"}};
    static const InputFolder folder;
    const auto path = write_as_kind(folder, input, kinds);
    if (const auto geoid = io::read_geoid(path)) {
        for (const double latitude : {-90.0, -45.5, 0.0, 45.0005, 90.0}) {
            for (const double longitude : {-180.0, -0.1, 6.0005, 180.0, 359.9}) {
                static_cast<void>(geoid->undulation(latitude, longitude));
            }
        }
    }
}

} // namespace reljef::fuzz

// Outlines of buildings, of all formats.
#include <array>
#include <cmath>

#include "engine/building/building_faces.h"
#include "engine/io/footprints/footprint_file.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {
namespace {

void expect_shape(const building::Footprint& shape) {
    std::size_t corners = 0;
    for (const building::Ring& ring : shape.rings) {
        corners += ring.size();
        for (const glm::dvec2 corner : ring) {
            expect(std::isfinite(corner.x) && std::isfinite(corner.y), "corners that are numbers");
        }
    }
    expect(!shape.triangles.empty(), "an area");
    for (const glm::uvec3 triangle : shape.triangles) {
        expect(triangle.x < corners && triangle.y < corners && triangle.z < corners,
               "triangles between the corners");
    }
}

} // namespace

void footprints_target(std::string_view input) {
    constexpr std::array kinds{FileKind{"p.geojson"}, FileKind{"p.shp", "p.dbf"},
                               FileKind{"p.gpkg"}, FileKind{"p.fgb"}, FileKind{"p.kml"}};
    static const InputFolder folder;
    const auto path = write_as_kind(folder, input, kinds);
    for (const bool on_earth : {true, false}) {
        const auto file = io::read_footprints(path, {.height = "h", .on_earth = on_earth});
        if (!file) {
            expect(!file.error().message.empty(), "a reason");
            continue;
        }
        for (const io::FileFootprint& found : file->footprints) {
            expect(found.height && *found.height > 0.0 && *found.height <= 1000.0, "a height");
            expect_shape(found.shape);
            building::building_of(found.shape, building::RoofKind::hipped, -1.0, *found.height);
        }
    }
}

} // namespace reljef::fuzz

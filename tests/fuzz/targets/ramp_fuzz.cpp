// Colour files.
#include <algorithm>
#include <cmath>

#include "engine/io/formats/ramp_file.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {
namespace {

terrain::Heightfield two_heights() {
    terrain::Heightfield field;
    field.heights = Grid<float>(2, 2);
    field.heights(1, 1) = 1.0F;
    field.range = {-100.0F, 3000.0F};
    return field;
}

bool is_color(glm::vec3 color) {
    return glm::all(glm::greaterThanEqual(color, glm::vec3(0.0F))) &&
           glm::all(glm::lessThanEqual(color, glm::vec3(255.0F)));
}

} // namespace

void ramp_target(std::string_view input) {
    static const terrain::Heightfield field = two_heights();
    const auto ramp = io::parse_ramp(input, "ramp.txt");
    if (!ramp) {
        expect(!ramp.error().message.empty(), "a reason");
        return;
    }
    expect(!ramp->stops.empty(), "a stop");
    const terrain::RampColors colors(*ramp, field);
    for (const double height : {-1e9, -100.0, 0.0, 1234.5, 3000.0, 1e9}) {
        expect(is_color(colors.at(height)), "colours of 0 to 255");
    }
}

} // namespace reljef::fuzz

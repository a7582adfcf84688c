// Scene files.
#include <cmath>

#include "engine/io/formats/scene_file.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {

void scene_target(std::string_view input) {
    const auto scene = io::parse_scene(input, "scene.toml", "/folder");
    if (scene) {
        expect(scene->generator.empty() != scene->heights.empty(), "one source of heights");
        expect(scene->size >= 16 && scene->size <= 4096, "a size in its range");
        expect(scene->exaggeration > 0.0 && scene->exaggeration <= 1000.0,
               "an exaggeration in its range");
        expect(std::abs(scene->sun_altitude.value_or(0.0)) <= 90.0, "an altitude of the sun");
    } else {
        expect(!scene.error().message.empty(), "a reason");
    }
}

} // namespace reljef::fuzz

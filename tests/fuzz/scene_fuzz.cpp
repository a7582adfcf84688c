// Scene files.
#include <cmath>

#include "engine/io/formats/scene_file.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace reljef;
    const auto scene = io::parse_scene(fuzz::text_of(data, size), "scene.toml", "/folder");
    if (scene) {
        fuzz::expect(scene->generator.empty() != scene->heights.empty(), "one source of heights");
        fuzz::expect(scene->size >= 16 && scene->size <= 4096, "a size in its range");
        fuzz::expect(scene->exaggeration > 0.0 && scene->exaggeration <= 1000.0,
                     "an exaggeration in its range");
        fuzz::expect(scene->sun_altitude > 0.0 && scene->sun_altitude <= 90.0,
                     "a sun above the horizon");
    } else {
        fuzz::expect(!scene.error().message.empty(), "a reason");
    }
    return 0;
}

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/runner/benchmark_scene.h"
#include "engine/session/scene_renderer.h"

namespace reljef::bench {

/// Where floats may round differently without a kind of skipping.
enum class SkipRounding {
    none,  ///< the picture has the same bits
    hits,  ///< rays begin or enter cells elsewhere: hits move within the error of rounding
    colors ///< drivers approximate exp(0): colours move by one level of 255 at most
};

/// A kind of skipping.
struct SkipKind {
    std::string_view name;    ///< "beams"
    std::string_view meaning; ///< what it skips
    void (*switch_off)(session::SceneRendererOptions& options) = nullptr;
    SkipRounding rounding = SkipRounding::none;
};

/// What is drawn with and without some kinds of skipping.
struct SkipTest {
    std::string name;
    scene::Technique technique;
    bool by_rays = false;
    Daylight daylight = Daylight::scene;
    bool is_streamed = false; ///< needs a file that is read tile by tile
    std::vector<SkipKind> kinds;
};

/// The tests of the suite skip, with every kind of skipping of the program.
std::vector<SkipTest> skip_tests();

} // namespace reljef::bench

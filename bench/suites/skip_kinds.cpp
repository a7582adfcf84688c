#include "bench/suites/skip_kinds.h"

namespace reljef::bench {
namespace {

using Options = session::SceneRendererOptions;

namespace kinds {

// Of the selection.
constexpr SkipKind frustum{"frustum", "tiles outside the frustum",
                           [](Options& options) { options.select.frustum = false; }};
constexpr SkipKind occlusion{"occlusion", "tiles behind nearer ground",
                             [](Options& options) { options.select.occlusion = false; }};
constexpr SkipKind order{"order", "pixels behind nearer tiles, which are drawn first",
                         [](Options& options) { options.select.front_to_back = false; }};
constexpr SkipKind selection{"selection", "the selection of an unchanged view",
                             [](Options& options) { options.selects_always = true; }};

// Of OpenGL.
constexpr SkipKind cuts{"triangles", "new triangles for tiles that keep theirs",
                        [](Options& options) { options.opengl->skips.cuts = false; }};
constexpr SkipKind uploads{"uploads", "content that is in GPU memory",
                           [](Options& options) { options.opengl->skips.uploads = false; }};
constexpr SkipKind features{"features", "shader code for a sun and air that the scene lacks",
                            [](Options& options) { options.opengl->skips.features = false; },
                            SkipRounding::colors};
constexpr SkipKind beams{"beams", "the way on which no ray of 8 by 8 pixels hits",
                         [](Options& options) { options.opengl->skips.beams = false; },
                         SkipRounding::hits};
constexpr SkipKind blocks{"blocks", "blocks of the maximum mipmap below the ray",
                          [](Options& options) { options.opengl->skips.blocks = false; },
                          SkipRounding::hits};

constexpr SkipKind certain{"certain light",
                           "sun rays from cells that are certainly lit or in shadow",
                           [](Options& options) { options.opengl->skips.certain = false; }};

// Of rays on the CPU.
constexpr SkipKind content{"content", "what is made of the terrain already",
                           [](Options& options) { options.rays->keeps_content = false; }};
constexpr SkipKind free_space{"free space", "the way on which no ray of 32 by 32 pixels hits",
                              [](Options& options) { options.rays->skips.free_space = false; }};
constexpr SkipKind packet_beams{"beams", "the way on which no ray of 8 by 2 pixels hits",
                                [](Options& options) { options.rays->skips.beams = false; }};
constexpr SkipKind ray_blocks{"blocks", "blocks of the maximum mipmap below the ray",
                              [](Options& options) { options.rays->skips.blocks = false; }};
constexpr SkipKind ray_cells{"cells", "cells below the ray",
                             [](Options& options) { options.rays->skips.cells = false; }};
constexpr SkipKind ray_certain{"certain light",
                               "sun rays from cells that are certainly lit or in shadow",
                               [](Options& options) { options.rays->skips.certain = false; }};

} // namespace kinds

scene::Technique polygons_within(double error_px) {
    return {scene::Polygons{.max_levels = 1, .error = error_px}};
}

scene::Technique exact_with_hard_shadows() {
    scene::Technique technique{scene::Exact{}};
    technique.options.shadow.emplace().depth = 0.0;
    return technique;
}

} // namespace

std::vector<SkipTest> skip_tests() {
    using namespace kinds;
    const scene::Technique polygons = polygons_within(1.0);
    const scene::Technique every_sample = polygons_within(0.0);
    const scene::Technique exact{scene::Exact{}};
    const scene::Technique shadow = exact_with_hard_shadows();
    constexpr Daylight day = Daylight::scene;
    return {
        {"polygons",
         polygons,
         false,
         day,
         false,
         {frustum, occlusion, order, selection, cuts, uploads}},
        {"polygons, every sample", every_sample, false, day, false, {frustum, occlusion, order}},
        {"exact", exact, false, day, false, {beams, blocks, uploads}},
        {"exact, shadows", shadow, false, day, false, {beams, blocks, certain}},
        {"exact, low sun", shadow, false, Daylight::low_sun, false, {certain}},
        {"exact, shadows, night", shadow, false, Daylight::night, false, {features}},
        {"exact on cpu",
         exact,
         true,
         day,
         false,
         {free_space, packet_beams, ray_blocks, ray_cells, content}},
        {"exact, shadows on cpu",
         shadow,
         true,
         day,
         false,
         {free_space, packet_beams, ray_blocks, ray_cells, ray_certain}},
        {"exact, low sun on cpu", shadow, true, Daylight::low_sun, false, {ray_certain}},
        {"auto", {scene::Automatic{}}, false, day, false, {selection}},
        {"streamed polygons", polygons, false, day, true, {occlusion, selection, cuts, uploads}},
        {"streamed on cpu",
         polygons,
         true,
         day,
         true,
         {occlusion, free_space, packet_beams, content}}};
}

} // namespace reljef::bench

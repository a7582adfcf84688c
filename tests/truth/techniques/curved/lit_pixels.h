#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/core/bilinear.h"
#include "engine/core/color.h"
#include "engine/scene/streaming/terrain_light.h"
#include "engine/truth/scene_caster.h"
#include "engine/truth/shading.h"
#include "tests/render/earth_stage.h"

namespace reljef::test {

/// Whether the sun lights what a pixel shows; nothing where it cannot light anything.
inline std::vector<std::optional<bool>> lit_pixels(const EarthStage& stage, glm::ivec2 size) {
    const scene::Light sun = *stage.scene.sun();
    const truth::SceneCaster caster = truth::SceneCaster::create(stage.scene).value();
    const scene::TerrainIrradiance irradiance(stage.surface(), {sun, glm::dmat3(1.0)});
    const HitBuffer& hits = stage.true_hits(size);
    std::vector<std::optional<bool>> lit(hits.size());
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const Hit& hit = hits.samples()[i];
        if (hit.is_sky() || irradiance.parts_at(hit.place()).sun.r < 0.05F) {
            continue;
        }
        truth::SceneHit there;
        there.surface.sample = {
            hit.place(),
            terrain::bilinear_height(stage.surface().heightfield().heights.view(), hit.place())};
        lit[i] = truth::sees_sun(caster, there, scene::to_light(sun));
    }
    return lit;
}

/// Of the pixels that the sun may light, those that it lights or not.
inline std::size_t count_of(const std::vector<std::optional<bool>>& lit, bool is_lit) {
    std::size_t count = 0;
    for (const std::optional<bool>& pixel : lit) {
        count += pixel == is_lit ? 1U : 0U;
    }
    return count;
}

/// Of the pixels that the sun may light, those that are black though it does or not though it does
/// not, percent.
inline double wrongly_lit(const std::vector<std::optional<bool>>& lit, const Image& shown) {
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < lit.size(); ++i) {
        wrong += lit[i] && (shown.samples()[i].r != 0) != *lit[i] ? 1U : 0U;
    }
    return 100.0 * static_cast<double>(wrong) /
           static_cast<double>(count_of(lit, true) + count_of(lit, false));
}

} // namespace reljef::test

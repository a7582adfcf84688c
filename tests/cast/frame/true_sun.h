#pragma once

#include <array>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/vec2.hpp>

#include "engine/scene/graph/scene.h"
#include "engine/truth/eye.h"
#include "engine/truth/scene_caster.h"
#include "engine/truth/shading.h"
#include "tests/terrain/chance.h"

namespace reljef::test {

/// White light of the sun alone: what it reaches is bright, however steep, and all else is black.
inline scene::Light bright_sun(double azimuth, double altitude) {
    return {azimuth, altitude, glm::vec3(50.0F), glm::vec3(0.0F)};
}

/// By how much a picture may move the rays whose light it shows.
struct SunTolerance {
    double pixels = 0.01;  ///< of the view ray
    double radians = 1e-5; ///< of the direction to the sun: a thousandth of its disc
    double metres = 0.0;   ///< above the surface, where rays to the sun begin at most
};

enum class TrueLight {
    none,     ///< the pixel shows the sky, or what is turned away from the sun
    unstable, ///< it changes within the tolerance
    lit,
    hidden
};

/// What the truth's own rays say of the pixels of a scene with one terrain, meshes and a sun.
class TrueSun {
public:
    TrueSun(const scene::Scene& scene, glm::ivec2 size, const SunTolerance& tolerance)
        : caster_(truth::SceneCaster::create(scene).value()),
          eye_(scene.camera(), size, caster_.bounds()), sun_(*scene.sun()), tolerance_(tolerance),
          irradiance_(*caster_.terrains().front().surface,
                      {sun_, glm::dmat3(caster_.terrains().front().world_from_local)}) {}

    [[nodiscard]] TrueLight at(glm::dvec2 place) const {
        const Seen seen = seen_at(place);
        if (sunlight_of(seen) < 1.0F) {
            return TrueLight::none;
        }
        const bool is_lit = sees(seen, scene::to_light(sun_));
        return is_stable(place, seen, is_lit) ? (is_lit ? TrueLight::lit : TrueLight::hidden)
                                              : TrueLight::unstable;
    }

private:
    static constexpr std::array<glm::dvec2, 4> ways{
        {{-1.0, -1.0}, {1.0, -1.0}, {-1.0, 1.0}, {1.0, 1.0}}};

    // The nearest of both.
    struct Seen {
        Ray ray;
        std::optional<truth::SceneHit> ground;
        std::optional<truth::MeshHit> mesh;
    };

    [[nodiscard]] Seen seen_at(glm::dvec2 place) const {
        Seen seen{eye_.ray(place), {}, {}};
        Interval range = eye_.range();
        seen.ground = caster_.first_hit(seen.ray, range);
        range.end = seen.ground ? seen.ground->surface.t : range.end;
        seen.mesh = caster_.meshes().first_hit(seen.ray, range);
        return seen;
    }
    // If nothing hides the sun.
    [[nodiscard]] float sunlight_of(const Seen& seen) const {
        if (seen.mesh) {
            return caster_.meshes().color_at(*seen.mesh, sun_).r;
        }
        return seen.ground ? irradiance_.parts_at(glm::dvec2(seen.ground->surface.sample)).sun.r
                           : 0.0F;
    }
    [[nodiscard]] bool sees(const Seen& seen, glm::dvec3 to_sun) const {
        if (seen.mesh) {
            return truth::sees_sun(caster_, *seen.mesh, seen.ray, to_sun);
        }
        return seen.ground && truth::sees_sun(caster_, *seen.ground, to_sun);
    }
    [[nodiscard]] bool is_stable(glm::dvec2 place, Seen seen, bool is_lit) const {
        const glm::dvec3 to_sun = scene::to_light(sun_);
        const glm::dvec3 aside = glm::normalize(glm::cross(to_sun, glm::dvec3(0.1, 0.2, 0.97)));
        const glm::dvec3 above = glm::cross(aside, to_sun);
        for (const glm::dvec2 way : ways) {
            const Seen beside = seen_at(place + tolerance_.pixels * way);
            const glm::dvec2 turn = tolerance_.radians * way;
            const glm::dvec3 turned = glm::normalize(to_sun + turn.x * aside + turn.y * above);
            if (beside.mesh.has_value() != seen.mesh.has_value() ||
                sees(beside, to_sun) != is_lit || sees(seen, turned) != is_lit) {
                return false;
            }
        }
        if (seen.ground) {
            seen.ground->surface.sample.z += tolerance_.metres;
        }
        return sees(seen, to_sun) == is_lit;
    }

    truth::SceneCaster caster_;
    truth::Eye eye_;
    scene::Light sun_;
    SunTolerance tolerance_;
    scene::TerrainIrradiance irradiance_;
};

struct LightCounts {
    int lit = 0; ///< pixels whose light is certain
    int hidden = 0;
    int unstable = 0;
    int wrongly_dark = 0;
    int wrongly_lit = 0;

    [[nodiscard]] int wrong() const { return wrongly_dark + wrongly_lit; }
    [[nodiscard]] int certain() const { return lit + hidden; }
    LightCounts& operator+=(const LightCounts& other) {
        lit += other.lit;
        hidden += other.hidden;
        unstable += other.unstable;
        wrongly_dark += other.wrongly_dark;
        wrongly_lit += other.wrongly_lit;
        return *this;
    }
};

inline bool is_bright(Rgba8 pixel) {
    return pixel.r > 0 || pixel.g > 0 || pixel.b > 0;
}

/// Compares random pixels of a picture by bright_sun() with the truth.
inline LightCounts compared_light(const TrueSun& truth, const Image& shown, int pixels,
                                  Chance& chance) {
    LightCounts counts;
    for (int i = 0; i < pixels; ++i) {
        const glm::ivec2 pixel(chance.whole(0, shown.cols() - 1),
                               chance.whole(0, shown.rows() - 1));
        const TrueLight light = truth.at(glm::dvec2(pixel) + 0.5);
        const bool bright = is_bright(shown(pixel.x, pixel.y));
        counts.unstable += light == TrueLight::unstable ? 1 : 0;
        if (light == TrueLight::lit) {
            ++counts.lit;
            counts.wrongly_dark += bright ? 0 : 1;
        } else if (light == TrueLight::hidden) {
            ++counts.hidden;
            counts.wrongly_lit += bright ? 1 : 0;
        }
    }
    return counts;
}

} // namespace reljef::test

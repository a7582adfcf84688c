#pragma once

#include <span>
#include <string_view>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/result.h"
#include "engine/terrain/field/heightfield.h"
#include "terrains/generators.h"

namespace reljef::terrains {

enum class GalleryShape { plane, box, sphere, torus, cylinder, sheet, bowl };

struct GalleryModel {
    GalleryShape shape;
    std::string_view name;
    std::string_view textures; ///< of detail_names()
    glm::dvec3 center;         ///< metres
    double heading;            ///< degrees that the model is turned clockwise, seen from above
    glm::vec3 size; ///< metres: plane and sheet width, height; box sides; sphere and bowl radius;
                    ///< torus ring and tube radius; cylinder radius, height
    glm::vec2 repeats;          ///< of the texture along texture coordinates 0 … 1
    std::string_view technique; ///< the default
    float offset = -1.0F;       ///< of the heights against the shape, as in SurfaceDetail
};

std::span<const GalleryModel> gallery_models();

/// The level floor of the gallery. Errors: a size out of range, a spacing, tileable.
Result<terrain::Terrain> generate_gallery(const GeneratorOptions& options);

} // namespace reljef::terrains

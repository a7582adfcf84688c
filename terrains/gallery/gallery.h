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

/// What stands in the gallery, and where.
struct GalleryModel {
    GalleryShape shape;
    std::string_view name;
    std::string_view textures; ///< of detail_names()
    glm::dvec3 center;         ///< metres
    double heading;            ///< degrees that it is turned clockwise, seen from above
    glm::vec3 size; ///< metres: plane and sheet width, height; box sides; sphere and bowl radius;
                    ///< torus ring and tube radius; cylinder radius, height
    glm::vec2 repeats;          ///< tiles along texture coordinates 0 … 1
    std::string_view technique; ///< that shows what it is
    float offset = -1.0F;       ///< of the heights against the shape, as of a SurfaceDetail
};

std::span<const GalleryModel> gallery_models();

/// The floor of the gallery: level, of slabs, darker where the models stand. Fails when the size is
/// out of range.
Result<terrain::Terrain> generate_gallery(const GeneratorOptions& options);

} // namespace reljef::terrains

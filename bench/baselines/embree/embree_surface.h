#pragma once

#include <memory>
#include <string_view>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/grid.h"
#include "engine/core/hit.h"
#include "engine/core/result.h"
#include "engine/scene/graph/camera.h"

namespace reljef::bench {

/// Embree's two kinds of geometry for a heightfield. Both divide each cell into two triangles.
enum class EmbreeGeometry { grid, quads };
std::string_view to_string(EmbreeGeometry geometry);

/// A heightfield's vertices in Embree's tree, and the rays of pictures.
class EmbreeSurface {
public:
    /// `vertices`: world metres, one per sample, at least 2 × 2. `threads` 0: all of the machine.
    /// Fails as Embree does: without memory, and with a grid of more than 32767 samples a side.
    static Result<EmbreeSurface> create(GridView<const glm::vec3> vertices, EmbreeGeometry geometry,
                                        unsigned threads);

    /// Where the rays of a perspective camera first meet a triangle, by packets of 16 rays from
    /// several threads. Columns and rows are those of the vertices.
    [[nodiscard]] HitBuffer draw_hits(const scene::Camera& camera, glm::ivec2 size) const;

private:
    struct Tree; // Embree's handles
    explicit EmbreeSurface(std::shared_ptr<const Tree> tree) : tree_(std::move(tree)) {}

    std::shared_ptr<const Tree> tree_;
};

} // namespace reljef::bench

#pragma once

#include <glm/vec2.hpp>

#include "engine/core/geometry.h"
#include "engine/render/residency/relief_maps.h"
#include "engine/render/shaders/uniform_blocks.h"
#include "engine/view/draw_list.h"

namespace reljef::render {

/// A draw's search space. Its origin is near the eye, where floats are precise.
struct DrawnSpace {
    ReliefSpace space;
    glm::ivec2 origin{0};          ///< cell at (0, 0)
    glm::dvec2 origin_sample{0.0}; ///< of the terrain
    double samples_a_cell = 1.0;
};

/// Whether a search is over tiles of a stream.
bool is_streamed(const view::TerrainDraw& draw);

/// What may be visible, samples of the terrain's surface and true metres. Precondition: `draw` has
/// a course.
Box visible_samples(const view::TerrainDraw& draw, const ReliefSpace& space);

/// The course of a draw's rays. Precondition: it has one.
CourseBlock course_block(const view::TerrainDraw& draw, const DrawnSpace& drawn,
                         const view::DrawList& list);

} // namespace reljef::render

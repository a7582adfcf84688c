#include "engine/render/passes/course_block.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/geo/georeference.h"
#include "engine/scene/graph/camera.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::render {
namespace {

// With the heights of the search space, and what floats round of the heights of rays: a few units
// of 2^-24 of the eye's, and of the way where places are mapped one by one. So rays begin above and
// end below thin surfaces, too.
Box with_heights(const Box& samples, const view::RayCourse& course, const ReliefSpace& space) {
    constexpr double rounding = 0x1p-21;
    const double lowest = space.sample_of_origin.z;
    const double range = space.samples_per_unit.z;
    const double way = course.degrees ? course.farthest / course.degrees->exaggeration : 0.0;
    const double rounded = rounding * (std::abs(course.eye.z - lowest) + way);
    return {{samples.low.x, samples.low.y, lowest + range * space.box.low.z - rounded},
            {samples.high.x, samples.high.y, lowest + range * space.box.high.z + rounded}};
}

// From samples of a terrain's surface.
glm::dvec3 in_space(const ReliefSpace& space, glm::dvec3 sample) {
    return (sample - space.sample_of_origin) / space.samples_per_unit;
}

void set_light(CourseBlock& block, const view::RayCourse& course, const ReliefSpace& space) {
    const view::LightCourse& light = *course.light;
    const Box crossed = with_heights(light.samples, course, space);
    const double chords = std::sqrt(light.reach * course.curvature / (4.0 * view::max_light_error));
    block.light_begin = glm::vec4(glm::vec3(in_space(space, crossed.low)), light.reach);
    block.light_end = glm::vec4(glm::vec3(in_space(space, crossed.high)), chords);
    for (std::size_t term = 0; term < view::LightCourse::term_count; ++term) {
        block.light_terms[term] =
            glm::vec4(glm::vec3(light.terms[term] / space.samples_per_unit), 0.0F);
    }
}

// Rows as they lie on the Earth, in the space. Rows that close the terrain at a pole are shorter.
struct EvenRows {
    const geo::WrappedRows& rows; // of the terrain
    const DrawnSpace& drawn;

    [[nodiscard]] double in_space(double row) const {
        return (row - drawn.origin_sample.y) / drawn.samples_a_cell;
    }
    [[nodiscard]] double closed(double even) const {
        const double row = drawn.origin_sample.y + even * drawn.samples_a_cell;
        return in_space(rows.from_even_row(row));
    }
    // CourseBlock::degree_rows.
    [[nodiscard]] glm::vec4 from(double even) const {
        const geo::GlobalWrap& wrap = rows.wrap();
        const auto more = [](double part) { return part > 0.0 ? 1.0 / part - 1.0 : 0.0; };
        return {in_space(wrap.north_rows()) - even, more(wrap.north),
                in_space(rows.last_source_row()) - even, more(wrap.south)};
    }
};

// As CourseBlock::degree_circle.
double poles_of(const geo::GlobalWrap& wrap) {
    return wrap.around ? (wrap.begins_at_pole ? 1.0 : 0.0) + (wrap.ends_at_pole ? 2.0 : 0.0) : 0.0;
}

void set_degrees(CourseBlock& block, const view::TerrainDraw& draw, const DrawnSpace& drawn,
                 const view::DrawList& list) {
    const view::DegreeCourse& degrees = *draw.search->course->degrees;
    const ReliefSpace& space = drawn.space;
    const glm::dvec2 per_unit(space.samples_per_unit);
    const glm::dvec2 earth = geo::radii_of_earth();
    const double stretch = max_stretch(glm::dmat3(draw.world_from_local));
    const Box visible = visible_samples(draw, space);
    // Ground of one height is beside an ellipsoid by far less than a hundredth of it.
    const double highest = 1.01 * degrees.exaggeration * std::max(visible.high.z, 0.0);
    const glm::dvec2 pixel(scene::metres_a_pixel(list.camera, list.size));
    const EvenRows rows{is_streamed(draw) ? draw.terrain->stream->maker().rows() : degrees.rows,
                        drawn};
    const glm::dvec3 eye = in_space(space, degrees.eye);
    block.course_eye = glm::vec4(eye.x, rows.closed(eye.y), eye.z, 0.0);
    block.degree_eye = glm::vec4(degrees.from_axis, degrees.lift, degrees.first_lift,
                                 1.0 / (degrees.exaggeration * space.samples_per_unit.z));
    block.degree_circle =
        glm::vec4(degrees.circle, degrees.first_longitude, poles_of(rows.rows.wrap()));
    block.degree_earth = glm::vec4(earth, earth.x / earth.y, highest);
    block.degree_samples =
        glm::vec4(degrees.samples_a_radian[0] / per_unit, degrees.samples_a_radian[1] / per_unit);
    block.degree_rows = rows.from(eye.y);
    const glm::dvec2 chords = view::max_degree_chord_error * glm::dvec2(pixel.y, pixel.x / stretch);
    block.degree_chords = glm::vec4(chords, view::max_light_error, 0.0);
    const auto begin_at = [&](glm::dvec2 place) {
        return scene::view_ray(list.camera, list.size, place).origin - list.camera.eye;
    };
    const glm::dvec2 extent(list.size);
    const glm::dvec3 corner = begin_at({0.0, extent.y});
    block.degree_corner = glm::vec4(glm::vec3(corner), 0.0F);
    block.degree_right = glm::vec4(glm::vec3(begin_at(extent) - corner), 0.0F);
    block.degree_up = glm::vec4(glm::vec3(begin_at({0.0, 0.0}) - corner), 0.0F);
}

} // namespace

bool is_streamed(const view::TerrainDraw& draw) {
    return !draw.search->tiles.empty();
}

Box visible_samples(const view::TerrainDraw& draw, const ReliefSpace& space) {
    const view::RayCourse& course = *draw.search->course;
    return with_heights(course.samples, course, space);
}

CourseBlock course_block(const view::TerrainDraw& draw, const DrawnSpace& drawn,
                         const view::DrawList& list) {
    const view::RayCourse& course = *draw.search->course;
    const ReliefSpace& space = drawn.space;
    const Box visible = visible_samples(draw, space);
    const double chord_error =
        view::max_chord_error * scene::metres_a_pixel(list.camera, list.size).y;
    CourseBlock block{};
    block.unit_from_relative = glm::mat4(glm::mat3(course.unit_from_relative));
    block.course_begin = glm::vec4(glm::vec3(in_space(space, visible.low)), 0.0F);
    block.course_end = glm::vec4(glm::vec3(in_space(space, visible.high)), 0.0F);
    if (course.light) {
        set_light(block, course, space);
    }
    if (course.degrees) {
        set_degrees(block, draw, drawn, list);
        return block;
    }
    block.course_eye = glm::vec4(glm::vec3(in_space(space, course.eye)),
                                 std::sqrt(course.curvature / (4.0 * chord_error)));
    block.course_scale =
        glm::vec4(glm::vec3(course.min_metres * space.samples_per_unit), course.curvature);
    for (std::size_t term = 0; term < view::RayCourse::term_count; ++term) {
        block.course_terms[term] =
            glm::vec4(glm::vec3(course.terms[term] / space.samples_per_unit), 0.0F);
    }
    return block;
}

} // namespace reljef::render

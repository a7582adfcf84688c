#include "engine/cast/frame/ground_detail.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <span>
#include <utility>
#include <variant>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "engine/cast/lit_levels.h"
#include "engine/cast/mesh/picture_levels.h"

namespace reljef::cast {
namespace {

// With the texels of the other sides around it.
template <class T, class Pack>
void add_repeated(const Grid<T>& level, const Pack& pack, std::vector<std::uint32_t>& texels) {
    for (int row = -1; row <= level.rows(); ++row) {
        for (int col = -1; col <= level.cols(); ++col) {
            texels.push_back(pack(
                level((col + level.cols()) % level.cols(), (row + level.rows()) % level.rows())));
        }
    }
}

// Appends all levels of a map.
template <class T, class Value, class Pack>
RepeatedMap repeated(const Grid<T>& map, const Value& value, const Pack& pack,
                     std::vector<std::uint32_t>& texels) {
    RepeatedMap made;
    made.size = {map.cols(), map.rows()};
    made.level_count = 0;
    Grid<glm::vec3> level(map.cols(), map.rows());
    std::ranges::transform(map.samples(), level.samples().begin(), value);
    while (true) {
        made.begin.at(static_cast<std::size_t>(made.level_count++)) =
            static_cast<std::int32_t>(texels.size());
        add_repeated(level, pack, texels);
        if (level.size() == 1 || made.level_count == RepeatedMap::max_levels) {
            std::fill(made.begin.begin() + made.level_count, made.begin.end(),
                      made.begin.at(static_cast<std::size_t>(made.level_count) - 1));
            return made;
        }
        level = half_as_large(level, std::identity());
    }
}

std::vector<float> repeated_heights(const Grid<float>& heights) {
    std::vector<float> repeated;
    for (int row = 0; row <= heights.rows(); ++row) {
        for (int col = 0; col <= heights.cols(); ++col) {
            repeated.push_back(heights(col % heights.cols(), row % heights.rows()));
        }
    }
    return repeated;
}

glm::vec3 mean_of(const Image& color) {
    const glm::dvec3 sum = std::accumulate(
        color.samples().begin(), color.samples().end(), glm::dvec3(0.0),
        [](glm::dvec3 sum, Rgba8 texel) { return sum + glm::dvec3(linear_from_rgba8(texel)); });
    return glm::vec3(sum / static_cast<double>(color.size()));
}

// What a technique without a search shows is the normals alone.
struct SearchSteps {
    DetailSearch operator()(const scene::Parallax& /*parallax*/) const { return {.shifts = true}; }
    DetailSearch operator()(const scene::ParallaxLimited& /*parallax*/) const {
        return {.shifts = true, .is_limited = true};
    }
    DetailSearch operator()(const scene::ParallaxIterated& parallax) const {
        return {.shifts = true, .iterations = parallax.iterations};
    }
    DetailSearch operator()(const scene::Steep& steep) const {
        return {steep.linear_steps, steep.linear_steps};
    }
    DetailSearch operator()(const scene::Relief& relief) const {
        return {relief.linear_steps, relief.linear_steps, relief.bisection_steps};
    }
    DetailSearch operator()(const scene::Interval& interval) const {
        return {interval.linear_steps, interval.linear_steps, 0, interval.secant_steps};
    }
    DetailSearch operator()(const scene::Pom& pom) const {
        return {pom.min_steps, pom.max_steps, 0, 1};
    }
    template <class Other> DetailSearch operator()(const Other& /*other*/) const { return {}; }
};

DetailSearch search_of(const scene::Technique& technique) {
    DetailSearch search = std::visit(SearchSteps(), technique.parameters);
    if (const auto& steps = technique.options.steps; steps && search.steps_from_above > 0) {
        search.steps_from_above = steps->low;
        search.steps_along_ground = steps->high;
    }
    return search;
}

} // namespace

DetailMaps::DetailMaps(const material::ReliefMaterial& set)
    : heights_(repeated_heights(set.heights)) {
    paint_.color = repeated(set.color, linear_from_rgba8, packed_roots, color_texels_);
    paint_.normals = repeated(set.normals, std::identity(), packed_normal, normal_texels_);
    paint_.samples = {set.heights.cols(), set.heights.rows()};
    constexpr float darkest = 1.0F / 255.0F; // divided by
    paint_.mean_color = glm::max(mean_of(set.color), glm::vec3(darkest));
    paint_.specular = set.specular;
    paint_.shininess = set.shininess;
}

void DetailMaps::paint(DetailPaint& paint) const {
    paint = paint_;
    paint.color.texels = color_texels_.data();
    paint.normals.texels = normal_texels_.data();
    paint.heights = heights_.data();
}

bool draws_detail(const scene::Technique& technique) {
    scene::TechniqueOptions drawn;
    drawn.steps = technique.options.steps;
    const DetailSearch search = search_of(technique);
    return technique.options == drawn && (technique.id() == scene::TechniqueId::normal ||
                                          search.shifts || search.steps_from_above > 0);
}

bool shows_detail(const view::DrawList& list, const scene::TerrainNode& terrain) {
    return std::ranges::any_of(list.tiles, [&](const view::TileDraw& draw) {
        return draw.terrain == &terrain && draw.detail != view::DetailLevel::none;
    });
}

const DetailPaint* GroundDetail::prepare(const view::DrawList& list, const SeenTerrain& seen) {
    if (!shows_detail(list, *seen.node)) {
        if (!view::has_detail(*seen.node)) {
            maps_.reset();
            owner_.reset();
        }
        return nullptr;
    }
    const scene::TerrainDetail& detail = *seen.node->detail;
    if (maps_ == nullptr || owner_.lock() != detail.set) {
        maps_ = std::make_shared<const DetailMaps>(*detail.set);
        owner_ = detail.set;
    }
    maps_->paint(paint_);
    paint_.search = search_of(detail.technique);
    paint_.width = static_cast<float>(detail.width);
    paint_.lift = detail.scale * paint_.width;
    paint_.steeper = detail.scale / detail.set->scale;
    const glm::dmat4 local_from_world = glm::inverse(seen.world_from_local);
    const glm::dvec3 eye(local_from_world * glm::dvec4(list.camera.eye, 1.0));
    paint_.copies_at_eye = glm::vec3(glm::fract(eye / detail.width));
    paint_.local_from_world = glm::mat3(glm::dmat3(local_from_world));
    const glm::dvec3 up = seen.node->surface->placement().up(eye);
    paint_.up = glm::vec3(glm::normalize(glm::dmat3(seen.world_from_local) * up));
    paint_.seen_width = view::seen_tile_pixels;
    paint_.seen_height = view::seen_height_pixels(*seen.node);
    paint_.metres_a_pixel = scene::metres_a_pixel(list.camera, list.size);
    return &paint_;
}

} // namespace reljef::cast

#include "engine/cast/frame/painter.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <optional>
#include <span>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/cast/frame/base_walls.h"
#include "engine/cast/frame/ground_points.h"
#include "engine/scene/graph/camera.h"
#include "engine/scene/graph/daylight.h"

namespace reljef::cast {
namespace {

bool is_perspective(const view::DrawList& list) {
    return list.camera.projection == scene::ProjectionKind::perspective;
}

// The rays in world metres from the eye.
PictureRays rays_from_eye(const view::DrawList& list) {
    return local_rays(list.camera, list.size, glm::translate(glm::dmat4(1.0), list.camera.eye), {});
}

BlockPaint backdrop_of(const view::DrawList& list) {
    BlockPaint paint;
    if (list.sky) {
        paint.has_sky = true;
        const scene::Sky& sky = *list.sky;
        const scene::AirSeen air = scene::air_seen(sky, list.camera);
        paint.horizon = sky.horizon;
        paint.zenith = sky.zenith;
        paint.glow = sky.glow;
        paint.curve = sky.curve;
        paint.plane_air = air.plane_air;
        paint.plane = sky.plane.value_or(glm::vec3(0.0F));
        // On a map there is no viewing distance.
        paint.has_air = is_perspective(list) && sky.visibility > 0.0;
        paint.extinction = air.extinction;
        paint.eye_above = air.eye_above;
        paint.eye_density = air.eye_density;
        paint.per_height = air.per_height;
        paint.up = air.up;
        paint.bend = air.bend;
    }
    if (list.sun) {
        paint.has_sun = true;
        paint.sun = list.sun->color;
        paint.to_sun = glm::vec3(scene::to_light(*list.sun));
    }
    return paint;
}

// The bytes of a pixel are those of Rgba8.
static_assert(std::endian::native == std::endian::little);

// The middles of a block's pixels, also of those beside the picture.
std::vector<glm::dvec2> middles_of(const PixelBlock& block) {
    std::vector<glm::dvec2> places(block_pixels);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const glm::ivec2 pixel(static_cast<int>(i) % block_side, static_cast<int>(i) / block_side);
        places[i] = glm::dvec2(block.first + pixel) + 0.5;
    }
    return places;
}

std::vector<glm::dvec2> places_of(const SampledPixels& sampled, const PixelBlock& block) {
    std::vector<glm::dvec2> places;
    for (const int pixel : sampled.pixels) {
        const glm::ivec2 in_block(pixel % block_side, pixel / block_side);
        for (int sample = 0; sample < sampled.samples; ++sample) {
            places.push_back(glm::dvec2(block.first + in_block) + 0.5 +
                             glm::dvec2(sampled.places[static_cast<std::size_t>(sample)]));
        }
    }
    return places;
}

void write_block(const BlockPixels& pixels, const PixelBlock& block, Image& picture) {
    const auto width = static_cast<std::size_t>(block.size.x);
    for (int row = 0; row < block.size.y; ++row) {
        const std::uint32_t* const from =
            pixels.rgba.data() + static_cast<std::size_t>(row) * block_side;
        Rgba8* const to = &picture(block.first.x, block.first.y + row);
        std::memcpy(static_cast<void*>(to), from, width * sizeof(Rgba8));
    }
}

void write_depths(const BlockPixels& pixels, const PixelBlock& block, double anchor,
                  Grid<float>& depths) {
    for (int row = 0; row < block.size.y; ++row) {
        const float* const from = pixels.t.data() + static_cast<std::size_t>(row) * block_side;
        std::transform(from, from + block.size.x, &depths(block.first.x, block.first.y + row),
                       [anchor](float t) { return static_cast<float>(anchor + t); });
    }
}

} // namespace

Painter::Painter(const view::DrawList& list, const PlacedTiles& placed,
                 const PainterOptions& options, FirstSamples& first)
    : placed_(placed), skips_(options.skips), meshes_(options.meshes),
      kernel_(block_kernel(options.target.value_or(SimdTarget{}).bit)), shared_(backdrop_of(list)),
      rays_(rays_from_eye(list)), point_lights_(point_light_paints(list)), walls_(base_walls(list)),
      corner_(view::dither_origin(list.camera, list.size)), picture_{-list.camera.first,
                                                                     scene::whole_picture(
                                                                         list.camera, list.size)},
      first_(first), depths_(options.depths),
      anchor_(placed.tiles.empty() ? 0.0 : placed.tiles.front().rays.anchor),
      jobs_(static_cast<std::size_t>(block_count(list.size))), sampled_(jobs_.size()) {
    shared_.anchor = static_cast<float>(anchor_);
    const std::span<const glm::ivec2> places = sixteenths_of(options.samples);
    samples_.samples = static_cast<int>(places.size());
    shared_.is_perspective = first.is_perspective;
    shared_.needs_nearness = has_samples();
    shared_.needs_t = depths_ != nullptr;
    shared_.detail = options.detail;
    shared_.grain = options.grain;
    shared_.facades = options.facades;
    shared_.sky = options.sky;
    shared_.point_lights = point_lights_;
    shared_.world_from_normal = options.world_from_normal;
    shared_.contours = options.contours;
    shared_.mesh_shadow = meshes_ != nullptr ? meshes_->shadow() : MeshShadow{};
    std::transform(places.begin(), places.end(), samples_.places.begin(),
                   [](glm::ivec2 place) { return glm::vec2(place) / 16.0F; });
}

void Painter::paint(const PixelBlock& block, std::size_t index) {
    std::vector<BlockJob> jobs = block_jobs(placed_, block, skips_);
    BlockPixels pixels;
    BlockPaint paint = paint_of(block, index);
    const auto meshes =
        shows_meshes(index) ? std::optional(meshes_->look(index, middles_of(block))) : std::nullopt;
    const BlockMeshes values = meshes ? meshes->values() : BlockMeshes{};
    paint.meshes = meshes ? &values : nullptr;
    kernel_.paint({jobs, placed_.has_walls}, paint, pixels);
    write_block(pixels, block, first_.picture);
    if (depths_ != nullptr) {
        write_depths(pixels, block, anchor_, *depths_);
    }
    if (samples_.samples > 1) {
        first_.add_nearness(pixels, block, picture_, kernel_);
        jobs_[index] = std::move(jobs);
    }
}

std::size_t Painter::count(const PixelBlock& block, std::size_t index,
                           Grid<view::PixelWork>& pixels) const {
    std::vector<BlockJob> jobs = block_jobs(placed_, block, skips_);
    BlockWork work;
    kernel_.count({jobs, placed_.has_walls}, paint_of(block, index), work);
    for (int row = 0; row < block.size.y; ++row) {
        for (int col = 0; col < block.size.x; ++col) {
            const auto at =
                static_cast<std::size_t>(row) * block_side + static_cast<std::size_t>(col);
            pixels(block.first.x + col,
                   block.first.y + row) = {static_cast<std::uint32_t>(work.taps[at]),
                                           static_cast<std::uint32_t>(work.steps[at]),
                                           static_cast<std::uint32_t>(work.rays[at])};
        }
    }
    return work.beam_taps;
}

void Painter::choose_sampled(const PixelBlock& block, std::size_t index) {
    sampled_[index] = sampled_pixels(first_, kernel_, block);
}

void Painter::sample(const PixelBlock& block, std::size_t index) {
    SampledPixels sampled = samples_;
    sampled.pixels = sampled_[index];
    if (sampled.pixels.empty()) {
        return;
    }
    BlockPixels pixels;
    BlockPaint paint = paint_of(block, index);
    const auto meshes = shows_meshes(index)
                            ? std::optional(meshes_->look(index, places_of(sampled, block)))
                            : std::nullopt;
    const BlockMeshes values = meshes ? meshes->values() : BlockMeshes{};
    paint.meshes = meshes ? &values : nullptr;
    kernel_.sample({jobs_[index], placed_.has_walls}, paint, sampled, pixels);
    for (const int pixel : sampled.pixels) {
        std::memcpy(static_cast<void*>(&first_.picture(block.first.x + pixel % block_side,
                                                       block.first.y + pixel / block_side)),
                    &pixels.rgba[static_cast<std::size_t>(pixel)], sizeof(Rgba8));
    }
}

BlockPaint Painter::paint_of(const PixelBlock& block, std::size_t index) const {
    BlockPaint paint = shared_;
    if (!walls_.empty()) {
        paint.walls = walls_[index];
    }
    const glm::dvec2 middle = glm::dvec2(block.first) + 0.5 * block_side;
    const auto in_block = [&](const PictureRays::Vectors& vectors) {
        return BlockRays::Vectors{glm::vec3(vectors.at(middle)), glm::vec3(vectors.right),
                                  glm::vec3(vectors.down)};
    };
    paint.origin = in_block(rays_.origin);
    paint.view = in_block(rays_.direction);
    paint.from_corner = corner_ + glm::vec2(middle.x, first_.picture.rows() - middle.y);
    return paint;
}

} // namespace reljef::cast

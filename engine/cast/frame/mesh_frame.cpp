#include "engine/cast/frame/mesh_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/cast/frame/seen_terrain.h"

namespace reljef::cast {
namespace {

constexpr std::size_t max_lanes = 16;

// Floats have errors of 2^-24, and a place a few of them.
constexpr double start_rounding = 0x1p-19;

// Surfaces of other directions have other values, so that bends and borders get several samples.
float nearness_of(glm::vec3 face) {
    return 0.6F + 0.05F * glm::dot(face, glm::vec3(1.0F, 1.7F, 0.6F));
}

glm::ivec2 block_grid(glm::ivec2 size) {
    return (size + block_side - 1) / block_side;
}

PixelBlock common_part(const PixelBlock& a, const PixelBlock& b) {
    const glm::ivec2 first = glm::max(a.first, b.first);
    return {first, glm::min(a.first + a.size, b.first + b.size) - first};
}

PixelBlock united(const PixelBlock& a, const PixelBlock& b) {
    if (a.size == glm::ivec2(0)) {
        return b;
    }
    const glm::ivec2 first = glm::min(a.first, b.first);
    return {first, glm::max(a.first + a.size, b.first + b.size) - first};
}

// The part of each block that may show meshes.
std::vector<PixelBlock> seen_blocks(const view::DrawList& list, const PlacedMeshes& meshes) {
    const glm::ivec2 blocks = block_grid(list.size);
    std::vector<PixelBlock> seen(static_cast<std::size_t>(block_count(list.size)));
    const glm::dmat4 clip_from_world = scene::clip_from_world(list.camera, list.size);
    for (std::size_t i = 0; i < list.meshes.size(); ++i) {
        const PixelBlock pixels = seen_pixels(clip_from_world * list.meshes[i].world_from_local,
                                              list.size, corners_of(meshes.meshes()[i].local));
        const glm::ivec2 end = block_grid(pixels.first + pixels.size);
        for (int row = pixels.first.y / block_side; row < end.y; ++row) {
            for (int col = pixels.first.x / block_side; col < end.x; ++col) {
                const PixelBlock block{block_side * glm::ivec2(col, row), glm::ivec2(block_side)};
                PixelBlock& part =
                    seen[static_cast<std::size_t>(row) * static_cast<std::size_t>(blocks.x) +
                         static_cast<std::size_t>(col)];
                part = united(part, common_part(pixels, block));
            }
        }
    }
    return seen;
}

bool has(const PixelBlock& block, glm::dvec2 place) {
    const glm::dvec2 from = place - glm::dvec2(block.first);
    return from.x >= 0.0 && from.y >= 0.0 && from.x < block.size.x && from.y < block.size.y;
}

void add_color(std::size_t place, glm::vec3 color, MeshPixels& pixels) {
    for (int channel = 0; channel < 3; ++channel) {
        pixels.color[static_cast<std::size_t>(channel)][place] += color[channel];
    }
}

std::uint32_t hidden_lanes(const PlacedMeshes& meshes, glm::vec3 to_sun,
                           std::array<const float*, 3> places, std::uint32_t lanes) {
    std::uint32_t hidden = 0;
    for (std::size_t lane = 0; lane < max_lanes; ++lane) {
        const std::uint32_t bit = 1U << lane;
        if ((lanes & bit) != 0 &&
            meshes.hides({places[0][lane], places[1][lane], places[2][lane]}, to_sun)) {
            hidden |= bit;
        }
    }
    return hidden;
}

} // namespace

// Its colour still lacks the sun's light.
struct MeshFrame::Lit {
    std::size_t place = 0; // of the pixels
    glm::vec3 sunlight{0.0F};
    glm::dvec3 point{0.0}; // from the eye, metres
};

MeshPixels::MeshPixels(std::size_t count)
    : t(count + BlockMeshes::padding, std::numeric_limits<float>::infinity()),
      nearness(count + BlockMeshes::padding, 1.0F) {
    color.fill(std::vector<float>(count + BlockMeshes::padding));
}

BlockMeshes MeshPixels::values() const {
    return {t.data(), {color[0].data(), color[1].data(), color[2].data()}, nearness.data()};
}

MeshFrame::MeshFrame(const view::DrawList& list, PlacedMeshes meshes, const MeshPictures& pictures,
                     Options options)
    : list_(list), meshes_(std::move(meshes)), pictures_(pictures), options_(std::move(options)),
      rays_(
          local_rays(list.camera, list.size, glm::translate(glm::dmat4(1.0), list.camera.eye), {})),
      to_sun_(list.sun ? glm::vec3(scene::to_light(*list.sun)) : glm::vec3(0.0F)),
      seen_(seen_blocks(list, meshes_)) {}

MeshPixels MeshFrame::look(std::size_t block, std::span<const glm::dvec2> places) const {
    MeshPixels pixels(places.size());
    std::vector<Lit> lit;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Ray ray = ray_at(places[i]);
        const auto hit =
            has(seen_[block], places[i]) ? meshes_.first_hit(ray, rays_.range) : std::nullopt;
        if (!hit) {
            continue;
        }
        const MeshSurface surface =
            pictures_.at(meshes_, *hit,
                         {ray, rays_.origin.right + hit->t * rays_.direction.right,
                          rays_.origin.down + hit->t * rays_.direction.down});
        pixels.t[i] = static_cast<float>(hit->t - options_.anchor);
        pixels.nearness[i] = nearness_of(surface.face);
        if (!list_.point_lights.empty()) {
            add_color(i,
                      surface.albedo * scene::radiance_from(list_.point_lights,
                                                            list_.camera.eye + ray.at(hit->t),
                                                            surface.normal),
                      pixels);
        }
        if (!list_.sun) {
            add_color(i, surface.albedo, pixels);
            continue;
        }
        const float sky = 0.5F + 0.5F * surface.normal.z;
        add_color(i, surface.albedo * list_.sun->ambient * sky, pixels);
        const float facing = glm::dot(surface.normal, to_sun_);
        if (facing > 0.0F &&
            !is_hidden_by_meshes(meshes_.meshes()[hit->mesh], ray.at(hit->t), surface.face)) {
            lit.push_back({i, surface.albedo * list_.sun->color * facing, ray.at(hit->t)});
        }
    }
    add_sunlight(lit, pixels);
    return pixels;
}

// A face that is turned away hides the sun itself.
bool MeshFrame::is_hidden_by_meshes(const PlacedMesh& mesh, glm::dvec3 place,
                                    glm::vec3 face) const {
    if (!options_.ground) {
        return false;
    }
    const double lift = start_rounding * (glm::length(place) + mesh.extent);
    return !(glm::dot(face, to_sun_) > 0.0F) ||
           meshes_.hides(glm::vec3(place + lift * glm::dvec3(face)), to_sun_);
}

void MeshFrame::add_sunlight(std::span<const Lit> lit, MeshPixels& pixels) const {
    if (!options_.ground) {
        for (const Lit& one : lit) {
            add_color(one.place, one.sunlight, pixels);
        }
        return;
    }
    const TowardSun& sun = options_.ground->sun;
    if (sun.bent == nullptr && sun.straight.z <= 0.0) {
        return;
    }
    while (!lit.empty()) {
        const std::size_t count = std::min(lit.size(), block_pixels);
        add_sunlight_beside_ground(lit.first(count), pixels);
        lit = lit.subspan(count);
    }
}

// Of so many places that the kernel takes.
void MeshFrame::add_sunlight_beside_ground(std::span<const Lit> lit, MeshPixels& pixels) const {
    std::vector<glm::dvec3> samples(lit.size());
    std::transform(lit.begin(), lit.end(), samples.begin(), [&](const Lit& one) {
        return options_.ground->sample_of(list_.camera.eye + one.point).value_or(glm::dvec3(0.0));
    });
    constexpr double max_base = 0x1p22; // whole numbers that floats have exactly
    const glm::ivec2 base(glm::clamp(glm::round(glm::dvec2(samples.front())), glm::dvec2(-max_base),
                                     glm::dvec2(max_base)));
    std::vector<SunTile> tiles;
    const BlockJob job = job_toward_sun(samples, base, tiles);
    SunPlaces places;
    places.count = static_cast<int>(lit.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const glm::dvec2 from = glm::dvec2(samples[i]) - glm::dvec2(base);
        const glm::dvec2 cell = glm::clamp(glm::floor(from), -max_base, max_base);
        places.col[i] = static_cast<std::int32_t>(cell.x);
        places.row[i] = static_cast<std::int32_t>(cell.y);
        places.col_part[i] = static_cast<float>(from.x - cell.x);
        places.row_part[i] = static_cast<float>(from.y - cell.y);
        places.height[i] =
            static_cast<float>(samples[i].z - static_cast<double>(job.rays.base_height));
    }
    std::array<std::uint8_t, block_pixels> hidden{};
    options_.kernel.hide(job, places, hidden);
    for (std::size_t i = 0; i < lit.size(); ++i) {
        if (hidden[i] == 0) {
            add_color(lit[i].place, lit[i].sunlight, pixels);
        }
    }
}

// `tiles` outlive the job.
BlockJob MeshFrame::job_toward_sun(std::span<const glm::dvec3> samples, glm::ivec2 base,
                                   std::vector<SunTile>& tiles) const {
    const ShadowGround& ground = *options_.ground;
    Box box;
    for (const glm::dvec3& sample : samples) {
        box.add(sample);
    }
    tiles = sun_tiles_from(box, base, ground.sources, ground.sun);
    BlockJob job;
    if (const SunCourse* const course = ground.sun.bent.get()) {
        job.bends = &course->bends();
        job.unit_scale = glm::vec2(course->unit_scale());
        job.unit_first = glm::vec2(course->unit_first() + course->unit_scale() * glm::dvec2(base));
    }
    job.rays.base_height = static_cast<float>(samples.front().z);
    job.rays.lift = static_cast<float>(start_rounding) * std::abs(job.rays.base_height);
    job.skips_blocks = options_.skips.blocks;
    job.skips_cells = options_.skips.cells;
    job.sun_tiles = tiles;
    return job;
}

MeshShadow MeshFrame::shadow() const {
    if (!options_.ground) {
        return {};
    }
    return {this, [](const void* frame, std::array<const float*, 3> places, std::uint32_t lanes) {
                const auto& meshes = *static_cast<const MeshFrame*>(frame);
                return hidden_lanes(meshes.meshes_, meshes.to_sun_, places, lanes);
            }};
}

bool MeshFrame::add_hits(HitBuffer& hits, const ParallelOptions& parallel) const {
    return for_each_block(list_.size, parallel, [&](const PixelBlock&, std::size_t index) {
        const PixelBlock& seen = seen_[index];
        for (int row = seen.first.y; row < seen.first.y + seen.size.y; ++row) {
            for (int col = seen.first.x; col < seen.first.x + seen.size.x; ++col) {
                Hit& shown = hits(col, row);
                const auto hit = meshes_.first_hit(ray_at(glm::dvec2(col, row) + 0.5), rays_.range);
                if (hit && hit->t <= static_cast<double>(shown.depth)) {
                    shown = shown_hit(meshes_.meshes()[hit->mesh], *hit);
                }
            }
        }
    });
}

} // namespace reljef::cast

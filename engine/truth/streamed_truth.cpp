#include "engine/truth/streamed_truth.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <numeric>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/core/bilinear.h"
#include "engine/terrain/field/surface_caster.h"

namespace reljef::truth {
namespace {

struct TerrainInWorld {
    const scene::TerrainNode* terrain = nullptr;
    glm::dmat4 world_from_local{1.0};
};

Result<TerrainInWorld> only_terrain(const scene::Scene& scene) {
    std::vector<TerrainInWorld> found;
    scene::visit_visible(scene.root(), [&](const scene::Node& node, const glm::dmat4& matrix) {
        if (const auto* terrain = node.get<scene::TerrainNode>()) {
            found.push_back({terrain, matrix});
        }
    });
    if (found.size() != 1 || found[0].terrain->stream == nullptr) {
        return Error{fmt::format("the exact picture: {} terrains found, one streamed terrain was "
                                 "expected",
                                 found.size())};
    }
    return found[0];
}

// Beside a picture's linear colour and place.
constexpr std::size_t bytes_per_shaded_ray =
    sizeof(glm::vec3) + sizeof(std::optional<terrain::SurfaceHit>) + 2 * sizeof(std::uint32_t);

// The first ray of a pixel goes through its centre; more than one per side follow.
std::size_t places_per_pixel(int rays_per_side) {
    const auto n = static_cast<std::size_t>(rays_per_side);
    return n > 1 ? 1 + n * n : 1;
}

void add_places(glm::ivec2 pixel, int rays_per_side, std::vector<glm::dvec2>& places) {
    places.push_back(glm::dvec2(pixel) + 0.5);
    for (std::size_t ray = 1; ray < places_per_pixel(rays_per_side); ++ray) {
        places.push_back(place_in_pixel(pixel, rays_per_side, static_cast<int>(ray - 1)));
    }
}

} // namespace

struct StreamedTruth::TileHits {
    terrain::TreeTile tile;
    std::vector<std::uint32_t> rays;
};

struct StreamedTruth::Batch {
    std::vector<glm::dvec2> places; // on the picture
    std::vector<std::optional<terrain::SurfaceHit>> hits;
    std::vector<std::optional<MeshHit>> mesh_hits; // before the terrain; empty without meshes
    std::vector<bool> is_sunny;                    // empty: the overview's shadows
    std::vector<glm::vec3> colors;                 // linear

    [[nodiscard]] const MeshHit* mesh_hit(std::size_t ray) const {
        return mesh_hits.empty() || !mesh_hits[ray] ? nullptr : &*mesh_hits[ray];
    }
    [[nodiscard]] std::optional<bool> sun_at(std::size_t ray) const {
        return is_sunny.empty() ? std::nullopt : std::optional<bool>(is_sunny[ray]);
    }
};

struct StreamedTruth::TerrainHit {
    terrain::SurfaceHit surface;
    std::optional<bool> is_sunny; // absent: as the overview
};

Result<StreamedTruth> StreamedTruth::create(const scene::Scene& scene,
                                            std::optional<std::size_t> memory_budget) {
    const auto found = only_terrain(scene);
    if (!found) {
        return found.error();
    }
    const std::size_t bytes =
        memory_budget.value_or(found->terrain->stream->options().memory_budget);
    constexpr std::size_t min_rays = 4096;
    const std::size_t per_ray = bytes_per_ray + bytes_per_shaded_ray + sizeof(glm::dvec2);
    const Memory memory{bytes / 2, std::max(min_rays, bytes / 2 / per_ray)};
    auto meshes = MeshCaster::create(scene);
    if (!meshes) {
        return meshes.error();
    }
    StreamedTruth truth(scene, *found->terrain, found->world_from_local, memory);
    truth.meshes_ = std::move(*meshes);
    return truth;
}

StreamedTruth::StreamedTruth(const scene::Scene& scene, const scene::TerrainNode& terrain,
                             const glm::dmat4& world_from_local, const Memory& memory)
    : surface_(terrain.stream, memory.tiles), world_from_local_(world_from_local),
      local_from_world_(glm::inverse(world_from_local)),
      rays_per_batch_(memory.rays), backdrop_{scene.sun(), scene.sky(), scene.point_lights()} {
    if (backdrop_.sun) {
        irradiance_.emplace(*terrain.surface,
                            scene::TerrainLight{*backdrop_.sun, glm::dmat3(world_from_local)});
    }
}

Eye StreamedTruth::eye_of(const scene::Camera& camera, glm::ivec2 size) const {
    Box bounds = transformed(world_from_local_, terrain::shell_around(surface_));
    bounds.add(meshes_.bounds());
    Eye eye(camera, size, bounds);
    eye.see(backdrop_.sky, scene::ground_axes(surface_.stream().maker().overview().placement(),
                                              world_from_local_, camera.eye));
    return eye;
}

Result<void> StreamedTruth::trace(const Eye& eye, Batch& batch, const ParallelOptions& parallel) {
    std::vector<Ray> rays(batch.places.size());
    std::transform(batch.places.begin(), batch.places.end(), rays.begin(), [&](glm::dvec2 place) {
        return transformed(local_from_world_, eye.ray(place));
    });
    auto hits = first_hits(surface_, rays, eye.range(), parallel);
    if (!hits) {
        return hits.error();
    }
    batch.hits = std::move(*hits);
    trace_meshes(eye, batch);
    return {};
}

void StreamedTruth::trace_meshes(const Eye& eye, Batch& batch) const {
    if (meshes_.empty()) {
        return;
    }
    batch.mesh_hits.resize(batch.places.size());
    for (std::size_t i = 0; i < batch.places.size(); ++i) {
        Interval range = eye.range();
        range.end = batch.hits[i] ? batch.hits[i]->t : range.end;
        batch.mesh_hits[i] = meshes_.first_hit(eye.ray(batch.places[i]), range);
        if (batch.mesh_hits[i]) {
            batch.hits[i].reset();
        }
    }
}

Hit StreamedTruth::shown_hit(const Batch& batch, std::size_t ray) {
    const MeshHit* const mesh = batch.mesh_hit(ray);
    return mesh != nullptr ? MeshCaster::as_shown(*mesh) : as_shown(batch.hits[ray]);
}

// From a hit towards the sun, in the world; empty from the sky and from what is turned away.
std::optional<Ray> StreamedTruth::sun_ray(const Eye& eye, const Batch& batch,
                                          std::size_t ray) const {
    const glm::dvec3 to_sun = scene::to_light(*backdrop_.sun);
    if (const MeshHit* const mesh = batch.mesh_hit(ray)) {
        return sun_ray_from(meshes_, *mesh, eye.ray(batch.places[ray]), to_sun);
    }
    if (!batch.hits[ray]) {
        return std::nullopt;
    }
    const scene::TileBuilder& builder = surface_.stream().maker();
    const glm::dvec3 place = surface_.world_from_sample(batch.hits[ray]->sample);
    const glm::dvec2 spacing =
        builder.overview().heightfield().spacing / static_cast<double>(builder.reduction());
    return transformed(world_from_local_,
                       sun_ray_from(place, spacing, glm::dmat3(local_from_world_) * to_sun));
}

// Whether rays begin below the terrain.
Result<std::vector<bool>> StreamedTruth::are_below(std::span<const Ray> local_rays,
                                                   const ParallelOptions& parallel) {
    std::vector<glm::dvec2> samples(local_rays.size());
    std::vector<double> rises(local_rays.size(), std::numeric_limits<double>::infinity());
    const glm::dvec2 last(surface_.last_sample());
    for (std::size_t i = 0; i < local_rays.size(); ++i) {
        const auto sample = surface_.sample_from_world(local_rays[i].origin);
        if (sample && sample->x >= 0.0 && sample->y >= 0.0 && sample->x <= last.x &&
            sample->y <= last.y) {
            samples[i] = glm::dvec2(*sample);
            rises[i] = sample->z;
        }
    }
    const auto heights = heights_at(surface_, samples, parallel);
    if (!heights) {
        return heights.error();
    }
    std::vector<bool> below(local_rays.size());
    for (std::size_t i = 0; i < below.size(); ++i) {
        below[i] = rises[i] < (*heights)[i];
    }
    return below;
}

Result<void> StreamedTruth::find_sun(const Eye& eye, Batch& batch,
                                     const ParallelOptions& parallel) {
    batch.is_sunny.assign(batch.places.size(), false);
    std::vector<std::size_t> open; // no mesh hides the sun
    std::vector<Ray> rays;         // of these, local
    for (std::size_t i = 0; i < batch.places.size(); ++i) {
        const auto ray = sun_ray(eye, batch, i);
        if (ray && !meshes_.hides(*ray)) {
            open.push_back(i);
            rays.push_back(transformed(local_from_world_, *ray));
        }
    }
    const auto below = are_below(rays, parallel);
    if (!below) {
        return below.error();
    }
    const auto hits =
        first_hits(surface_, rays, {0.0, std::numeric_limits<double>::infinity()}, parallel);
    if (!hits) {
        return hits.error();
    }
    for (std::size_t i = 0; i < open.size(); ++i) {
        batch.is_sunny[open[i]] = !(*below)[i] && !(*hits)[i];
    }
    return {};
}

// The finest tiles, row by row as files store them.
std::vector<StreamedTruth::TileHits>
StreamedTruth::hits_by_tile(const scene::TileBuilder& builder,
                            std::span<const std::optional<terrain::SurfaceHit>> hits) {
    std::map<std::pair<int, int>, TileHits> tiles; // by row and column
    for (std::uint32_t i = 0; i < hits.size(); ++i) {
        if (hits[i]) {
            const terrain::TreeTile tile = builder.tile_at(0, glm::dvec2(hits[i]->sample));
            TileHits& of_tile = tiles[{tile.row, tile.col}];
            of_tile.tile = tile;
            of_tile.rays.push_back(i);
        }
    }
    std::vector<TileHits> list;
    list.reserve(tiles.size());
    for (auto& [place, of_tile] : tiles) {
        list.push_back(std::move(of_tile));
    }
    return list;
}

// Bilinear in the tile's texels, or in the colours of the vertices around the hit.
glm::vec3 StreamedTruth::color_in_tile(const scene::FilledHeights& filled,
                                       const scene::TerrainTile* whole, terrain::TreeTile tile,
                                       const TerrainHit& hit) const {
    const scene::TileBuilder& builder = surface_.stream().maker();
    const glm::dvec2 first(terrain::TileTree::first(tile));
    const glm::ivec2 cells = builder.tree().cells(tile);
    glm::dvec2 place = glm::clamp(builder.tree_sample(glm::dvec2(hit.surface.sample)) - first,
                                  glm::dvec2(0.0), glm::dvec2(cells));
    scene::TerrainTile cell;
    if (whole == nullptr) {
        const glm::ivec2 vertex = glm::min(glm::ivec2(place), cells - 1);
        cell = builder.make_cell(tile, vertex, filled);
        place -= glm::dvec2(vertex);
    }
    const scene::TerrainTile& part = whole != nullptr ? *whole : cell;
    const glm::dvec2 texels =
        glm::dvec2(part.albedo.cols() - 1, part.albedo.rows() - 1) / glm::dvec2(part.cells);
    const glm::vec3 albedo = bilinear(part.albedo, place * texels, linear_from_rgba8);
    const glm::vec3 points =
        backdrop_.point_lights.empty()
            ? glm::vec3(0.0F)
            : backdrop_.from_points(world_from_local_,
                                    surface_.world_from_sample(hit.surface.sample),
                                    glm::dvec3(part.normal_at(place)));
    return albedo * (points + (irradiance_ ? irradiance_at(part, place, hit) : glm::vec3(1.0F)));
}

// `place`: among the part's vertices.
glm::vec3 StreamedTruth::irradiance_at(const scene::TerrainTile& part, glm::dvec2 place,
                                       const TerrainHit& hit) const {
    const scene::TileBuilder& builder = surface_.stream().maker();
    const Grid<float>& overview = builder.overview().heightfield().heights;
    const glm::dvec2 last(overview.cols() - 1, overview.rows() - 1);
    const glm::dvec2 on_overview =
        builder.around_overview(builder.on_overview(glm::dvec2(hit.surface.sample)));
    const glm::dvec2 inside = glm::clamp(on_overview, glm::dvec2(0.0), last);
    const glm::vec3 normal = irradiance_->in_world(part.normal_at(place));
    const glm::vec3 up = irradiance_->in_world(part.up);
    const float openness = irradiance_->openness(inside);
    if (hit.is_sunny) {
        const scene::IrradianceParts parts = irradiance_->parts_at(normal, up, openness);
        return *hit.is_sunny ? parts.sky + parts.sun : parts.sky;
    }
    return irradiance_->at(normal, up, irradiance_->visibility(inside), openness);
}

Result<void> StreamedTruth::shade(const Eye& eye, Batch& batch,
                                  const ParallelOptions& parallel) const {
    batch.colors.resize(batch.places.size());
    for (std::size_t i = 0; i < batch.hits.size(); ++i) {
        const Ray ray = eye.ray(batch.places[i]);
        if (const MeshHit* const hit = batch.mesh_hit(i)) {
            const glm::vec3 color =
                meshes_.color_at(*hit, backdrop_.sun, batch.sun_at(i).value_or(true)) +
                meshes_.from_points(*hit, ray.at(hit->t), backdrop_.point_lights);
            batch.colors[i] = backdrop_.through_air(color, ray, eye.distance(ray, hit->t));
        } else if (!batch.hits[i]) {
            batch.colors[i] = backdrop_.behind(ray, eye);
        }
    }
    const scene::TileStream& stream = surface_.stream();
    const std::vector<TileHits> tiles = hits_by_tile(stream.maker(), batch.hits);
    std::vector<std::optional<Error>> errors(tiles.size());
    const auto shade_one = [&](int i) {
        const auto index = static_cast<std::size_t>(i);
        auto shaded = shade_tile(eye, tiles[index], batch, parallel.stop);
        if (!shaded) {
            errors[index] = shaded.error();
        }
    };
    const unsigned threads =
        std::min(thread_count(parallel.threads), thread_count(stream.options().threads));
    const bool done =
        parallel_for(static_cast<int>(tiles.size()), shade_one, {threads, parallel.stop, {}});
    const auto error = std::find_if(errors.begin(), errors.end(),
                                    [](const auto& found) { return found.has_value(); });
    if (error != errors.end()) {
        return **error;
    }
    return done ? Result<void>() : Error{"the exact picture: drawing was stopped"};
}

Result<void> StreamedTruth::shade_tile(const Eye& eye, const TileHits& hits, Batch& batch,
                                       const std::stop_token& stop) const {
    const scene::TileStream& stream = surface_.stream();
    const auto content = read_surely(stream, stream.reader(), hits.tile, stop);
    if (!content) {
        return content.error();
    }
    std::optional<scene::TerrainTile> whole;
    scene::FilledHeights filled;
    if (content->picture.texels.empty()) {
        filled = stream.maker().filled(hits.tile, content->heights, content->was_void);
    } else {
        whole =
            stream.maker().make(hits.tile, content->heights, content->picture, content->was_void);
    }
    for (const std::uint32_t ray : hits.rays) {
        const TerrainHit hit{*batch.hits[ray], batch.sun_at(ray)};
        const glm::vec3 color = color_in_tile(filled, whole ? &*whole : nullptr, hits.tile, hit);
        const Ray view_ray = eye.ray(batch.places[ray]);
        batch.colors[ray] =
            backdrop_.through_air(color, view_ray, eye.distance(view_ray, hit.surface.t));
    }
    return {};
}

Result<void> StreamedTruth::color(const Eye& eye, Batch& batch, const DrawOptions& options) {
    const bool casts_rays = backdrop_.sun && options.shadow == SunShadow::ray;
    auto found = casts_rays ? find_sun(eye, batch, options.parallel) : Result<void>();
    return found ? shade(eye, batch, options.parallel) : found;
}

// Calls `use(pixel, batch, index of the pixel's first ray)`.
template <class Use>
Result<void> StreamedTruth::for_each_batch(const Eye& eye, glm::ivec2 size,
                                           const DrawOptions& options, bool has_colors,
                                           const Use& use) {
    const ParallelOptions& parallel = options.parallel;
    check(size.x >= 1 && size.y >= 1, "a picture of at least 1x1 pixels was expected");
    const std::size_t per_pixel = places_per_pixel(options.rays_per_side);
    const std::size_t pixels = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
    const std::size_t per_batch = std::max<std::size_t>(1, rays_per_batch_ / per_pixel);
    // Down the columns: the pixels of a column show the same tiles, near to far.
    const auto pixel_at = [&](std::size_t i) {
        const auto rows = static_cast<std::size_t>(size.y);
        return glm::ivec2(static_cast<int>(i / rows), static_cast<int>(i % rows));
    };
    for (std::size_t first = 0; first < pixels; first += per_batch) {
        const std::size_t end = std::min(first + per_batch, pixels);
        Batch batch;
        batch.places.reserve((end - first) * per_pixel);
        for (std::size_t i = first; i < end; ++i) {
            add_places(pixel_at(i), options.rays_per_side, batch.places);
        }
        const auto progress = [&](double part) {
            const double done =
                static_cast<double>(first) + part * static_cast<double>(end - first);
            parallel.progress(done / static_cast<double>(pixels));
        };
        ParallelOptions of_batch = parallel;
        of_batch.progress = parallel.progress ? Progress(progress) : Progress();
        if (auto traced = trace(eye, batch, of_batch); !traced) {
            return traced;
        }
        if (auto done = has_colors ? color(eye, batch, options) : Result<void>(); !done) {
            return done;
        }
        for (std::size_t i = first; i < end; ++i) {
            use(pixel_at(i), batch, (i - first) * per_pixel);
        }
    }
    return {};
}

Result<Picture> StreamedTruth::draw(const scene::Camera& camera, glm::ivec2 size,
                                    const DrawOptions& options) {
    check(options.rays_per_side >= 1, "at least one ray a pixel was expected");
    Picture picture{HitBuffer(size.x, size.y), Image(size.x, size.y)};
    const int n = options.rays_per_side;
    const auto use = [&](glm::ivec2 pixel, const Batch& batch, std::size_t first) {
        picture.hits(pixel.x, pixel.y) = shown_hit(batch, first);
        const auto colors = std::span(batch.colors).subspan(first);
        glm::vec3 color = colors[0];
        if (n > 1) {
            const auto more =
                colors.subspan(1, static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
            color = std::accumulate(more.begin(), more.end(), glm::vec3(0.0F)) /
                    static_cast<float>(n * n);
        }
        picture.image(pixel.x, pixel.y) = rgba8_from_linear(color);
    };
    const auto done = for_each_batch(eye_of(camera, size), size, options, true, use);
    return done ? Result<Picture>(std::move(picture)) : done.error();
}

Result<HitBuffer> StreamedTruth::draw_hits(const scene::Camera& camera, glm::ivec2 size,
                                           const ParallelOptions& parallel) {
    HitBuffer hits(size.x, size.y);
    const auto use = [&](glm::ivec2 pixel, const Batch& batch, std::size_t first) {
        hits(pixel.x, pixel.y) = shown_hit(batch, first);
    };
    const auto done =
        for_each_batch(eye_of(camera, size), size, {.parallel = parallel}, false, use);
    return done ? Result<HitBuffer>(std::move(hits)) : done.error();
}

Result<Grid<double>> StreamedTruth::reprojection_errors(const scene::Camera& camera,
                                                        const HitBuffer& hits,
                                                        const ParallelOptions& parallel) {
    Grid<double> errors(hits.cols(), hits.rows(), std::numeric_limits<double>::quiet_NaN());
    std::vector<glm::dvec2> samples;
    std::vector<glm::ivec2> pixels;
    for (int row = 0; row < hits.rows(); ++row) {
        for (int col = 0; col < hits.cols(); ++col) {
            const Hit& hit = hits(col, row);
            if (!shows_terrain(hit)) {
                continue;
            }
            errors(col, row) = std::numeric_limits<double>::infinity();
            if (std::isfinite(hit.col) && std::isfinite(hit.row)) {
                samples.push_back(hit.place());
                pixels.emplace_back(col, row);
            }
        }
    }
    const auto heights = heights_at(surface_, samples, parallel);
    if (!heights) {
        return heights.error();
    }
    const glm::ivec2 size(hits.cols(), hits.rows());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const glm::dvec3 local = surface_.world_from_sample({samples[i], (*heights)[i]});
        const glm::dvec3 world(world_from_local_ * glm::dvec4(local, 1.0));
        errors(pixels[i].x, pixels[i].y) = distance_to_pixel(camera, size, pixels[i], world);
    }
    return errors;
}

Result<GeometricErrors> StreamedTruth::errors(const scene::Camera& camera, const HitBuffer& shown,
                                              const HitBuffer& truth,
                                              const ParallelOptions& parallel) {
    const auto reprojection = reprojection_errors(camera, shown, parallel);
    if (!reprojection) {
        return reprojection.error();
    }
    const auto of_pixel = [&](glm::ivec2 pixel, const Hit& /*hit*/) {
        return (*reprojection)(pixel.x, pixel.y);
    };
    return geometric_errors(PixelMeasure{of_pixel, hit_error}, shown, truth, parallel.threads);
}

} // namespace reljef::truth

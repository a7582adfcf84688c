#include "engine/session/prepared_maps.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/cast/frame/driver.h"
#include "engine/io/cache/disk_cache.h"
#include "engine/material/tile_cones.h"

namespace reljef::session {
namespace {

bool is_same_side(const material::KnownCones& a, const material::KnownCones& b) {
    return a.border == b.border && a.from_behind == b.from_behind;
}

// The sides of a detail texture that `cone` searches.
std::vector<material::KnownCones> sides_of(const scene::Technique& technique) {
    const bool wraps =
        technique.options.border.value_or(material::WrapMode::wrap) == material::WrapMode::wrap;
    const auto border = wraps ? material::WrapMode::wrap : material::WrapMode::clamp;
    std::vector<material::KnownCones> sides{{border, false, nullptr}};
    if (technique.options.two_sided) {
        sides.push_back({border, true, nullptr});
    }
    return sides;
}

std::vector<material::KnownCones> missing_sides(const material::ReliefMaterial& set,
                                                const scene::Technique& technique) {
    std::vector<material::KnownCones> sides = sides_of(technique);
    std::erase_if(sides, [&](const material::KnownCones& side) {
        return std::any_of(set.cones.begin(), set.cones.end(),
                           [&](const auto& known) { return is_same_side(known, side); });
    });
    return sides;
}

// Two materials may share a set and need different sides of it.
void add_missing_side(std::vector<material::KnownCones>& sides, const material::KnownCones& side) {
    if (std::none_of(sides.begin(), sides.end(),
                     [&](const auto& other) { return is_same_side(other, side); })) {
        sides.push_back(side);
    }
}

Result<std::shared_ptr<const material::ConeMaps>> cones_over(const Grid<float>& heights,
                                                             const std::string& name, int threads,
                                                             Log& log,
                                                             const std::stop_token& stop) {
    const auto task = log.start("cones of " + name);
    auto cached = io::cached_cones(
        heights.view(), {.folder = io::cache_folder(),
                         .min_seconds = 1.0,
                         .parallel = {static_cast<unsigned>(threads), stop, task->callback()}});
    if (!cached) {
        return Error{fmt::format("{}: stopped while its cones were made", name)};
    }
    if (!cached->note.empty()) {
        log.note(cached->note);
    }
    return std::move(cached->value);
}

Result<void> add_side(material::ReliefMaterial& set, material::KnownCones side, int threads,
                      Log& log, const std::stop_token& stop) {
    const Grid<float> heights = material::visible_heights(set.heights, side.from_behind);
    auto cones =
        cones_over(material::cone_field(heights.view(), side.border), set.name, threads, log, stop);
    if (!cones) {
        return cones.error();
    }
    side.of_field = std::move(*cones);
    set.cones.push_back(std::move(side));
    return {};
}

Result<std::shared_ptr<const terrain::Bisection>> bisection_of(const scene::TerrainSurface& surface,
                                                               int threads, Log& log,
                                                               const std::stop_token& stop) {
    const std::string& name = surface.terrain().name;
    const auto task = log.start("bounding the errors of " + name);
    auto cached = io::cached_bisection(
        surface.heightfield(), surface.placement(),
        {.folder = io::cache_folder(),
         .parallel = {static_cast<unsigned>(threads), stop, task->callback()}});
    if (!cached) {
        return Error{fmt::format("{}: stopped while its errors were bounded", name)};
    }
    if (!cached->note.empty()) {
        log.note(cached->note);
    }
    return std::move(cached->value);
}

} // namespace

MissingMaps missing_maps(const scene::TerrainNode& node, const scene::Technique& shown,
                         RayUse rays) {
    MissingMaps missing;
    if (node.stream != nullptr) {
        return missing; // its tiles have their own
    }
    const Grid<float>& heights = node.surface->heightfield().heights;
    const bool has_cells = heights.cols() >= 2 && heights.rows() >= 2;
    missing.cones = has_cells && shown.id() == scene::TechniqueId::cone && node.cones == nullptr;
    const bool has_triangles = rays == RayUse::none || !cast::obstacle_of(node, shown).empty();
    missing.bisection =
        scene::triangle_bound(node, shown) > 0.0 && has_triangles && node.bisection == nullptr;
    missing.surface = missing.cones || missing.bisection ? node.surface : nullptr;
    return missing;
}

MissingMaps missing_maps(const TerrainScene& scene,
                         const std::optional<scene::Technique>& technique) {
    std::vector<scene::Technique> techniques;
    for (const scene::Material* const material : scene.materials()) {
        techniques.push_back(technique.value_or(material->technique));
    }
    return missing_maps(scene, techniques);
}

MissingMaps missing_maps(const TerrainScene& scene, std::span<const scene::Technique> techniques) {
    if (scene.models.empty()) {
        const auto& node = *scene.terrain->get<scene::TerrainNode>();
        return missing_maps(node, techniques.front(), scene.rays);
    }
    MissingMaps missing;
    const std::vector<scene::Material*> materials = scene.materials();
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const MissingMaps::Set& set = materials[i]->detail.set;
        const scene::Technique& shown = techniques[i];
        if (set == nullptr || shown.id() != scene::TechniqueId::cone) {
            continue;
        }
        for (const material::KnownCones& side : missing_sides(*set, shown)) {
            add_missing_side(missing.set_cones[set], side);
        }
    }
    return missing;
}

std::optional<view::LightRequest> light_request(const TerrainScene& scene,
                                                const scene::Light& light,
                                                const scene::Technique& technique,
                                                int largest_side) {
    if (!scene.models.empty() || scene.light == nullptr) {
        return std::nullopt;
    }
    const auto& node = *scene.terrain->get<scene::TerrainNode>();
    return view::LightRequest{
        .surface = node.surface,
        .stream = node.stream,
        .light = {scene::turned(light, scene.light->world_from_local()),
                  glm::dmat3(scene.terrain->world_from_local())},
        .in_parts = technique.options.shadow.has_value(),
        .largest_side = largest_side,
    };
}

Result<PreparedMaps> prepare_maps(const MissingMaps& missing, int threads, Log& log,
                                  const std::stop_token& stop) {
    PreparedMaps made;
    made.surface = missing.surface;
    if (missing.cones) {
        const Grid<float>& heights = missing.surface->heightfield().heights;
        auto cones = cones_over(terrain::unit_heights(heights.view()),
                                missing.surface->terrain().name, threads, log, stop);
        if (!cones) {
            return cones.error();
        }
        made.cones = std::move(*cones);
    }
    if (missing.bisection) {
        auto bisection = bisection_of(*missing.surface, threads, log, stop);
        if (!bisection) {
            return bisection.error();
        }
        made.bisection = std::move(*bisection);
    }
    for (const auto& [set, sides] : missing.set_cones) {
        material::ReliefMaterial with_cones = *set;
        for (const material::KnownCones& side : sides) {
            if (auto added = add_side(with_cones, side, threads, log, stop); !added) {
                return added.error();
            }
        }
        made.sets.emplace(set,
                          std::make_shared<const material::ReliefMaterial>(std::move(with_cones)));
    }
    if (missing.light && !stop.stop_requested()) {
        const auto task = log.start("lighting " + missing.light->surface->terrain().name);
        made.light =
            std::make_shared<const view::PreparedLight>(view::prepare_light(*missing.light));
    }
    return stop.stop_requested() ? Result<PreparedMaps>(Error{"stopped while maps were made"})
                                 : Result<PreparedMaps>(std::move(made));
}

void apply_maps(TerrainScene& scene, const PreparedMaps& maps) {
    auto& node = *scene.terrain->get<scene::TerrainNode>();
    if (maps.surface == node.surface) {
        node.cones = maps.cones != nullptr ? maps.cones : node.cones;
        node.bisection = maps.bisection != nullptr ? maps.bisection : node.bisection;
    }
    for (scene::Material* const material : scene.materials()) {
        const auto found = maps.sets.find(material->detail.set);
        if (found != maps.sets.end()) {
            material->detail.set = found->second;
        }
    }
}

std::vector<ObjectMesh> missing_levels(const TerrainScene& scene) {
    if (!scene.mesh_levels || scene.objects.empty()) {
        return {};
    }
    const auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    const bool is_bounded = scene::error_bound(terrain.material.technique) > 0.0;
    return is_bounded ? meshes_without_levels(scene.objects) : std::vector<ObjectMesh>();
}

Result<void> add_levels(const TerrainScene& scene, int threads, Log& log,
                        const std::stop_token& stop) {
    const auto meshes = missing_levels(scene);
    if (meshes.empty()) {
        return {};
    }
    const auto task = log.start("making levels of detail of objects");
    const auto made = make_levels(meshes, {static_cast<unsigned>(threads), stop, task->callback()});
    if (!made) {
        return made.error();
    }
    set_levels(scene.objects, *made);
    return {};
}

Result<void> add_cones(material::ReliefMaterial& set, const scene::Technique& technique,
                       int threads, Log& log, const std::stop_token& stop) {
    if (technique.id() != scene::TechniqueId::cone) {
        return {};
    }
    for (const material::KnownCones& side : missing_sides(set, technique)) {
        if (auto added = add_side(set, side, threads, log, stop); !added) {
            return added;
        }
    }
    return {};
}

} // namespace reljef::session

#include "engine/session/terrain_detail.h"

#include <fmt/format.h>

#include "engine/session/material_source.h"
#include "engine/session/prepared_maps.h"

namespace reljef::session {
namespace {

// The command line's word comes before the scene file's.
std::optional<io::DetailDescription> asked_for(const io::SceneDescription& description,
                                               const SceneOptions& view) {
    std::optional<io::DetailDescription> detail = description.detail;
    if (view.detail) {
        detail = detail.value_or(io::DetailDescription{});
        detail->textures = view.detail->textures;
        detail->folder = view.detail->textures;
        detail->width = view.detail->width.value_or(detail->width);
        detail->scale = view.detail->scale ? view.detail->scale : detail->scale;
    }
    return detail;
}

Result<scene::Technique> technique_for(const io::DetailDescription& detail,
                                       const std::string& scene_name, const SceneOptions& view) {
    if (view.detail_technique) {
        return *view.detail_technique;
    }
    auto technique = scene::parse_technique(detail.technique);
    const auto good = technique ? scene::check_terrain_detail_technique(*technique)
                                : Result<void>(technique.error());
    return good ? technique
                : Error{fmt::format("{}: [detail] {}", scene_name, good.error().message)};
}

} // namespace

Result<std::shared_ptr<const scene::TerrainDetail>>
open_detail(const io::SceneDescription& description, const SourceOptions& terrain,
            const SceneOptions& view, Log& log, const std::stop_token& stop) {
    using Detail = std::shared_ptr<const scene::TerrainDetail>;
    const auto asked = asked_for(description, view);
    if (!asked) {
        if (view.detail_technique) {
            return usage_error("--detail-technique: found without --detail, whose tile it draws");
        }
        return Detail();
    }
    auto technique = technique_for(*asked, description.name, view);
    if (!technique) {
        return technique.error();
    }
    auto set =
        open_material({asked->textures, asked->folder, view.detail ? "--detail" : terrain.terrain,
                       description.seed, asked->width, asked->scale},
                      terrain);
    if (!set) {
        return set.error();
    }
    if (auto made = add_cones(*set, *technique, terrain.threads, log, stop); !made) {
        return made.error();
    }
    log_material_notes(*set, log);
    scene::TerrainDetail detail;
    detail.width = asked->width;
    detail.scale = asked->scale ? static_cast<float>(*asked->scale) : set->scale;
    detail.technique = *technique;
    detail.set = std::make_shared<const material::ReliefMaterial>(std::move(*set));
    return Detail(std::make_shared<const scene::TerrainDetail>(std::move(detail)));
}

} // namespace reljef::session

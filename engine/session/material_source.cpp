#include "engine/session/material_source.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/io/image/texture_files.h"
#include "engine/session/prepared_maps.h"
#include "terrains/gallery/detail_tiles.h"

namespace reljef::session {
namespace {

// The command line overrides the scene file.
std::optional<io::DetailDescription> requested_detail(const io::SceneDescription& description,
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

Result<material::ReliefMaterial> open_material(const MaterialRequest& request,
                                               const SourceOptions& choice) {
    const std::string& name = request.name;
    const auto names = terrains::detail_names();
    if (std::find(names.begin(), names.end(), name) != names.end()) {
        return terrains::generate_detail(
            name, {.seed = request.seed, .threads = static_cast<unsigned>(choice.threads)});
    }
    std::error_code ignored;
    if (!std::filesystem::is_directory(request.folder, ignored)) {
        const std::string message = fmt::format(
            "{}: texture set '{}' found, one of {}{} or a folder of pictures was expected",
            request.asked_by, name, request.also, fmt::join(names, ", "));
        return request.asked_by.starts_with("--") ? usage_error(message) : Error{message};
    }
    const auto files = io::find_texture_files(request.folder);
    if (!files) {
        return files.error();
    }
    io::TextureOptions options{.width = request.width};
    options.scale = request.scale ? static_cast<float>(*request.scale) : options.scale;
    return io::read_texture_set(*files, options);
}

void log_material_notes(const material::ReliefMaterial& set, Log& log) {
    for (const std::string& note : set.notes) {
        log.note(note);
    }
}

Result<std::shared_ptr<const scene::TerrainDetail>>
open_detail(const io::SceneDescription& description, const SourceOptions& terrain,
            const SceneOptions& view, Log& log, const std::stop_token& stop) {
    using Detail = std::shared_ptr<const scene::TerrainDetail>;
    const auto requested = requested_detail(description, view);
    if (!requested) {
        if (view.detail_technique) {
            return usage_error(
                "--detail-technique: found without --detail, one was expected with it");
        }
        return Detail();
    }
    auto technique = technique_for(*requested, description.name, view);
    if (!technique) {
        return technique.error();
    }
    auto set = open_material({requested->textures, requested->folder,
                              view.detail ? "--detail" : terrain.terrain, description.seed,
                              requested->width, requested->scale},
                             terrain);
    if (!set) {
        return set.error();
    }
    if (auto made = add_cones(*set, *technique, terrain.threads, log, stop); !made) {
        return made.error();
    }
    log_material_notes(*set, log);
    scene::TerrainDetail detail;
    detail.width = requested->width;
    detail.scale = requested->scale ? static_cast<float>(*requested->scale) : set->scale;
    detail.technique = *technique;
    detail.set = std::make_shared<const material::ReliefMaterial>(std::move(*set));
    return Detail(std::make_shared<const scene::TerrainDetail>(std::move(detail)));
}

} // namespace reljef::session

#include "bench/objects/city_forms.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include "app/cli/console_log.h"
#include "bench/objects/city_heights.h"
#include "engine/io/formats/scene_file.h"

namespace reljef::bench {
namespace {

using building::CityForm;

io::SceneDescription urban(int size, CityForm form) {
    io::SceneDescription description;
    description.name = fmt::format("urban {}", size);
    description.generator = "urban";
    description.size = size;
    description.buildings = form;
    description.walls = building::CityWalls::stepped;
    return description;
}

// Buildings have windows; what stands on their roofs has none.
std::size_t buildings_in(const session::TerrainSource& source) {
    return static_cast<std::size_t>(
        std::count_if(source.buildings.begin(), source.buildings.end(), [](const auto& building) {
            return std::any_of(building.faces.begin(), building.faces.end(),
                               [](const auto& face) { return !face.facade.empty(); });
        }));
}

Hit on_samples(const Hit& hit, const Ray& ray, const scene::TerrainSurface& surface) {
    const auto sample = surface.placement().sample_from_world(ray.at(hit.depth));
    return sample ? hit_at(glm::dvec2(*sample), sample->z, hit.depth) : Hit{};
}

bool is_of_mesh(const Hit& hit) {
    return !hit.is_sky() && !truth::shows_terrain(hit);
}

} // namespace

Result<session::TerrainSource> CityForms::open_source(io::SceneDescription description,
                                                      const std::stop_token& stop) const {
    cli::ConsoleLog log(options_.quiet);
    return session::open_terrain(std::move(description), source_options(), log, stop);
}

session::SourceOptions CityForms::source_options() const {
    session::SourceOptions options;
    options.threads = options_.threads;
    options.placement = terrain::PlacementKind::plane;
    return options;
}

Result<void> CityForms::set_up(CityForm form, session::TerrainSource source,
                               const std::stop_token& stop) {
    name_ = source.description.name;
    buildings_ = std::max(buildings_, buildings_in(source));
    cli::ConsoleLog log(options_.quiet);
    auto scene = session::make_scene(std::move(source), source_options(), {}, log, stop);
    if (!scene) {
        return scene.error();
    }
    if (scene->buildings.buildings != nullptr) {
        buildings_ = std::max(buildings_, scene->buildings.buildings->size());
    }
    slot(form) = std::move(*scene);
    return {};
}

Result<void> CityForms::open_urban(int size, const std::stop_token& stop) {
    for (const CityForm form : {CityForm::heights, CityForm::meshes, CityForm::meshes_only}) {
        auto source = open_source(urban(size, form), stop);
        if (!source) {
            return source.error();
        }
        if (auto done = set_up(form, std::move(*source), stop); !done) {
            return done;
        }
    }
    return {};
}

// The heights are made from the meshes: a scanned surface model has trees and other roofs, which
// would count as errors of what draws it.
Result<void> CityForms::open_scene_file(const std::string& file, const std::stop_token& stop) {
    auto description = io::read_scene_file(file);
    if (!description) {
        return description.error();
    }
    if (description->footprints.empty()) {
        return Error{fmt::format("{}: no footprints found, some were expected", file)};
    }
    const auto on_surface =
        std::find_if(description->footprints.begin(), description->footprints.end(),
                     [](const auto& footprints) { return !footprints.surface.empty(); });
    const std::filesystem::path scanned =
        on_surface != description->footprints.end() ? on_surface->surface : "";
    auto city = open_source(*description, stop);
    if (!city) {
        return city.error();
    }
    if (auto done = set_up(CityForm::meshes, std::move(*city), stop); !done) {
        return done;
    }
    description->footprints.clear();
    auto ground = open_source(*description, stop);
    if (!ground) {
        return ground.error();
    }
    auto heights =
        heights_of_city(*slot(CityForm::meshes), static_cast<unsigned>(options_.threads), stop);
    if (!heights) {
        return Error{fmt::format("{}: {}", file, heights.error().message)};
    }
    terrain::Heightfield& field = ground->terrain.heightfield;
    field.heights = std::move(*heights);
    field.range = terrain::height_range(field.heights, field.void_mask);
    if (!scanned.empty()) {
        description->heights = scanned;
        const auto scan = open_source(*description, stop);
        if (!scan) {
            return scan.error();
        }
        note_ = scan_difference(name_, scan->terrain.heightfield, field);
    }
    return set_up(CityForm::heights, std::move(*ground), stop);
}

Result<CityForms> CityForms::open(const CityChoice& choice, const SuiteOptions& options,
                                  const std::stop_token& stop) {
    CityForms city(choice.terrain, options);
    if (choice.terrain != "urban" && !choice.terrain.ends_with(".toml")) {
        return Error{fmt::format("{}: found, urban or a scene file (.toml) of bare ground with "
                                 "[[footprints]] was expected",
                                 choice.terrain)};
    }
    auto opened = choice.terrain == "urban" ? city.open_urban(choice.size, stop)
                                            : city.open_scene_file(choice.terrain, stop);
    if (!opened) {
        return opened.error();
    }
    if (city.buildings_ == 0) {
        return Error{fmt::format("{}: no building found, some were expected", city.name_)};
    }
    return city;
}

void CityForms::set_technique(CityForm form, const scene::Technique& technique) {
    for (scene::Material* const material : slot(form)->materials()) {
        material->technique = technique;
    }
}

Result<void> CityForms::look_from(double distance, double down) {
    const session::TerrainScene& heights = *slot(CityForm::heights);
    scene::Camera looking;
    looking.near = session::near_distance(heights.bounds);
    const double street = slot(CityForm::meshes)->ground(0.0, 0.0);
    looking.target = {0.0, 0.0, street};
    const double angle = glm::radians(down);
    looking.eye = looking.target + distance * glm::dvec3(0.0, -std::cos(angle), std::sin(angle));
    if (looking.eye.z <= heights.ground(looking.eye.x, looking.eye.y)) {
        return Error{fmt::format("{}: a building found {} m from its middle, {} degrees up; an eye "
                                 "above the city was expected",
                                 name_, distance, down)};
    }
    for (auto& form : forms_) {
        if (form) {
            *form->camera->get<scene::Camera>() = looking;
        }
    }
    return {};
}

Result<truth::Picture> CityForms::draw_truth(const std::stop_token& stop) {
    const scene::Scene& meshes = scene(CityForm::meshes);
    if (!caster_) {
        auto caster = truth::SceneCaster::create(meshes);
        if (!caster) {
            return caster.error();
        }
        caster_ = std::move(*caster);
        shading_.emplace(meshes, *caster_);
    }
    return truth::draw(*caster_, *shading_, meshes.camera(), options_.size,
                       {.parallel = {static_cast<unsigned>(options_.threads), stop, {}}});
}

// Places on meshes as columns and rows of the heights.
HitBuffer CityForms::on_terrain(const HitBuffer& hits) const {
    HitBuffer placed = hits;
    const scene::Camera camera = scene(CityForm::meshes).camera();
    for (int y = 0; y < hits.rows(); ++y) {
        for (int x = 0; x < hits.cols(); ++x) {
            if (is_of_mesh(hits(x, y))) {
                const Ray ray =
                    scene::view_ray(camera, options_.size, glm::dvec2(x, y) + glm::dvec2(0.5));
                placed(x, y) = on_samples(hits(x, y), ray, surface(CityForm::heights));
            }
        }
    }
    return placed;
}

Result<truth::GeometricErrors> CityForms::errors(CityForm form, const HitBuffer& shown,
                                                 const HitBuffer& truth) const {
    const scene::Camera camera = scene(form).camera();
    const truth::SurfaceView view{surface(form).heightfield().heights.view(),
                                  surface(form).placement(),
                                  slot(form)->terrain->world_from_local(), camera};
    const auto reprojection = [&](glm::ivec2 pixel, const Hit& hit) {
        return is_of_mesh(shown(pixel.x, pixel.y))
                   ? std::nullopt
                   : std::optional(truth::reprojection_error(view, options_.size, pixel, hit));
    };
    return truth::geometric_errors({reprojection, truth::hit_error}, on_terrain(shown),
                                   on_terrain(truth), static_cast<unsigned>(options_.threads));
}

} // namespace reljef::bench

#include "bench/objects/city_forms.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include "app/cli/console_log.h"
#include "engine/io/formats/scene_file.h"

namespace reljef::bench {
namespace {

using building::CityForm;

Result<io::SceneDescription> description_of(const CityChoice& choice, CityForm form) {
    if (choice.terrain == "urban") {
        io::SceneDescription urban;
        urban.name = fmt::format("urban {}", choice.size);
        urban.generator = "urban";
        urban.size = choice.size;
        urban.buildings = form;
        urban.walls = building::CityWalls::stepped;
        return urban;
    }
    auto scene = io::read_scene_file(choice.terrain);
    if (!scene) {
        return scene;
    }
    const auto on_surface =
        std::find_if(scene->footprints.begin(), scene->footprints.end(),
                     [](const auto& footprints) { return !footprints.surface.empty(); });
    if (on_surface == scene->footprints.end()) {
        return Error{fmt::format("{}: no footprints on a surface model found, some were expected",
                                 choice.terrain)};
    }
    if (form == CityForm::heights) {
        scene->heights = on_surface->surface;
        scene->footprints.clear();
    }
    return scene;
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

Result<void> CityForms::open_form(const CityChoice& choice, CityForm form,
                                  const std::stop_token& stop) {
    auto description = description_of(choice, form);
    if (!description) {
        return description.error();
    }
    name_ = description->name;
    session::SourceOptions options;
    options.threads = options_.threads;
    options.placement = terrain::PlacementKind::plane;
    cli::ConsoleLog log(options_.quiet);
    auto source = session::open_terrain(std::move(*description), options, log, stop);
    if (!source) {
        return source.error();
    }
    buildings_ = std::max(buildings_, buildings_in(*source));
    auto scene = session::make_scene(std::move(*source), options, {}, log, stop);
    if (!scene) {
        return scene.error();
    }
    if (scene->buildings.buildings != nullptr) {
        buildings_ = std::max(buildings_, scene->buildings.buildings->size());
    }
    slot(form) = std::move(*scene);
    return {};
}

Result<CityForms> CityForms::open(const CityChoice& choice, const SuiteOptions& options,
                                  const std::stop_token& stop) {
    CityForms city(choice.terrain, options);
    std::vector<CityForm> forms{CityForm::heights, CityForm::meshes};
    if (choice.terrain == "urban") {
        forms.push_back(CityForm::meshes_only);
    }
    for (const CityForm form : forms) {
        if (auto opened = city.open_form(choice, form, stop); !opened) {
            return opened.error();
        }
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
        const Hit& drawn = shown(pixel.x, pixel.y);
        if (!is_of_mesh(drawn)) {
            return truth::reprojection_error(view, options_.size, pixel, hit);
        }
        const Ray ray = scene::view_ray(camera, options_.size, glm::dvec2(pixel) + 0.5);
        return truth::distance_to_pixel(camera, options_.size, pixel, ray.at(drawn.depth));
    };
    return truth::geometric_errors({reprojection, truth::hit_error}, on_terrain(shown),
                                   on_terrain(truth), static_cast<unsigned>(options_.threads));
}

} // namespace reljef::bench

#include "bench/runner/benchmark_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "app/cli/console_log.h"
#include "app/cli/program.h"
#include "bench/runner/gallery_tiles.h"
#include "engine/core/check.h"
#include "engine/io/formats/scene_file.h"
#include "engine/session/calibration/calibration.h"
#include "engine/truth/hidden_places.h"

namespace reljef::bench {
namespace {

Result<session::TerrainSource> open_source(const SceneChoice& choice,
                                           const session::SourceOptions& terrain, session::Log& log,
                                           const std::stop_token& stop) {
    if (choice.size == 0) {
        return open_measured(terrain, log, stop);
    }
    io::SceneDescription description;
    description.name =
        fmt::format("{} {}{}", choice.terrain, choice.size, choice.tileable ? " tile" : "");
    description.generator = choice.terrain;
    description.size = choice.size;
    description.tileable = choice.tileable;
    description.walls = building::CityWalls::stepped;
    return session::open_terrain(std::move(description), terrain, log, stop);
}

bool shows_gallery(const std::string& terrain) {
    if (std::filesystem::path(terrain).extension() != ".toml") {
        return terrain == "gallery";
    }
    const auto scene = io::read_scene_file(terrain);
    return scene && scene->generator == "gallery"; // opening reports errors
}

constexpr int detail_rays_per_side = 2; // per pixel of the true picture; texels are pixel-sized

scene::Material material_of(const truth::DetailSquare& square) {
    scene::Material material;
    material.detail = {.set = square.set,
                       .repeats = glm::vec2(static_cast<float>(square.repeats)),
                       .scale = static_cast<float>(square.scale),
                       .offset = static_cast<float>(square.offset)};
    return material;
}

std::optional<RowError::Geometric> geometric_of(const truth::PixelErrors& errors) {
    return errors.distribution
               ? std::optional(RowError::Geometric{*errors.distribution, errors.unbounded})
               : std::nullopt;
}

} // namespace

RowError row_error_of(const truth::GeometricErrors& geometric, const truth::ImageErrors& image) {
    return {.reprojection_px = geometric_of(geometric.reprojection),
            .hit_texels = geometric_of(geometric.hit),
            .wrong_percent = geometric.wrong_percent,
            .wrong_of_terrain_percent = geometric.wrong_of_terrain_percent,
            .holes = geometric.holes,
            .rmse = image.rmse,
            .psnr = std::isfinite(image.psnr) ? std::optional(image.psnr) : std::nullopt,
            .ssim = image.ssim,
            .flip = image.flip.mean};
}

Result<session::Device> make_device(const SuiteOptions& options) {
    const bool is_beside_rays = options.context == session::BackendKind::cpu;
    auto device = session::Device::create(
        {.context = is_beside_rays ? std::optional<session::BackendKind>() : options.context,
         .size = options.size,
         .shader_dir = options.shader_dir,
         .threads = options.threads,
         .selects_always = true,
         .cuts_always = options.cold});
    if (!device || options.calibration.empty()) {
        return device;
    }
    const auto costs = session::read_costs(options.calibration,
                                           session::place_of(device->info(), cli::version_text()));
    if (!costs) {
        return costs.error();
    }
    device->renderer().set_costs(*costs);
    return device;
}

Environment environment_of(const session::Device& device, int threads) {
    Environment environment = environment_of(device.info(), threads);
    environment.costs = session::costs_text(device.renderer().costs());
    return environment;
}

Result<session::Device> make_rays_device(const SuiteOptions& options) {
    return session::Device::create({.context = session::BackendKind::cpu,
                                    .size = options.size,
                                    .threads = options.threads,
                                    .simd = options.simd,
                                    .selects_always = true});
}

Result<BenchmarkScene> BenchmarkScene::open_detail(const SceneChoice& choice,
                                                   const SuiteOptions& options) {
    const auto square = detail_square(choice.detail, static_cast<unsigned>(options.threads));
    if (!square) {
        return square.error();
    }
    auto plane = truth::DetailPlane::create(*square);
    if (!plane) {
        return plane.error();
    }
    session::TerrainScene square_scene;
    scene::Mesh mesh = scene::plane_mesh(glm::vec2(static_cast<float>(square->side)));
    square_scene.bounds = scene::bounds_of(mesh);
    square_scene.models = {&square_scene.scene.add_mesh(std::move(mesh), material_of(*square))};
    square_scene.light = &square_scene.scene.add_light(square->light);
    square_scene.camera = &square_scene.scene.add_camera({});
    BenchmarkScene scene("tile " + choice.detail, std::move(square_scene), options);
    scene.detail_ = std::move(*plane);
    return scene;
}

Result<session::TerrainSource> open_measured(const session::SourceOptions& terrain,
                                             session::Log& log, const std::stop_token& stop) {
    session::SourceOptions measured = terrain;
    if (terrain.terrain == "urban") {
        measured.walls = building::CityWalls::stepped;
    }
    return session::open_terrain(measured, log, stop);
}

Result<BenchmarkScene> BenchmarkScene::open(const SceneChoice& choice, const SuiteOptions& options,
                                            const std::stop_token& stop) {
    if (!choice.detail.empty()) {
        return open_detail(choice, options);
    }
    if (shows_gallery(choice.terrain)) {
        return Error{fmt::format("{}: the gallery found, a terrain was expected: the truth of its "
                                 "models is not known; tables and pareto measure its tiles, "
                                 "--terrain gallery",
                                 choice.terrain)};
    }
    session::SourceOptions terrain;
    terrain.terrain = choice.terrain;
    terrain.threads = options.threads;
    if (choice.memory_megabytes > 0) {
        terrain.memory_megabytes = choice.memory_megabytes;
        terrain.streamed = true;
    }
    cli::ConsoleLog log(options.quiet);
    terrain.placement = choice.placement;
    auto source = open_source(choice, terrain, log, stop);
    if (!source) {
        return source.error();
    }
    session::SceneOptions view;
    view.pose = scene::Pose::overview;
    std::string name = source->description.name;
    auto scene = session::make_scene(std::move(*source), terrain, view, log);
    if (!scene) {
        return scene.error();
    }
    return BenchmarkScene(std::move(name), std::move(*scene), options);
}

void set_pose(session::TerrainScene& scene, scene::Pose pose) {
    scene::Camera& camera = *scene.camera->get<scene::Camera>();
    const double near = camera.near;
    camera = scene.pose_camera(pose);
    camera.near = near;
}

Result<void> BenchmarkScene::look_from(double distance, double down) {
    scene::Camera& camera = *scene_.camera->get<scene::Camera>();
    scene::Camera looking;
    looking.near = camera.near;
    looking.target = {0.0, 0.0, scene_.ground(0.0, 0.0)};
    const double angle = glm::radians(down);
    looking.eye = looking.target + distance * glm::dvec3(0.0, -std::cos(angle), std::sin(angle));
    if (looking.eye.z <= scene_.ground(looking.eye.x, looking.eye.y)) {
        return Error{fmt::format("{}: ground found {} m from its middle, {} degrees up; an eye "
                                 "above the ground was expected",
                                 name(), distance, down)};
    }
    camera = looking;
    distance_ = distance;
    pose_.reset();
    truth_.reset();
    return {};
}

std::string BenchmarkScene::view_text() const {
    return pose_ ? std::string(scene::to_string(*pose_)) : fmt::format("from {} m", distance_);
}

void BenchmarkScene::set_camera(const scene::Camera& camera) {
    *scene_.camera->get<scene::Camera>() = camera;
}

void BenchmarkScene::set_daylight(Daylight daylight) {
    constexpr double low_altitude = 10.0; // degrees
    auto& sun = *scene_.light->get<scene::Light>();
    sun_altitude_ = sun_altitude_.value_or(sun.altitude);
    sun.altitude = daylight == Daylight::low_sun ? low_altitude : *sun_altitude_;
    scene_.light->set_visible(daylight != Daylight::night);
    if (const auto& sky = scene_.scene.sky()) {
        scene::Sky changed = *sky;
        visibility_ = visibility_.value_or(sky->visibility);
        changed.visibility = daylight == Daylight::night ? 0.0 : *visibility_;
        scene_.scene.set_sky(changed);
    }
}

void BenchmarkScene::set_technique(const scene::Technique& technique) {
    for (scene::Material* const material : scene_.materials()) {
        material->technique = technique;
    }
}

Result<truth::Picture> BenchmarkScene::draw_truth(const ParallelOptions& parallel) {
    if (detail_) {
        return detail_->draw(scene().camera(), options_.size,
                             {.rays_per_side = detail_rays_per_side, .parallel = parallel});
    }
    if (!caster_) {
        auto caster = truth::SceneCaster::create(scene());
        if (!caster) {
            return caster.error();
        }
        caster_ = std::move(*caster);
        shading_.emplace(scene(), *caster_);
    }
    return truth::draw(*caster_, *shading_, scene().camera(), options_.size,
                       {.parallel = parallel});
}

Result<const BenchmarkScene::TruePicture*> BenchmarkScene::truth(const std::stop_token& stop) {
    if (truth_ && truth_->pose == pose_) {
        return &*truth_;
    }
    auto picture = draw_truth({static_cast<unsigned>(options_.threads), stop, {}});
    if (!picture) {
        return picture.error();
    }
    truth_ = TruePicture{pose_, std::move(picture->hits),
                         std::make_shared<const Image>(std::move(picture->image))};
    return &*truth_;
}

Result<truth::GeometricErrors> BenchmarkScene::errors(const HitBuffer& shown,
                                                      const HitBuffer& truth) const {
    const auto threads = static_cast<unsigned>(options_.threads);
    if (detail_) {
        return detail_->errors(scene().camera(), shown, truth, threads);
    }
    return truth::geometric_errors(surface_view(), shown, truth, threads);
}

truth::SurfaceView BenchmarkScene::surface_view() const {
    const scene::TerrainSurface& surface = *terrain().get<scene::TerrainNode>()->surface;
    return {surface.heightfield().heights.view(), surface.placement(), terrain().world_from_local(),
            scene().camera()};
}

Result<double> BenchmarkScene::hidden_percent(session::SceneRenderer& renderer) const {
    check(caster_ && !caster_->terrains().empty(), "measure_error() of a terrain before");
    const auto hits = renderer.draw_hits(scene());
    if (!hits) {
        return hits.error();
    }
    return truth::hidden_places(surface_view(), caster_->terrains().front().caster, *hits,
                                static_cast<unsigned>(options_.threads))
        .hidden_percent();
}

Result<MeasuredError> BenchmarkScene::measure_error(const scene::Technique& technique,
                                                    session::SceneRenderer& renderer,
                                                    const std::stop_token& stop) {
    set_technique(technique);
    const auto stats = renderer.draw(scene());
    if (!stats) {
        return stats.error();
    }
    Image shown = renderer.read_color();
    const auto hits = renderer.draw_hits(scene());
    if (!hits) {
        return hits.error();
    }
    const auto exact = truth(stop);
    if (!exact) {
        return exact.error();
    }
    if (!truth::has_terrain(*hits) && !truth::has_terrain((*exact)->hits)) {
        return Error{fmt::format("{}, {}: no pixel of terrain found in the picture, some were "
                                 "expected",
                                 name(), view_text())};
    }
    auto geometric = errors(*hits, (*exact)->hits);
    if (!geometric) {
        return geometric.error();
    }
    const auto image = truth::image_errors(shown, *(*exact)->image,
                                           {.threads = static_cast<unsigned>(options_.threads)});
    if (!image) {
        return image.error();
    }
    MeasuredError measured{row_error_of(*geometric, *image), {}};
    if (options_.keep_views) {
        measured.view =
            ShownView{std::move(shown), (*exact)->image, std::move(geometric->reprojection.map)};
    }
    return measured;
}

Result<BenchmarkScene*> BenchmarkScenes::get(const SceneChoice& choice) {
    const auto found = std::find_if(open_.begin(), open_.end(),
                                    [&](const auto& entry) { return entry.first == choice; });
    if (found != open_.end()) {
        return found->second.get();
    }
    if (!keep_) {
        open_.clear();
    }
    auto scene = BenchmarkScene::open(choice, options_, stop_);
    if (!scene) {
        return scene.error();
    }
    if (stop_.stop_requested()) {
        return Error{"stopped"};
    }
    open_.emplace_back(choice, std::make_unique<BenchmarkScene>(std::move(*scene)));
    return open_.back().second.get();
}

} // namespace reljef::bench

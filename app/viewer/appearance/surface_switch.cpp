#include "app/viewer/appearance/surface_switch.h"

#include <fmt/format.h>

#include "engine/session/scene_daylight.h"

namespace reljef::app {
namespace {

// `finer`: null: the terrain that is shown.
Result<scene::TerrainSurface> surface_of(const scene::TerrainSurface& shown,
                                         std::shared_ptr<const terrain::Terrain> finer,
                                         const scene::TerrainOptions& options) {
    if (finer != nullptr) {
        return scene::TerrainSurface::create(std::move(finer), options);
    }
    return shown.changed(options);
}

} // namespace

std::string SurfaceSwitch::obstacle() const {
    return scene_.models.empty() ? "" : "models have no vertical exaggeration; a terrain has";
}

SurfaceSwitch::Shape SurfaceSwitch::now() const {
    if (next_) {
        return *next_;
    }
    const scene::TerrainSurface& shown = surface();
    return is_working() ? preparing_
                        : Shape{shown.placement().exaggeration(), shown.ramp(),
                                shown.imagery_share(), shown.overlay(), nullptr};
}

double SurfaceSwitch::factor() const {
    if (next_) {
        return next_->factor;
    }
    return is_working() ? preparing_.factor : surface().placement().exaggeration();
}

const terrain::ColorRamp& SurfaceSwitch::ramp() const {
    if (next_) {
        return next_->ramp;
    }
    return is_working() ? preparing_.ramp : surface().ramp();
}

double SurfaceSwitch::imagery_share() const {
    if (next_) {
        return next_->imagery_share;
    }
    return is_working() ? preparing_.imagery_share : surface().imagery_share();
}

bool SurfaceSwitch::update(const scene::Technique& technique, const scene::Light& light,
                           glm::ivec2 size) {
    if (work_ && work_->is_done()) {
        end();
    }
    if (made_ && is_outdated()) {
        next_ = next_ ? std::move(next_) : std::optional(preparing_);
        made_.reset();
    }
    if (made_ && is_loaded(size)) {
        show();
        return true;
    }
    if (!is_working() && next_) {
        begin(*std::exchange(next_, std::nullopt), technique, light);
    }
    return false;
}

// Streams only: tiles of an earlier request, or without the proofs that are there now.
bool SurfaceSwitch::is_outdated() const {
    return made_->shown.stream != nullptr && (next_ || made_->source != scene_.source);
}

bool SurfaceSwitch::is_loaded(glm::ivec2 size) const {
    const bool is_minimized = size.x == 0 || size.y == 0;
    return made_->shown.stream == nullptr ||
           (!is_minimized &&
            session::load_view(scene_.scene, *scene_.terrain->get<scene::TerrainNode>(),
                               made_->shown, size));
}

bool SurfaceSwitch::has_ground(const Shape& shape) const {
    return shape.finer == nullptr && shape.factor == surface().placement().exaggeration();
}

scene::TerrainNode SurfaceSwitch::kept_for(const Shape& shape) const {
    scene::TerrainNode node = *scene_.terrain->get<scene::TerrainNode>();
    if (!has_ground(shape)) {
        node.bisection = nullptr;
    }
    if (shape.finer != nullptr) {
        node.cones = nullptr;
    }
    return node;
}

void SurfaceSwitch::begin(Shape shape, const scene::Technique& technique,
                          const scene::Light& light) {
    const auto& node = *scene_.terrain->get<scene::TerrainNode>();
    const scene::TerrainNode kept = kept_for(shape);
    session::MissingMaps missing;
    missing.bisection = kept.bisection != node.bisection;
    missing.cones = kept.cones != node.cones;
    missing.light = session::light_request(scene_, light, technique, largest_side_);
    preparing_ = std::move(shape);
    work_.emplace([shown = kept, technique, rays = scene_.rays, missing = std::move(missing),
                   shape = preparing_, threads = threads_, source = scene_.source,
                   this](const std::stop_token& stop) -> Result<Made> {
        auto task = shape.finer != nullptr ? log_.start("refining " + shape.finer->name) : nullptr;
        auto changed = surface_of(*shown.surface, shape.finer,
                                  {shown.surface->placement().kind(), shape.factor, shape.ramp,
                                   shape.imagery_share, shape.overlay});
        task = nullptr;
        if (!changed) {
            return changed.error();
        }
        Made made;
        made.shown.surface = std::make_shared<const scene::TerrainSurface>(std::move(*changed));
        if (shown.stream != nullptr) {
            made.source = source;
            made.shown.stream = session::make_stream(*source, made.shown.surface);
        }
        session::MissingMaps requested = missing;
        requested.surface = made.shown.surface;
        scene::TerrainNode changed_node = shown;
        changed_node.surface = made.shown.surface;
        const auto of_technique = session::missing_maps(changed_node, technique, rays);
        requested.bisection = requested.bisection || of_technique.bisection;
        requested.cones = requested.cones || of_technique.cones;
        if (requested.light) {
            requested.light->surface = made.shown.surface;
            requested.light->stream = made.shown.stream;
        }
        auto maps = session::prepare_maps(requested, threads, log_, stop);
        if (!maps) {
            return maps.error();
        }
        made.maps = std::move(*maps);
        return made;
    });
}

void SurfaceSwitch::end() {
    auto made = work_->take();
    work_.reset();
    if (made) {
        made_ = std::move(*made);
        return;
    }
    log_.note(preparing_.finer != nullptr
                  ? fmt::format("{}: shown with fewer samples than it has: {}",
                                preparing_.finer->name, made.error().message)
                  : made.error().message);
}

void SurfaceSwitch::show() {
    const Made made = *std::exchange(made_, std::nullopt);
    if (next_ && next_->finer == preparing_.finer) {
        next_->finer = nullptr; // it is shown now
    }
    auto& node = *scene_.terrain->get<scene::TerrainNode>();
    node.bisection = has_ground(preparing_) ? node.bisection : nullptr;
    node.surface = made.shown.surface;
    node.stream = made.shown.stream;
    session::follow_ramp(scene_);
    node.cones = preparing_.finer != nullptr ? nullptr : node.cones;
    session::apply_maps(scene_, made.maps);
    session::stand_on(*node.surface, scene_.objects);
    session::stand_on(*node.surface, scene_.buildings);
    session::stand_on(*node.surface, scene_.point_lights);
    scene_.bounds = scene_.terrain->world_bounds();
    if (scene_.city_heights != nullptr) {
        auto city = scene_.city_heights->exaggerated(node.surface->placement().exaggeration());
        scene_.city_heights =
            city ? std::make_shared<const scene::TerrainSurface>(std::move(*city)) : nullptr;
    }
    session::set_daylight(scene_, *scene_.light->get<scene::Light>());
    light_ = made.maps.light;
}

} // namespace reljef::app

#include "engine/render/residency/tile_maps.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "engine/render/residency/uploads.h"

namespace reljef::render {
namespace {

// Frames that unused maps stay.
constexpr std::uint64_t kept_frames_of_maps = 8;

// The outermost texel centres are the outermost vertices.
glm::vec4 lit_from_samples(const scene::TileBuilder& maker, const scene::TerrainTile& tile) {
    const glm::dvec2 texels(tile.albedo.cols(), tile.albedo.rows());
    const glm::dvec2 samples = glm::dvec2(tile.cells) * maker.step(tile.id);
    return {glm::vec2((texels - 1.0) / (samples * texels)), glm::vec2(0.5 / texels)};
}

} // namespace

namespace {

struct LightOfTile {
    Image lit;
    Image sun; // of its parts, or empty
};

// `irradiance`: null: no light.
LightOfTile light_of_tile(const view::TileDraw& draw, const scene::TerrainIrradiance* irradiance,
                          bool in_parts) {
    const scene::TileBuilder& builder = draw.terrain->stream->maker();
    if (irradiance == nullptr) {
        return {draw.tile->albedo, {}};
    }
    if (!in_parts) {
        return {scene::lit_tile(builder, *draw.tile, *irradiance), {}};
    }
    scene::LitTileParts parts = scene::lit_tile_parts(builder, *draw.tile, *irradiance);
    return {std::move(parts.sky), std::move(parts.sun)};
}

} // namespace

TileMaps::Entry& TileMaps::entry_of(const view::TileDraw& draw) {
    Entry& entry = entries_[key_of(draw)];
    if (entry.owner.lock() != draw.tile) {
        entry = {};
        entry.owner = draw.tile;
        entry.maps.lit_from_sample = lit_from_samples(draw.terrain->stream->maker(), *draw.tile);
    }
    entry.drawn = frame_;
    return entry;
}

Result<void> TileMaps::prepare(const view::DrawList& list, view::FrameStats& stats) {
    ++frame_;
    for (const view::TileDraw& draw : list.tiles) {
        if (draw.tile->borrows) {
            continue;
        }
        Entry& entry = entry_of(draw);
        if (auto done = prepare_light(list, draw, entry, stats); !done) {
            return done;
        }
        if (auto done = prepare_ground(list, draw, entry, stats); !done) {
            return done;
        }
    }
    std::erase_if(entries_, [&](const auto& entry) {
        return entry.second.owner.expired() || entry.second.drawn + kept_frames_of_maps < frame_;
    });
    forget_lights(list);
    return {};
}

void TileMaps::forget_lights(const view::DrawList& list) {
    for (SharedLight& light : lights_) {
        const bool is_shown = std::any_of(
            list.terrains.begin(), list.terrains.end(), [&](const view::TerrainDraw& draw) {
                return draw.terrain->stream == light.owner.lock() &&
                       view::light_on(list, draw.world_from_local) == light.light;
            });
        light.shown = is_shown ? frame_ : light.shown;
    }
    // A light that moves leaves none behind.
    const auto is_followed = [&](const SharedLight& light) {
        return light.shown < frame_ &&
               std::any_of(lights_.begin(), lights_.end(), [&](const SharedLight& other) {
                   return other.shown == frame_ && !other.owner.owner_before(light.owner) &&
                          !light.owner.owner_before(other.owner);
               });
    };
    std::vector<SharedLight> kept;
    std::copy_if(lights_.begin(), lights_.end(), std::back_inserter(kept),
                 [&](const SharedLight& light) {
                     return !light.owner.expired() && !is_followed(light) &&
                            light.shown + kept_frames_of_maps >= frame_;
                 });
    lights_ = std::move(kept);
}

Result<void> TileMaps::prepare_light(const view::DrawList& list, const view::TileDraw& draw,
                                     Entry& entry, view::FrameStats& stats) {
    const auto light = view::light_on(list, list.world_from_local(draw));
    const bool in_parts = light && draw.terrain->material.technique.options.shadow;
    if (entry.maps.lit && entry.light == light && entry.maps.sun.has_value() == in_parts) {
        ++stats.skipped.uploads_unchanged;
        return {};
    }
    const LightOfTile map = light_of_tile(
        draw, light ? &irradiance_of(draw.terrain->stream, *light) : nullptr, in_parts);
    entry.maps.sun.reset();
    auto kept = keep(upload_mipmapped(map.lit, gl::Format::rgba8_srgb, stats), entry.maps.lit);
    if (kept && in_parts) {
        kept = keep(upload_mipmapped(map.sun, gl::Format::rgba8_srgb, stats), entry.maps.sun);
    }
    if (!kept) {
        return kept;
    }
    entry.maps.ground.reset();
    entry.light = light;
    return {};
}

Result<void> TileMaps::prepare_ground(const view::DrawList& list, const view::TileDraw& draw,
                                      Entry& entry, view::FrameStats& stats) {
    if (draw.detail == view::DetailLevel::none && !view::needs_ground(list, draw)) {
        entry.maps.ground.reset(); // no budget counts it: keep it only where it is seen
        return {};
    }
    if (entry.maps.ground) {
        return {};
    }
    const scene::TerrainIrradiance* const irradiance =
        entry.light ? &irradiance_of(draw.terrain->stream, *entry.light) : nullptr;
    auto ground =
        resident_ground(view::ground_of_tile(draw.terrain->stream->maker(), *draw.tile, irradiance),
                        entry.maps.lit_from_sample, stats);
    if (!ground) {
        return ground.error();
    }
    entry.maps.ground = std::move(*ground);
    return {};
}

void TileMaps::add_light(const std::shared_ptr<scene::TileStream>& stream,
                         const scene::TerrainLight& light,
                         std::shared_ptr<const scene::TerrainIrradiance> irradiance) {
    std::erase_if(lights_, [&](const SharedLight& other) {
        return other.owner.lock() == stream && other.light == light;
    });
    lights_.push_back({stream, frame_, light, std::move(irradiance)});
}

const scene::TerrainIrradiance&
TileMaps::irradiance_of(const std::shared_ptr<scene::TileStream>& stream,
                        const scene::TerrainLight& light) {
    const auto found = std::find_if(lights_.begin(), lights_.end(), [&](const SharedLight& other) {
        return other.owner.lock() == stream && other.light == light;
    });
    if (found != lights_.end()) {
        return *found->irradiance;
    }
    auto made = std::make_shared<const scene::TerrainIrradiance>(stream->maker().overview(), light);
    return *lights_.emplace_back(SharedLight{stream, frame_, light, std::move(made)}).irradiance;
}

const ResidentTileMaps& TileMaps::tile(const view::TileDraw& draw) const {
    return entries_.at(key_of(draw)).maps;
}

} // namespace reljef::render

#include "bench/runner/gallery_tiles.h"

#include <algorithm>
#include <array>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/usage_error.h"
#include "terrains/gallery/detail_tiles.h"

namespace reljef::bench {
namespace {

constexpr int tile_texels = 256; // each about a pixel of a usual picture
constexpr double square_side = 4.0;
constexpr int tiles_a_side = 3;

struct MeasuredTile {
    std::string_view name;
    scene::TechniqueId technique; ///< texture: all that look for heights
    std::optional<material::LayerKind> layers;
};

constexpr std::array<MeasuredTile, 4> measured_tiles{
    {{"brick", scene::TechniqueId::texture, std::nullopt},
     {"fence", scene::TechniqueId::lattice, material::LayerKind::symmetric},
     {"copper", scene::TechniqueId::dual_layer, material::LayerKind::dual},
     {"rings", scene::TechniqueId::multi_layer, material::LayerKind::multi}}};

const MeasuredTile* measured_tile(std::string_view name) {
    const auto* const found =
        std::find_if(measured_tiles.begin(), measured_tiles.end(),
                     [&](const MeasuredTile& tile) { return tile.name == name; });
    return found == measured_tiles.end() ? nullptr : found;
}

} // namespace

Result<truth::TileSquare> tile_square(std::string_view name, unsigned threads) {
    auto set = terrains::generate_detail(name, {.size = tile_texels, .threads = threads});
    if (!set) {
        return set.error();
    }
    const MeasuredTile* const tile = measured_tile(name);
    truth::TileSquare square;
    square.set = std::make_shared<const material::ReliefMaterial>(std::move(*set));
    square.layers = tile == nullptr ? std::nullopt : tile->layers;
    square.side = square_side;
    square.repeats = tiles_a_side;
    square.scale = static_cast<double>(square.set->scale);
    square.offset = square.layers ? -0.5 : -1.0;
    square.light.azimuth = 232.0;
    square.light.altitude = 38.0;
    return square;
}

std::vector<SceneChoice> gallery_scenes() {
    std::vector<SceneChoice> scenes(measured_tiles.size());
    std::transform(measured_tiles.begin(), measured_tiles.end(), scenes.begin(),
                   [](const MeasuredTile& tile) {
                       return SceneChoice{.terrain = "gallery", .tile = std::string(tile.name)};
                   });
    return scenes;
}

bool suits(scene::TechniqueId id, const SceneChoice& scene) {
    const MeasuredTile* const tile = measured_tile(scene.tile);
    if (tile == nullptr) {
        return scene::draws_terrain(id);
    }
    if (id == scene::TechniqueId::texture) {
        return true;
    }
    return tile->layers ? id == tile->technique
                        : id != scene::TechniqueId::polygons && !scene::looks_for_layers(id);
}

std::vector<scene::TechniqueInfo> techniques_of(const SceneChoice& scene) {
    std::vector<scene::TechniqueInfo> infos;
    const auto catalogue = scene::technique_catalogue();
    std::copy_if(catalogue.begin(), catalogue.end(), std::back_inserter(infos),
                 [&](const scene::TechniqueInfo& info) { return suits(info.id, scene); });
    return infos;
}

void expect_suited(const std::vector<scene::Technique>& techniques,
                   const std::vector<std::string>& terrains) {
    std::vector<SceneChoice> scenes;
    for (const std::string& terrain : terrains) {
        const auto more =
            terrain == "gallery" ? gallery_scenes() : std::vector{SceneChoice{.terrain = terrain}};
        scenes.insert(scenes.end(), more.begin(), more.end());
    }
    const auto is_drawn = [&](const scene::Technique& technique) {
        return std::any_of(scenes.begin(), scenes.end(),
                           [&](const SceneChoice& scene) { return suits(technique.id(), scene); });
    };
    if (!techniques.empty() && std::none_of(techniques.begin(), techniques.end(), is_drawn)) {
        cli::fail_usage(fmt::format("--technique: {} found, which shows nothing of {}; the gallery "
                                    "shows what bump, emboss, normal, displacement and the layers "
                                    "draw, terrains what polygons draws",
                                    scene::to_string(techniques.front()),
                                    fmt::join(terrains, ", ")));
    }
}

} // namespace reljef::bench

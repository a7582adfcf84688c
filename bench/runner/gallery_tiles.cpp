#include "bench/runner/gallery_tiles.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/usage_error.h"
#include "terrains/gallery/detail_tiles.h"

namespace reljef::bench {
namespace {

constexpr int detail_texels = 256; // a texel is about a pixel wide
constexpr double square_side = 4.0;
constexpr int copies_a_side = 3;

struct GalleryDetail {
    std::string_view name;
    scene::TechniqueId technique; // texture: all techniques for heightfields
    std::optional<material::LayerKind> layers;
};

constexpr std::array<GalleryDetail, 4> gallery_details{
    {{"brick", scene::TechniqueId::texture, std::nullopt},
     {"fence", scene::TechniqueId::lattice, material::LayerKind::symmetric},
     {"copper", scene::TechniqueId::dual_layer, material::LayerKind::dual},
     {"rings", scene::TechniqueId::multi_layer, material::LayerKind::multi}}};

const GalleryDetail* find_detail(std::string_view name) {
    const auto* const found =
        std::find_if(gallery_details.begin(), gallery_details.end(),
                     [&](const GalleryDetail& detail) { return detail.name == name; });
    return found == gallery_details.end() ? nullptr : found;
}

} // namespace

Result<truth::DetailSquare> detail_square(std::string_view name, unsigned threads) {
    auto set = terrains::generate_detail(name, {.size = detail_texels, .threads = threads});
    if (!set) {
        return set.error();
    }
    const GalleryDetail* const detail = find_detail(name);
    truth::DetailSquare square;
    square.set = std::make_shared<const material::ReliefMaterial>(std::move(*set));
    square.layers = detail == nullptr ? std::nullopt : detail->layers;
    square.side = square_side;
    square.repeats = copies_a_side;
    square.scale = static_cast<double>(square.set->scale);
    square.offset = square.layers ? -0.5 : -1.0;
    square.light.azimuth = 232.0;
    square.light.altitude = 38.0;
    return square;
}

std::vector<SceneChoice> gallery_scenes() {
    std::vector<SceneChoice> scenes;
    scenes.reserve(gallery_details.size());
    for (const GalleryDetail& detail : gallery_details) {
        scenes.push_back({.terrain = "gallery", .detail = std::string(detail.name)});
    }
    return scenes;
}

bool suits(scene::TechniqueId id, const SceneChoice& scene) {
    const GalleryDetail* const detail = find_detail(scene.detail);
    if (detail == nullptr) {
        return scene::draws_terrain(id);
    }
    if (id == scene::TechniqueId::texture) {
        return true;
    }
    const bool is_of_terrain =
        id == scene::TechniqueId::polygons || id == scene::TechniqueId::automatic;
    return detail->layers ? id == detail->technique : !is_of_terrain && !scene::searches_layers(id);
}

std::vector<scene::TechniqueInfo> techniques_of(const SceneChoice& scene) {
    const auto catalogue = scene::technique_catalogue();
    std::vector<scene::TechniqueInfo> infos(catalogue.begin(), catalogue.end());
    std::erase_if(infos, [&](const scene::TechniqueInfo& info) { return !suits(info.id, scene); });
    return infos;
}

void check_suited(const std::vector<scene::Technique>& techniques,
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

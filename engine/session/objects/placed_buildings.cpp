#include "engine/session/objects/placed_buildings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include "engine/building/building_faces.h"
#include "engine/core/check.h"
#include "engine/core/statistics.h"
#include "engine/io/footprints/footprint_file.h"
#include "engine/io/tile_set.h"
#include "engine/session/objects/building_meshes.h"
#include "engine/session/objects/upright_axes.h"

namespace reljef::session {
namespace {

constexpr double foot_depth = 1.0; // metres of wall in the ground, for ground between the samples

// Why footprints of a file are left out.
struct LeftOut {
    io::FootprintCounts in_file;
    std::size_t outside = 0;
    std::size_t in_voids = 0;
    std::size_t no_surface = 0;
};

bool is_georeferenced(const BuildingGround& ground) {
    return ground.surface.heightfield().georeference.has_value();
}

// Corners of a file to columns and rows; empty outside.
std::optional<building::Footprint> in_samples(const BuildingGround& ground,
                                              building::Footprint shape) {
    const terrain::Heightfield& field = ground.surface.heightfield();
    const terrain::Placement& placement = ground.surface.placement();
    const glm::dvec2 last(field.heights.cols() - 1, field.heights.rows() - 1);
    for (building::Ring& ring : shape.rings) {
        for (glm::dvec2& corner : ring) {
            const auto world = is_georeferenced(ground)
                                   ? placement.world_from_geodetic({corner.y, corner.x, 0.0})
                                   : std::optional(glm::dvec3(corner, 0.0));
            const auto sample = world ? placement.sample_from_world(*world) : std::nullopt;
            const bool is_inside = sample && sample->x >= 0.0 && sample->y >= 0.0 &&
                                   sample->x <= last.x && sample->y <= last.y;
            if (!is_inside) {
                return std::nullopt;
            }
            corner = glm::dvec2(*sample);
        }
    }
    return shape;
}

// Places on the outline, at most a sample apart, in columns and rows.
std::vector<glm::dvec2> places_on_outline(const building::Footprint& samples) {
    constexpr int max_places = 1000; // on an edge
    std::vector<glm::dvec2> places;
    for (const building::Ring& ring : samples.rings) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const glm::dvec2 way = ring[(i + 1) % ring.size()] - ring[i];
            const int pieces = clamped_int(std::ceil(glm::length(way)), 1, max_places);
            for (int k = 0; k < pieces; ++k) {
                places.push_back(ring[i] + way * (static_cast<double>(k) / pieces));
            }
        }
    }
    return places;
}

// Latitudes and longitudes of columns and rows.
std::vector<glm::dvec2> on_earth(const BuildingGround& ground,
                                 const std::vector<glm::dvec2>& samples) {
    std::vector<glm::dvec2> places;
    for (const glm::dvec2 sample : samples) {
        const geo::GeodeticMap& map = ground.surface.heightfield().georeference->geodetic;
        places.push_back(map.latitude_longitude(sample));
    }
    return places;
}

// The lowest ground at these columns and rows; empty in voids.
std::optional<double> lowest_ground(const BuildingGround& ground,
                                    const std::vector<glm::dvec2>& samples) {
    double lowest = std::numeric_limits<double>::infinity();
    if (ground.heights) {
        for (const std::optional<double> height : ground.heights(on_earth(ground, samples))) {
            if (!height) {
                return std::nullopt;
            }
            lowest = std::min(lowest, *height);
        }
        return lowest;
    }
    const terrain::Heightfield& field = ground.surface.heightfield();
    for (const glm::dvec2 sample : samples) {
        if (terrain::uses_void(field, sample)) {
            return std::nullopt;
        }
        lowest = std::min(lowest, terrain::bilinear_height(field.heights.view(), sample));
    }
    return lowest;
}

// By the even-odd rule over all rings.
bool is_inside(const building::Footprint& shape, glm::dvec2 place) {
    bool inside = false;
    for (const building::Ring& ring : shape.rings) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const glm::dvec2 a = ring[i];
            const glm::dvec2 b = ring[(i + 1) % ring.size()];
            if ((a.y > place.y) != (b.y > place.y) &&
                place.x < a.x + (b.x - a.x) * (place.y - a.y) / (b.y - a.y)) {
                inside = !inside;
            }
        }
    }
    return inside;
}

// Up to 256 columns and rows in the outline, evenly spread; the middle of a triangle if all miss.
std::vector<glm::dvec2> places_inside(const building::Footprint& samples) {
    constexpr int side = 16;
    const building::Ring& outer = samples.rings.front();
    glm::dvec2 low = outer.front();
    glm::dvec2 high = low;
    for (const glm::dvec2 corner : outer) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    std::vector<glm::dvec2> places;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const glm::dvec2 share = (glm::dvec2(x, y) + 0.5) / static_cast<double>(side);
            const glm::dvec2 place = glm::mix(low, high, share);
            if (is_inside(samples, place)) {
                places.push_back(place);
            }
        }
    }
    if (places.empty()) {
        std::vector<glm::dvec2> corners;
        for (const building::Ring& ring : samples.rings) {
            corners.insert(corners.end(), ring.begin(), ring.end());
        }
        const glm::uvec3 first = samples.triangles.front();
        places.push_back((corners[first.x] + corners[first.y] + corners[first.z]) / 3.0);
    }
    return places;
}

// The median height of the surface model; empty where it has none.
std::optional<double> roof_on(const io::TileSet& model, const std::vector<glm::dvec2>& places) {
    std::vector<double> heights;
    for (const io::HeightSample& found : model.heights(places).answers) {
        if (found.kind == io::HeightSample::Kind::height) {
            heights.push_back(found.height);
        }
    }
    return heights.empty() ? std::nullopt : std::optional(median(heights));
}

// The buildings of one file.
class FootprintPlacing {
public:
    FootprintPlacing(const BuildingGround& ground, const io::FootprintsDescription& description,
                     const io::TileSet* model)
        : ground_(ground), description_(description), model_(model) {}

    void add(io::FileFootprint found, std::vector<Standing>& standing) {
        auto samples = in_samples(ground_, std::move(found.shape));
        if (!samples) {
            ++left_out_.outside;
            return;
        }
        const auto lowest = lowest_ground(ground_, places_on_outline(*samples));
        if (!lowest) {
            ++left_out_.in_voids;
            return;
        }
        const auto height = found.height ? found.height : height_above(*samples, *lowest);
        if (height) {
            standing.push_back({std::move(*samples), *lowest, *height, description_.roof});
        }
    }

    // Empty if nothing is left out or repaired.
    [[nodiscard]] std::string note(const io::FootprintCounts& in_file) const {
        std::vector<std::string> parts;
        const std::string over_max_corners =
            fmt::format("with over {} corners", io::max_polygon_corners);
        const auto report = [&](std::size_t count, const char* why) {
            if (count > 0) {
                parts.push_back(fmt::format("{} {}", count, why));
            }
        };
        report(left_out_.outside, "not wholly on the terrain");
        report(left_out_.in_voids, "over a void");
        report(in_file.no_height, "without a height");
        report(left_out_.no_surface, "without a height of the surface");
        report(in_file.odd_height + left_out_.in_file.odd_height,
               "with a height that is not over 0 and up to 1000 m");
        report(in_file.broken, "with an outline without area");
        report(in_file.too_large, over_max_corners.c_str());
        report(in_file.off_earth,
               "with coordinates that are nowhere on Earth (another coordinate system?)");
        report(in_file.no_polygons, "that are no polygons");
        std::string text;
        if (!parts.empty()) {
            text = fmt::format("left out: {}", fmt::join(parts, ", "));
        }
        if (in_file.repaired > 0) {
            text += fmt::format("{}{} that are no valid outlines are repaired",
                                text.empty() ? "" : "; ", in_file.repaired);
        }
        return text.empty()
                   ? text
                   : fmt::format("{}: of its footprints, {}", description_.file.string(), text);
    }

private:
    std::optional<double> height_above(const building::Footprint& samples, double lowest) {
        const auto roof = roof_on(*model_, on_earth(ground_, places_inside(samples)));
        const bool is_odd =
            roof && !(*roof - lowest > 0.0 && *roof - lowest <= io::max_building_height);
        left_out_.no_surface += static_cast<std::size_t>(!roof);
        left_out_.in_file.odd_height += static_cast<std::size_t>(is_odd);
        return roof && !is_odd ? std::optional(*roof - lowest) : std::nullopt;
    }

    const BuildingGround& ground_;
    const io::FootprintsDescription& description_;
    const io::TileSet* model_;
    LeftOut left_out_;
};

Result<std::optional<io::TileSet>> surface_model(const BuildingGround& ground,
                                                 const io::FootprintsDescription& description,
                                                 const std::stop_token& stop) {
    if (description.surface.empty()) {
        return std::optional<io::TileSet>();
    }
    if (!is_georeferenced(ground)) {
        return Error{fmt::format("{}: a surface model found, but {} is not georeferenced; heights "
                                 "of an attribute were expected",
                                 description.surface.string(), ground.surface.terrain().name)};
    }
    io::TileSetOptions options;
    options.stop = stop;
    auto model = io::TileSet::open(description.surface, options);
    return model ? Result<std::optional<io::TileSet>>(std::optional(std::move(*model)))
                 : model.error();
}

Result<std::string> stand(const BuildingGround& ground,
                          const io::FootprintsDescription& description,
                          std::vector<Standing>& standing, const std::stop_token& stop) {
    const auto model = surface_model(ground, description, stop);
    if (!model) {
        return model.error();
    }
    auto file =
        io::read_footprints(description.file, {description.height, is_georeferenced(ground)}, stop);
    if (!file) {
        return file.error();
    }
    FootprintPlacing placing(ground, description, *model ? &**model : nullptr);
    for (io::FileFootprint& footprint : file->footprints) {
        if (stop.stop_requested()) {
            return Error{fmt::format("{}: reading was stopped", description.file.string())};
        }
        placing.add(std::move(footprint), standing);
    }
    return placing.note(file->counts);
}

// A few colours of roofs, by the order in the files.
glm::vec3 roof_color(std::size_t index, bool is_hipped) {
    constexpr std::array tiles{glm::vec3(0.24F, 0.095F, 0.06F), glm::vec3(0.28F, 0.12F, 0.075F),
                               glm::vec3(0.20F, 0.10F, 0.075F)};
    constexpr std::array gravel{glm::vec3(0.27F, 0.26F, 0.24F), glm::vec3(0.21F, 0.20F, 0.19F),
                                glm::vec3(0.33F, 0.31F, 0.28F)};
    return (is_hipped ? tiles : gravel)[index % tiles.size()];
}

// Whether it has a hipped roof.
bool add_building(const terrain::Placement& placement, const Standing& standing, std::size_t index,
                  BuildingMeshes& meshes) {
    const auto on_ground = [&](glm::dvec2 sample) {
        return placement.world_from_sample({sample, standing.ground});
    };
    const glm::dvec3 middle = on_ground(building::middle_of(standing.samples.rings.front()));
    const glm::dmat3 axes = upright_axes(placement, middle);
    building::Footprint footprint = standing.samples;
    for (building::Ring& ring : footprint.rings) {
        for (glm::dvec2& corner : ring) {
            const glm::dvec3 away = on_ground(corner) - middle;
            corner = {glm::dot(away, axes[0]), glm::dot(away, axes[1])};
        }
    }
    glm::dmat4 world_from_building(axes);
    world_from_building[3] = glm::dvec4(middle, 1.0);
    building::PaintedFaces painted;
    painted.faces = building::building_of(footprint, standing.roof, -foot_depth, standing.height);
    const bool is_hipped = building::has_hips(footprint, standing.roof);
    painted.color = roof_color(index, is_hipped);
    meshes.add(painted, world_from_building);
    return is_hipped;
}

// The number of hipped roofs.
Result<std::size_t> add_meshes(const terrain::Placement& placement,
                               const std::vector<Standing>& standing, bool with_levels,
                               scene::Node& node) {
    BuildingMeshes meshes;
    std::size_t hipped = 0;
    for (std::size_t i = 0; i < standing.size(); ++i) {
        hipped += static_cast<std::size_t>(add_building(placement, standing[i], i, meshes));
    }
    const auto added = meshes.add_to(node, with_levels);
    return added ? Result<std::size_t>(hipped) : added.error();
}

// Empty if every roof is as it should be.
std::string roof_note(const std::vector<Standing>& standing, std::size_t hipped) {
    const auto wished = static_cast<std::size_t>(
        std::count_if(standing.begin(), standing.end(), [](const Standing& building) {
            return building.roof == building::RoofKind::hipped;
        }));
    return hipped == wished
               ? std::string()
               : fmt::format("buildings: {} of {} with roof=hipped have flat roofs: their outlines "
                             "are concave, have holes or are too narrow",
                             wished - hipped, wished);
}

} // namespace

Result<PlacedBuildings> add_buildings(scene::Scene& scene, const BuildingGround& ground,
                                      const std::vector<io::FootprintsDescription>& files,
                                      const std::stop_token& stop) {
    PlacedBuildings placed;
    std::vector<Standing> standing;
    for (const io::FootprintsDescription& file : files) {
        auto note = stand(ground, file, standing, stop);
        if (!note) {
            return note.error();
        }
        if (!note->empty()) {
            placed.notes.push_back(std::move(*note));
        }
    }
    if (standing.empty() && !files.empty()) {
        return Error{fmt::format("{}{}no building is left, some were expected",
                                 fmt::join(placed.notes, "; "), placed.notes.empty() ? "" : "; ")};
    }
    if (standing.empty()) {
        return placed;
    }
    placed.node = &scene.root().add("buildings");
    placed.has_levels = ground.with_levels;
    const auto hipped =
        add_meshes(ground.surface.placement(), standing, placed.has_levels, *placed.node);
    if (!hipped) {
        return hipped.error();
    }
    if (auto note = roof_note(standing, *hipped); !note.empty()) {
        placed.notes.push_back(std::move(note));
    }
    placed.buildings = std::make_shared<const std::vector<Standing>>(std::move(standing));
    return placed;
}

Result<std::shared_ptr<const scene::TerrainSurface>>
city_surface(Grid<float> heights, glm::dvec2 spacing, const scene::TerrainOptions& options) {
    if (heights.empty()) {
        return std::shared_ptr<const scene::TerrainSurface>();
    }
    terrain::Terrain city;
    city.name = "city";
    city.heightfield.heights = std::move(heights);
    city.heightfield.spacing = spacing;
    city.heightfield.range = terrain::height_range(city.heightfield.heights, {});
    auto surface = scene::TerrainSurface::create(
        std::make_shared<const terrain::Terrain>(std::move(city)), options);
    if (!surface) {
        return surface.error();
    }
    return std::make_shared<const scene::TerrainSurface>(std::move(*surface));
}

Result<scene::Node*> add_city(scene::Scene& scene,
                              const std::vector<building::PaintedFaces>& buildings,
                              bool with_levels) {
    BuildingMeshes meshes;
    for (const building::PaintedFaces& building : buildings) {
        meshes.add(building, glm::dmat4(1.0));
    }
    scene::Node& node = scene.root().add("city");
    if (auto added = meshes.add_to(node, with_levels); !added) {
        return added.error();
    }
    return &node;
}

void stand_on(const scene::TerrainSurface& surface, const PlacedBuildings& buildings) {
    if (buildings.node == nullptr) {
        return;
    }
    while (!buildings.node->children().empty()) {
        buildings.node->remove(*buildings.node->children().front());
    }
    // Pictures that were made once can be made again.
    const auto added = add_meshes(surface.placement(), *buildings.buildings, buildings.has_levels,
                                  *buildings.node);
    reljef::check(added.has_value(), "buildings that stood stand again");
}

} // namespace reljef::session

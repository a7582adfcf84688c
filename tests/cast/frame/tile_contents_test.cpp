#include "engine/cast/frame/tile_contents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/cast/frame/driver.h"
#include "engine/cast/frame/tile_pieces.h"
#include "engine/scene/streaming/tile_stream.h"
#include "tests/gl/gl_fixture.h"
#include "tests/support/release_only.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"
#include "tests/terrain/made_tiles.h"

namespace reljef::cast {
namespace {

constexpr int raster_side = 300; // samples; the last tiles have fewer cells, and shorter ones
constexpr int overview_reduction = 4;
constexpr double sample_metres = 10.0;
constexpr glm::ivec2 view_size{64, 48};

// Where a terrain lies, and how far rays over it may be off.
struct Ground {
    std::optional<double> latitude; // absent: on a plane
    // Floats of a ray are off by 2^-20 of 3 km, and slopes are up to 4.
    double height_tolerance = 0.02; // metres
    double near = 1e-4;             // samples
    double place_tolerance = 0.01;  // samples
};

double noise(glm::ivec2 place) {
    const auto bits =
        static_cast<unsigned>(place.x) * 2654435761U ^ static_cast<unsigned>(place.y) * 2246822519U;
    return static_cast<double>((bits ^ (bits >> 13U)) * 3266489917U) / 4294967295.0 - 0.5;
}

double base_height(glm::dvec2 sample) {
    return 60.0 * std::sin(0.05 * sample.x) * std::cos(0.037 * sample.y) +
           20.0 * std::sin(0.31 * sample.x + 0.2 * sample.y);
}

// Levels differ by metres, at borders too.
double height_of(terrain::TreeTile tile, glm::ivec2 sample) {
    return base_height(glm::dvec2(sample)) + 12.0 * noise(sample) +
           7.0 * tile.level * noise(sample + 1000 * tile.level);
}

scene::TileContent read_tile(terrain::TreeTile tile, const std::stop_token& /*stop*/) {
    const terrain::TileTree tree(raster_side, raster_side);
    scene::TileContent content;
    content.heights = test::tile_heights(tree.cells(tile), [&](glm::ivec2 vertex) {
        return height_of(tile, tree.sample(tile, vertex));
    });
    return content;
}

std::shared_ptr<const scene::TerrainSurface> made_overview(const Ground& ground) {
    Grid<float> heights = test::overview_heights(raster_side, overview_reduction, base_height);
    const double metres = sample_metres * overview_reduction;
    auto heightfield =
        ground.latitude
            ? test::geographic_heightfield(std::move(heights), *ground.latitude, 7.0,
                                           metres / geo::metres_per_degree(*ground.latitude).y)
            : test::plane_heightfield(std::move(heights));
    heightfield.spacing = glm::dvec2(metres);
    const auto kind =
        ground.latitude ? terrain::PlacementKind::ellipsoid : terrain::PlacementKind::plane;
    return std::make_shared<const scene::TerrainSurface>(test::must(
        scene::TerrainSurface::create(std::make_shared<const terrain::Terrain>(
                                          terrain::Terrain{"made", std::move(heightfield), {}, {}}),
                                      {.placement = kind})));
}

// A random selection of tiles, and a camera.
class RandomCut {
public:
    explicit RandomCut(test::Chance& chance, const Ground& ground = {})
        : ground_(ground), overview_(made_overview(ground)) {
        const terrain::TileTree tree(raster_side, raster_side);
        node_.surface = overview_;
        node_.stream = std::make_shared<scene::TileStream>(
            scene::TileBuilder(overview_, tree, overview_reduction), read_tile);
        scene::Polygons bounded;
        bounded.error = 1.0;
        node_.material.technique = scene::Technique{bounded};
        list_.size = view_size;
        list_.terrains = {{.terrain = &node_}};
        add(tree.root(), chance);
        std::shuffle(list_.tiles.begin(), list_.tiles.end(),
                     std::mt19937(static_cast<unsigned>(chance.whole(0, 999))));
    }

    view::DrawList& list() { return list_; }
    [[nodiscard]] const scene::TileBuilder& builder() const { return node_.stream->maker(); }
    [[nodiscard]] glm::dvec3 world(glm::dvec3 sample) const {
        return overview_->placement().world_from_sample(
            glm::dvec3(builder().on_overview(glm::dvec2(sample)), sample.z));
    }

    // Of a pixel's middle.
    [[nodiscard]] Ray ray_of(glm::ivec2 pixel) const {
        return scene::view_ray(list_.camera, view_size, glm::dvec2(pixel) + 0.5);
    }

    // A sample of the terrain and a height on a ray; far beside the terrain there may be none.
    [[nodiscard]] glm::dvec3 on_ray(const Ray& ray, double t) const {
        const glm::dvec3 place = overview_->placement()
                                     .sample_from_world(ray.origin + t * ray.direction)
                                     .value_or(glm::dvec3(-raster_side));
        return {builder().from_overview(glm::dvec2(place)), place.z};
    }

    // The heights of all tiles at a place, which may be on a border; empty beside the terrain.
    [[nodiscard]] std::vector<double> heights_at(glm::dvec2 sample) const {
        std::vector<double> heights;
        constexpr double last = raster_side - 1.0;
        if (sample.x < 0.0 || sample.y < 0.0 || sample.x > last || sample.y > last) {
            return heights;
        }
        const double near = ground_.near;
        const auto& tile = tile_at(glm::clamp(sample - near, 0.0, last));
        if (&tile == &tile_at(glm::clamp(sample + near, 0.0, last))) {
            return {height_in(tile, sample)}; // not near a border
        }
        for (const glm::dvec2 beside : {glm::dvec2(-near, -near), glm::dvec2(near, -near),
                                        glm::dvec2(-near, near), glm::dvec2(near, near)}) {
            heights.push_back(height_in(tile_at(glm::clamp(sample + beside, 0.0, last)), sample));
        }
        return heights;
    }

    [[nodiscard]] HitBuffer cast(unsigned threads = 0) {
        Driver driver = test::must(Driver::create({.size = view_size, .threads = threads}));
        view::FrameView frame;
        frame.list = list_;
        return test::must(driver.draw_hits(frame)).hits;
    }
    [[nodiscard]] const Ground& ground() const { return ground_; }
    // Of all samples.
    [[nodiscard]] double highest() const { return highest_; }

private:
    [[nodiscard]] double height_in(const scene::TerrainTile& tile, glm::dvec2 sample) const {
        return terrain::bilinear_height(tile.heightfield.heights.view(),
                                        builder().lattice(tile.id).from_terrain(sample));
    }

    void add(terrain::TreeTile id, test::Chance& chance) {
        const terrain::TileTree& tree = builder().tree();
        if (id.level > 0 && !chance.one_in(3)) {
            for (const terrain::TreeTile child : tree.children(id)) {
                add(child, chance);
            }
            return;
        }
        view::TileDraw draw;
        draw.terrain = &node_;
        draw.tile = std::make_shared<const scene::TerrainTile>(
            builder().make(id, read_tile(id, {}).heights));
        tiles_[id] = draw.tile;
        const auto heights = draw.tile->heightfield.heights.samples();
        highest_ = std::max<double>(highest_, *std::max_element(heights.begin(), heights.end()));
        list_.tiles.push_back(std::move(draw));
    }

    [[nodiscard]] const scene::TerrainTile& tile_at(glm::dvec2 sample) const {
        for (int level = 0;; ++level) {
            const auto found = tiles_.find(builder().tile_at(level, sample));
            if (found != tiles_.end()) {
                return *found->second;
            }
        }
    }

    Ground ground_;
    std::shared_ptr<const scene::TerrainSurface> overview_;
    scene::TerrainNode node_;
    view::DrawList list_;
    double highest_ = -std::numeric_limits<double>::infinity();
    std::map<terrain::TreeTile, std::shared_ptr<const scene::TerrainTile>> tiles_;
};

// A cut on the ellipsoid is seen with small pixels: rays may be off by a hundredth of them.
scene::Camera camera_over(const RandomCut& cut, test::Chance& chance) {
    const auto place = [&](double height) {
        return cut.world({chance.between(20.0, 280.0), chance.between(20.0, 280.0), height});
    };
    scene::Camera camera;
    camera.eye = place(chance.between(130.0, 900.0));
    camera.target = place(chance.between(-300.0, 60.0));
    camera.near = 0.1;
    if (cut.ground().latitude) {
        camera.vertical_fov = chance.between(1.0, 4.0);
    } else if (chance.one_in(4)) {
        camera.projection = scene::ProjectionKind::orthographic;
        camera.view_height = chance.between(300.0, 3000.0);
        Box box;
        box.add(cut.world({0.0, 0.0, -200.0}));
        box.add(cut.world({raster_side, raster_side, 200.0}));
        camera = scene::with_fitted_depth(camera, box);
    }
    return camera;
}

struct Faults {
    int passes = 0; // rays that are below the surface before they hit
    int off = 0;    // hits that are neither on a tile nor on a wall
    int hits = 0;
    int on_walls = 0;
};

// Whether a ray of a map comes in below the surface, from beside the terrain.
bool comes_in_below(const RandomCut& cut, glm::ivec2 pixel) {
    constexpr double step = 5.0; // metres
    const Ray ray = cut.ray_of(pixel);
    for (double t = -6000.0; t < 6000.0; t += step) {
        const glm::dvec3 place = cut.on_ray(ray, t);
        const std::vector<double> heights = cut.heights_at(glm::dvec2(place));
        if (!heights.empty()) {
            return place.z < *std::max_element(heights.begin(), heights.end()) + 40.0;
        }
    }
    return false;
}

// Whether a ray is below all tiles somewhere before t.
bool passes_below(const RandomCut& cut, glm::ivec2 pixel, double begin, double end) {
    constexpr int steps = 120;
    const Ray ray = cut.ray_of(pixel);
    for (int i = 0; i < steps; ++i) {
        const glm::dvec3 place = cut.on_ray(ray, begin + (end - begin) * i / steps);
        if (place.z > cut.highest()) {
            continue;
        }
        const std::vector<double> heights = cut.heights_at(glm::dvec2(place));
        if (!heights.empty() && place.z < *std::min_element(heights.begin(), heights.end()) -
                                              cut.ground().height_tolerance) {
            return true;
        }
    }
    return false;
}

void check_hit(const RandomCut& cut, glm::ivec2 pixel, const Hit& hit, Faults& faults) {
    const std::vector<double> heights = cut.heights_at(hit.place());
    ++faults.hits;
    const glm::dvec3 on_ray = cut.on_ray(cut.ray_of(pixel), hit.depth);
    const double height_tolerance = cut.ground().height_tolerance;
    if (heights.empty() || std::abs(on_ray.z - hit.height) > 4.0 * height_tolerance ||
        glm::distance(glm::dvec2(on_ray), hit.place()) > cut.ground().place_tolerance) {
        ++faults.off;
        return;
    }
    const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
    const bool is_on =
        hit.height > *low - height_tolerance && hit.height < *high + height_tolerance;
    faults.off += is_on ? 0 : 1;
    faults.on_walls += *high - *low > 1.0 && hit.height < *high - 0.2 ? 1 : 0;
}

// Of the rays of a picture.
void add_faults(RandomCut& cut, Faults& faults) {
    const bool is_map = cut.list().camera.projection == scene::ProjectionKind::orthographic;
    const double begin = is_map ? cut.list().camera.orthographic_near : 0.1;
    const HitBuffer hits = cut.cast();
    for (int row = 0; row < view_size.y; ++row) {
        for (int col = 0; col < view_size.x; ++col) {
            const Hit& hit = hits(col, row);
            if (is_map && comes_in_below(cut, {col, row})) {
                continue;
            }
            constexpr double beyond = 6000.0; // metres
            const double end = hit.is_sky() ? beyond : hit.depth * (1.0 - 1e-4);
            faults.passes += passes_below(cut, {col, row}, begin, end) ? 1 : 0;
            if (!hit.is_sky()) {
                check_hit(cut, {col, row}, hit, faults);
            }
        }
    }
}

// Looks at random cuts over the grounds in turn, three times at each.
template <class Look>
void expect_no_faults(unsigned seed, const std::vector<Ground>& grounds, const Look& look) {
    test::Chance chance(seed);
    Faults faults;
    const int rounds = test::rounds(10, 1);
    for (int round = 0; round < rounds; ++round) {
        RandomCut cut(chance, grounds[static_cast<std::size_t>(round) % grounds.size()]);
        for (int view = 0; view < 3; ++view) {
            cut.list().camera = camera_over(cut, chance);
            look(cut, view, chance);
            add_faults(cut, faults);
        }
    }
    EXPECT_EQ(faults.passes, 0);
    EXPECT_EQ(faults.off, 0);
    EXPECT_GT(faults.hits, 4'000 * rounds);
    EXPECT_GE(faults.on_walls, 2 * (rounds - 1)); // a single cut may show none
}

TEST(TileContents, NoRayPassesBetweenTilesOfAnyLevels) {
    expect_no_faults(29, {{}}, [](RandomCut&, int, test::Chance&) {});
}

// From places above lines between tiles, too, along which bent rays pass to both sides.
TEST(TileContents, NoRayPassesBetweenTilesOnTheEllipsoid) {
    std::vector<Ground> grounds;
    for (const double latitude : {45.0, 0.1, 60.0, 85.0, -45.0}) {
        grounds.push_back(
            {.latitude = latitude, .height_tolerance = 0.3, .near = 0.05, .place_tolerance = 0.1});
    }
    expect_no_faults(41, grounds, [](RandomCut& cut, int view, test::Chance& chance) {
        if (view == 2) {
            cut.list().camera.eye = cut.world({128.0, chance.between(20.0, 60.0), 250.0});
            cut.list().camera.target = cut.world({128.0, 260.0, -100.0});
        }
    });
}

TEST(TileContents, HitsHaveTheSameBitsOnAnyThreads) {
    test::Chance chance(31);
    RandomCut cut(chance);
    cut.list().camera = camera_over(cut, chance);
    const HitBuffer one = cut.cast(1);
    const HitBuffer three = cut.cast(3);
    EXPECT_EQ(std::memcmp(one.samples().data(), three.samples().data(),
                          one.samples().size() * sizeof(Hit)),
              0);
}

TEST(TilePieces, CoverATileWithCellsOfOneSize) {
    const terrain::TileLattice lattice{{64.0, 0.0}, {99.0, 50.0}, 4.0, {9, 13}};
    const auto pieces = pieces_of(lattice, {99.0, 80.0}, {0.0, 0.0});
    ASSERT_EQ(pieces.size(), 4U);
    int cells = 0;
    for (const TilePiece& piece : pieces) {
        cells += piece.cells.x * piece.cells.y;
        const glm::dvec2 end = piece.first + piece.step * glm::dvec2(piece.cells);
        EXPECT_EQ((piece.walls & east_wall) != 0, end.x < 99.0);
        EXPECT_EQ((piece.walls & south_wall) != 0, end.y < 80.0);
        EXPECT_EQ((piece.walls & north_wall) != 0, piece.first.y > 0.0);
        EXPECT_NE(piece.walls & west_wall, 0U);
    }
    EXPECT_EQ(cells, 9 * 13);
    EXPECT_EQ(pieces.back().first, glm::dvec2(96.0, 48.0));
    EXPECT_EQ(pieces.back().step, glm::dvec2(3.0, 2.0));
    EXPECT_EQ(pieces_of(lattice, {99.0, 80.0}, {200.0, 200.0}).front().first,
              glm::dvec2(96.0, 48.0));
}

// The rows that close a globe are nearer to the others: pieces of their own.
TEST(TilePieces, AtThePolesHaveCellsOfOneSize) {
    constexpr geo::GlobalWrap wrap{.around = true, .east = true, .north = 0.5, .south = 0.25};
    const terrain::TileLattice lattice{
        {0.0, 0.0}, {64.0, 34.0}, 4.0, {16, 9}, geo::WrappedRows(wrap, 33)};
    const auto pieces = pieces_of(lattice, {64.0, 34.0}, {0.0, 0.0});
    ASSERT_EQ(pieces.size(), 3U);
    EXPECT_EQ(pieces[0].first, glm::dvec2(0.0, 0.5));
    EXPECT_EQ(pieces[0].step, glm::dvec2(4.0, 3.5));
    EXPECT_EQ(pieces[1].first, glm::dvec2(0.0, 4.0));
    EXPECT_EQ(pieces[1].step, glm::dvec2(4.0, 4.0));
    EXPECT_EQ(pieces[2].first, glm::dvec2(0.0, 32.0));
    EXPECT_EQ(pieces[2].step, glm::dvec2(4.0, 1.25));
    EXPECT_EQ(pieces[0].walls, south_wall);
    EXPECT_EQ(pieces[1].walls, north_wall | south_wall);
    EXPECT_EQ(pieces[2].walls, north_wall);
    int cells = 0;
    for (const TilePiece& piece : pieces) {
        cells += piece.cells.y;
    }
    EXPECT_EQ(cells, lattice.cells.y);
}

// Along rays from any place, each tile lies before the next.
TEST(TilePieces, AreInTheOrderOfTheRays) {
    test::Chance chance(37);
    for (int round = 0; round < 20; ++round) {
        RandomCut cut(chance);
        const terrain::TileTree& tree = cut.builder().tree();
        std::vector<terrain::TreeTile> ids;
        for (const view::TileDraw& draw : cut.list().tiles) {
            ids.push_back(draw.tile->id);
        }
        const glm::dvec2 eye(chance.between(-100.0, 400.0), chance.between(-100.0, 400.0));
        std::map<terrain::TreeTile, std::size_t> rank;
        for (const std::size_t index : front_to_back(tree, ids, eye)) {
            rank.emplace(ids[index], rank.size());
        }
        ASSERT_EQ(rank.size(), ids.size());
        for (int ray = 0; ray < 50; ++ray) {
            const double angle = chance.between(0.0, 6.283);
            const glm::dvec2 way(std::cos(angle), std::sin(angle));
            std::size_t last = 0;
            for (double along = 0.05; along < 600.0; along += 0.37) {
                const glm::dvec2 place = eye + along * way;
                if (std::min(place.x, place.y) <= 0.0 ||
                    std::max(place.x, place.y) >= raster_side - 1.0) {
                    continue;
                }
                int level = 0;
                while (!rank.contains(cut.builder().tile_at(level, place))) {
                    ++level;
                }
                const std::size_t here = rank.at(cut.builder().tile_at(level, place));
                EXPECT_GE(here, last);
                last = here;
            }
        }
    }
}

} // namespace
} // namespace reljef::cast

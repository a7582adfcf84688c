#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "bench/stress/made_surfaces.h"
#include "bench/stress/stress_stage.h"
#include "engine/core/check.h"
#include "engine/geo/place.h"
#include "engine/view/grid_mesh.h"

namespace reljef::bench {
namespace {

struct Base {
    std::string name;
    glm::dmat4 world_from_local{1.0};
    bool is_whole_tiles = false; ///< a shift by whole tiles: no rounding, so the same bits
};

constexpr double tile_side = 64.0;                 // metres, of a terrain with a sample each metre
constexpr double max_vertex_error = 0.01;          // pixels
constexpr glm::ivec2 vertex_error_size{1024, 768}; // to which that limit belongs
constexpr glm::ivec2 moved_size{320, 240};         // enough pixels for a share of 0.01 %
// Rasterizers round vertices to 1/256 pixel (GL_SUBPIXEL_BITS is 8), which parts two neighbours by
// up to 1/256 pixel in x and y.
constexpr double max_rounding_shift = 1.42 / 256.0; // pixels

glm::dmat4 geocentric_from_local(double latitude, double longitude) {
    const double turn = glm::radians(longitude);
    const double tilt = glm::radians(latitude);
    const glm::dvec3 up(std::cos(tilt) * std::cos(turn), std::cos(tilt) * std::sin(turn),
                        std::sin(tilt));
    const glm::dvec3 east(-std::sin(turn), std::cos(turn), 0.0);
    const glm::dvec3 origin = geo::geocentric_from_geodetic({latitude, longitude, 0.0});
    return {glm::dvec4(east, 0.0), glm::dvec4(glm::cross(up, east), 0.0), glm::dvec4(up, 0.0),
            glm::dvec4(origin, 1.0)};
}

glm::dmat4 shift(double x, double y) {
    return glm::translate(glm::dmat4(1.0), glm::dvec3(x, y, 0.0));
}

std::vector<Base> moved_bases() {
    return {{"origin", glm::dmat4(1.0), true},
            {"one tile", shift(tile_side, -tile_side), true},
            {"100 km", shift(1563.0 * tile_side, 0.0), true},
            {"UTM by whole tiles", shift(7813.0 * tile_side, 78125.0 * tile_side), true},
            {"UTM", shift(432'711.371, 5'069'133.816)},
            {"geocentric, equator", geocentric_from_local(0.0, 0.0)},
            {"geocentric, 45 degrees", geocentric_from_local(45.0, 7.0)},
            {"geocentric, north pole", geocentric_from_local(90.0, 0.0)},
            {"geocentric, south pole", geocentric_from_local(-90.0, 33.0)},
            {"geocentric, antimeridian", geocentric_from_local(-17.0, 180.0)}};
}

// Coordinates are multiples of 2^-10 m, which every base of whole tiles keeps exactly.
double to_grid(double metres) {
    return std::round(metres * 1024.0) / 1024.0;
}

// An eye `above` metres over the ground that looks half down.
scene::Camera standing_camera(const StressStage& stage, glm::dvec2 at, double above,
                              double heading) {
    const double ground = stage.surface().height_at(at.x, at.y).value_or(0.0);
    scene::Camera camera;
    camera.eye = {to_grid(at.x), to_grid(at.y), to_grid(ground + above)};
    camera.target =
        camera.eye + glm::dvec3(to_grid(std::sin(heading)), to_grid(std::cos(heading)), -1.0);
    return camera;
}

// Where the places that pixels show are drawn, minus the pixels' centres; NaN for sky.
Grid<glm::dvec2> offsets_of(const StressStage& stage, const HitBuffer& hits) {
    const truth::SurfaceView view = stage.surface_view();
    const glm::ivec2 size(hits.cols(), hits.rows());
    Grid<glm::dvec2> offsets(size.x, size.y, glm::dvec2(std::nan("")));
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const Hit& hit = hits(x, y);
            if (hit.is_sky()) {
                continue;
            }
            const glm::dvec3 local =
                view.placement.world_from_sample({hit.col, hit.row, hit.height});
            const auto drawn = scene::project(
                view.camera, size, glm::dvec3(view.world_from_local * glm::dvec4(local, 1.0)));
            offsets(x, y) = drawn.pixel - (glm::dvec2(x, y) + 0.5);
        }
    }
    return offsets;
}

// The larger one; not a number if either is none.
double larger(double a, double b) {
    return std::isnan(a) || a >= b ? a : b;
}

double largest(const Grid<glm::dvec2>& offsets) {
    double worst = 0.0;
    for (const glm::dvec2 offset : offsets.samples()) {
        worst = larger(worst, glm::length(offset));
    }
    return worst;
}

double largest_step(const Grid<glm::dvec2>& offsets) {
    double worst = 0.0;
    for (int y = 1; y < offsets.rows(); ++y) {
        for (int x = 1; x < offsets.cols(); ++x) {
            worst = larger(worst, glm::distance(offsets(x, y), offsets(x - 1, y)));
            worst = larger(worst, glm::distance(offsets(x, y), offsets(x, y - 1)));
        }
    }
    return worst;
}

double largest_change(const Grid<glm::dvec2>& a, const Grid<glm::dvec2>& b) {
    double worst = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        worst = larger(worst, glm::distance(a.samples()[i], b.samples()[i]));
    }
    return worst;
}

// What terrain.vert makes of the vertices around the eye, in the same floats, against doubles:
// pixels at a distance of a metre or their own if that is larger.
Grid<glm::dvec2> vertex_offsets(const StressStage& stage) {
    constexpr int side = 101; // vertices
    const truth::SurfaceView view = stage.surface_view();
    const glm::dvec3 eye(glm::inverse(view.world_from_local) * glm::dvec4(view.camera.eye, 1.0));
    const SplitPoint split = split_into_floats(eye);
    const double pixels =
        0.5 * vertex_error_size.y / std::tan(glm::radians(0.5 * view.camera.vertical_fov));
    Grid<glm::dvec2> offsets(side, side);
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            const glm::ivec2 sample(50 + col, 50 + row);
            const double height = view.heights(sample.x, sample.y);
            const glm::dvec3 place = view.placement.world_from_sample({sample, height});
            const view::GridVertex vertex = view::grid_vertex(place, height, glm::dvec2(sample));
            const glm::vec3 drawn = (vertex.position - split.rounded) + (vertex.rest - split.rest);
            const glm::dvec3 off = glm::dvec3(drawn) - (place - eye);
            const double scale = pixels / std::max(glm::length(place - eye), 1.0);
            offsets(col, row) = scale * glm::dvec2(glm::length(glm::dvec2(off)), off.z);
        }
    }
    return offsets;
}

double percent_of_changed(const Image& a, const Image& b, int tolerance) {
    std::size_t changed = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Rgba8 x = a.samples()[i];
        const Rgba8 y = b.samples()[i];
        const int difference =
            std::max({std::abs(x.r - y.r), std::abs(x.g - y.g), std::abs(x.b - y.b)});
        changed += difference > tolerance ? 1 : 0;
    }
    return 100.0 * static_cast<double>(changed) / static_cast<double>(a.size());
}

// The techniques that draw the surface itself, so that a place is drawn where it is.
std::vector<scene::Technique> exact_techniques() {
    return {scene::Technique{scene::Polygons{}}, scene::Technique{scene::Polygons{.error = 1.0}},
            scene::make_technique(scene::TechniqueId::exact)};
}

Result<void> add_vertex_errors(StressRun& run, const std::vector<Base>& bases) {
    auto stage = StressStage::create(made_hills(glm::ivec2(201), 0.1, 0.3));
    if (!stage) {
        return stage.error();
    }
    for (const scene::Technique& technique : exact_techniques()) {
        check(stage->set_technique(technique), "a technique that draws no terrain");
        Worst worst;
        for (const Base& base : bases) {
            if (run.stopped()) {
                return {};
            }
            stage->place(base.world_from_local);
            stage->look(standing_camera(*stage, {1.3, -2.1}, 1.0, 0.7));
            const auto hits = stage->hits(run.renderer());
            if (!hits) {
                return hits.error();
            }
            worst.add(largest(offsets_of(*stage, *hits)), base.name);
        }
        run.add({.stress = "moved scene",
                 .terrain = "hills, eye at 1 m",
                 .technique = to_string(technique),
                 .figure = "error of a drawn place, px of 768",
                 .value = worst.value(),
                 .limit = max_vertex_error,
                 .at = worst.at()});
    }
    return {};
}

struct MovedPictures {
    Worst same_bits; // % of pixels
    Worst similar;   // % of pixels
};

Result<MovedPictures> compare_moved(StressRun& run, StressStage& stage,
                                    const std::vector<Base>& bases) {
    MovedPictures moved;
    Image first;
    for (const Base& base : bases) {
        stage.place(base.world_from_local);
        stage.look(standing_camera(stage, {10.3, -50.7}, 20.0, 0.3));
        auto picture = stage.picture(run.renderer());
        if (!picture) {
            return picture.error();
        }
        first = first.empty() ? *picture : first;
        (base.is_whole_tiles ? moved.same_bits : moved.similar)
            .add(percent_of_changed(first, *picture, base.is_whole_tiles ? 0 : 1), base.name);
    }
    return moved;
}

Result<void> add_moved_pictures(StressRun& run, const std::vector<Base>& bases) {
    auto stage = StressStage::create(made_hills(glm::ivec2(129), 1.0, 9.0));
    if (!stage) {
        return stage.error();
    }
    for (const scene::Technique& technique : stressed_techniques(run.options())) {
        if (run.stopped() || !stage->set_technique(technique)) {
            continue;
        }
        const auto moved = compare_moved(run, *stage, bases);
        if (!moved) {
            return moved.error();
        }
        StressRow row{.stress = "moved scene",
                      .terrain = "hills",
                      .technique = to_string(technique),
                      .figure = "% of pixels changed by whole tiles",
                      .value = moved->same_bits.value(),
                      .limit = 0.0,
                      .at = moved->same_bits.at()};
        run.add(row);
        row.figure = "% of pixels changed by more than 1/255";
        row.value = moved->similar.value();
        row.limit = 0.01;
        row.at = moved->similar.at();
        run.add(row);
    }
    return {};
}

} // namespace

Result<void> stress_moved_scenes(StressRun& run) {
    const std::vector<Base> bases = moved_bases();
    if (auto resized = run.renderer().resize(vertex_error_size); !resized) {
        return resized;
    }
    auto done = add_vertex_errors(run, bases);
    if (done) {
        done = run.renderer().resize(moved_size);
    }
    if (done) {
        done = add_moved_pictures(run, bases);
    }
    const auto restored = run.renderer().resize(run.size());
    return done ? restored : done;
}

Result<void> stress_creeping_camera(StressRun& run) {
    auto stage = StressStage::create(made_hills(glm::ivec2(201), 0.1, 0.3));
    if (!stage) {
        return stage.error();
    }
    if (auto resized = run.renderer().resize(vertex_error_size); !resized) {
        return resized;
    }
    stage->place(geocentric_from_local(45.0, 7.0));
    Worst shift;
    Worst drawn;
    Grid<glm::dvec2> last;
    for (int i = 0; i < run.cases(6, 60) && !run.stopped(); ++i) {
        scene::Camera camera = standing_camera(*stage, {1.0, 2.0}, 1.0, 0.7);
        const glm::dvec3 step(0.001 * i, 0.0, 0.0);
        camera.eye += step;
        camera.target += step;
        stage->look(camera);
        const std::string frame = fmt::format("frame {}", i);
        const Grid<glm::dvec2> vertices = vertex_offsets(*stage);
        shift.add(
            larger(largest_step(vertices), last.empty() ? 0.0 : largest_change(vertices, last)),
            frame);
        last = vertices;
        const auto hits = stage->hits(run.renderer());
        if (!hits) {
            return hits.error();
        }
        drawn.add(largest_step(offsets_of(*stage, *hits)), frame);
    }
    StressRow row{.stress = "creeping camera",
                  .terrain = "hills, eye at 1 m",
                  .technique = to_string(scene::Technique{scene::Polygons{}}),
                  .figure = "shift of a vertex against a neighbour or the last frame, px of 768",
                  .value = shift.value(),
                  .limit = max_vertex_error,
                  .at = shift.at()};
    run.add(row);
    row.figure = "shift of a drawn place, rasterizer's rounding included, px of 768";
    row.value = drawn.value();
    row.limit = max_vertex_error + max_rounding_shift;
    row.at = drawn.at();
    run.add(row);
    return run.renderer().resize(run.size());
}

Result<void> stress_depth_order(StressRun& run) {
    constexpr int pairs = 13;
    constexpr int middle = 6;      // of these
    constexpr double apart = 2e-7; // of the depth
    constexpr double width = 0.05; // of a pair, metres at a depth of a metre
    scene::Scene scene;
    scene.add_camera({.eye = {0.0, 0.0, 0.0}, .target = {0.0, 0.0, -1.0}, .up = {0.0, 1.0, 0.0}});
    std::vector<glm::dvec3> middles;
    for (int i = 0; i < pairs; ++i) {
        const double depth = std::pow(10.0, 6.0 * i / (pairs - 1));
        const double aside = (i - middle) * 2.0 * width * depth;
        middles.emplace_back(aside, 0.0, -depth);
        for (const bool is_nearer : {i % 2 == 0, i % 2 != 0}) { // each is drawn first in half
            scene::Material material;
            material.color = is_nearer ? glm::vec3(0.0F, 1.0F, 0.0F) : glm::vec3(1.0F, 0.0F, 0.0F);
            const auto side = static_cast<float>(1.5 * width * depth);
            scene.add_mesh(scene::plane_mesh(glm::vec2(side)), material)
                .set_position({aside, 0.0, -depth * (is_nearer ? 1.0 : 1.0 + apart)});
        }
    }
    if (const auto drawn = run.renderer().draw(scene); !drawn) {
        return drawn.error();
    }
    const Image picture = run.renderer().read_color();
    const auto pixels = picture.samples();
    const auto farther =
        std::count_if(pixels.begin(), pixels.end(), [](Rgba8 color) { return color.r > color.g; });
    double unseen = 0.0; // pairs whose nearer plane does not show in their middle
    for (const glm::dvec3 place : middles) {
        const auto at = glm::ivec2(scene::project(scene.camera(), run.size(), place).pixel);
        const Rgba8 color = picture(at.x, at.y);
        unseen += color.g > color.r && color.g > color.b ? 0.0 : 1.0;
    }
    run.add({.stress = "depth order",
             .figure = "pixels of the farther plane, pairs of planes not seen",
             .value = static_cast<double>(farther) + unseen,
             .limit = 0.0,
             .at = "planes 2e-7 of their depth apart, 1 m to 1000 km"});
    run.renderer().forget_scene();
    return {};
}

} // namespace reljef::bench

#include "engine/render/driver.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <numeric>

#include "engine/core/stopwatch.h"
#include "engine/gl/draw.h"
#include "engine/gl/limits.h"
#include "engine/gl/read_pixels.h"
#include "engine/render/passes/draw_state.h"
#include "engine/render/passes/frame_context.h"
#include "engine/render/shaders/frame_block.h"
#include "engine/render/shaders/technique_support.h"

namespace reljef::render {
namespace {

// 512 MB of colour and depth at 4 samples. Users usually reduce larger pictures.
constexpr double max_sampled_pixels = 4096.0 * 4096.0;

bool has_wireframe(const view::DrawList& list) {
    return std::ranges::any_of(list.terrains,
                               [](const auto& draw) { return draw.terrain->material.wireframe; }) ||
           std::ranges::any_of(list.meshes,
                               [](const auto& draw) { return draw.mesh->material.wireframe; });
}

int samples_of(const view::DrawList& list, glm::ivec2 size, int samples) {
    if (has_wireframe(list)) { // Mesa 22 draws lines of several samples black
        return 1;
    }
    // Walls below rays are as sharp as these: they do not make every ray four.
    const bool has_triangles = !list.tiles.empty() || !list.meshes.empty();
    const double pixels = static_cast<double>(size.x) * size.y;
    const bool has_several = has_triangles && pixels <= max_sampled_pixels;
    return samples != view::automatic_samples ? samples
           : has_several                      ? view::samples_of_triangles
                                              : 1;
}

// Later passes draw the same content again: only their work counts.
void add_work(view::FrameStats& stats, const view::FrameStats& pass) {
    stats.draws += pass.draws;
    stats.state_changes += pass.state_changes;
    stats.uploads += pass.uploads;
    stats.upload_bytes += pass.upload_bytes;
}

} // namespace

Driver::Driver(const DriverOptions& options, gl::Framebuffer target)
    : options_(options), limits_(gl::query_limits()), color_target_(std::move(target)),
      no_vertices_(gl::VertexArray::create()), shaders_(options.shader_dir) {}

Result<Driver> Driver::create(const DriverOptions& options) {
    if (auto possible = view::check_samples(options.samples); !possible) {
        return possible.error();
    }
    auto target = gl::Framebuffer::create({.size = options.size});
    if (!target) {
        return target.error();
    }
    auto block = gl::Buffer::create_writable(sizeof(FrameBlock));
    if (!block) {
        return block.error();
    }
    Driver driver(options, std::move(*target));
    driver.frame_block_ = std::move(*block);
    return driver;
}

Result<void> Driver::resize(glm::ivec2 size) {
    auto target = gl::Framebuffer::create({.size = size});
    if (!target) {
        return target.error();
    }
    color_target_ = std::move(*target);
    hit_target_ = {};
    work_target_ = {};
    return {};
}

Result<void> Driver::check_context() {
    is_lost_ = is_lost_ || gl::is_context_lost();
    return is_lost_
               ? Result<void>(Error{
                     "the graphics driver gave up while it drew: a shader ran for too long, or "
                     "the GPU failed; draw a smaller picture, or without the GPU"})
               : Result<void>();
}

Result<view::FrameStats> Driver::draw(const view::FrameView& frame, bool wait) {
    const Stopwatch whole;
    const view::DrawList& list = frame.list;
    view::FrameStats stats = list.stats;
    if (auto done = prepare(list, false, stats); !done) {
        return done.error();
    }
    gl::TimerQuery timer = wait && !options_.software ? gl::TimerQuery::create() : gl::TimerQuery();
    if (timer.id() != 0U) {
        timer.begin();
    }
    const Stopwatch drawing;
    if (auto done = draw_picture(list, stats); !done) {
        return done.error();
    }
    if (timer.id() != 0U) {
        timer.end();
    }
    stats.cpu_ms = whole.milliseconds();
    if (wait) {
        if (options_.software) {
            // It draws while commands are submitted: gpu_ms contains that time.
            stats.cpu_ms -= drawing.milliseconds();
        }
        gl::wait_until_drawn();
        const auto measured = timer.poll();
        stats.gpu_ms = measured ? std::chrono::duration<double, std::milli>(*measured).count()
                                : drawing.milliseconds();
    }
    if (auto good = check_context(); !good) {
        return good.error();
    }
    return stats;
}

Result<void> Driver::check_drawn() {
    gl::wait_until_drawn();
    return check_context();
}

namespace {

/// Of the one globe that the tiles of a stream show, if its poles are none of its source's rows.
const geo::WrappedRows* rows_of_globe(const view::DrawList& list) {
    const geo::WrappedRows* rows = nullptr;
    for (const view::TileDraw& draw : list.tiles) {
        const bool is_same = draw.terrain == list.tiles.front().terrain;
        rows = is_same && !draw.tile->borrows ? &draw.terrain->stream->maker().rows() : nullptr;
        if (rows == nullptr) {
            break;
        }
    }
    return rows != nullptr && rows->wrap().rows() > 0 && view::searched_terrains(list).empty()
               ? rows
               : nullptr;
}

// Between vertices, only even rows are linear.
void close_rows(const view::DrawList& list, HitBuffer& hits) {
    const geo::WrappedRows* const rows = rows_of_globe(list);
    for (Hit& hit : hits.samples()) {
        if (rows != nullptr && hit.row != Hit().row) {
            const glm::dvec2 place = hit.place();
            hit = hit_at({place.x, rows->from_even_row(place.y)}, hit.height, hit.depth);
        }
    }
}

} // namespace

Result<view::DrawnHits> Driver::draw_hits(const view::FrameView& frame) {
    if (hit_target_.size() != size()) {
        auto target = gl::Framebuffer::create(
            {.size = size(), .color = gl::Format::rgba32f, .second_color = gl::Format::rg32f});
        if (!target) {
            return target.error();
        }
        hit_target_ = std::move(*target);
    }
    const view::DrawList& list = frame.list;
    view::FrameStats stats = list.stats;
    if (auto done = prepare(list, true, stats); !done) {
        return done.error();
    }
    hit_target_.bind();
    const Hit sky;
    hit_target_.clear_color({sky.col, sky.row, sky.height, sky.depth});
    if (auto done = draw_content(list, hit_target_, true, stats); !done) {
        return done.error();
    }
    const Grid<glm::vec4> channels = gl::read_float_color(hit_target_);
    HitBuffer hits(channels.cols(), channels.rows());
    const Grid<glm::vec4> low = gl::read_second_color(hit_target_);
    if (auto good = check_context(); !good) {
        return good.error();
    }
    std::ranges::transform(channels.samples(), low.samples(), hits.samples().begin(),
                           [](const glm::vec4& hit, const glm::vec4& rest) {
                               return Hit{hit.x, hit.y, hit.z, hit.w, rest.x, rest.y};
                           });
    close_rows(list, hits);
    return view::DrawnHits{std::move(hits), stats};
}

namespace {

view::PictureWork work_of(const gl::Framebuffer& picture) {
    const Grid<glm::vec4> channels = gl::read_float_color(picture);
    view::PictureWork work{Grid<view::PixelWork>(channels.cols(), channels.rows())};
    std::ranges::transform(channels.samples(), work.pixels.samples().begin(),
                           [](const glm::vec4& counts) {
                               return view::PixelWork{static_cast<std::uint32_t>(counts.x),
                                                      static_cast<std::uint32_t>(counts.y),
                                                      static_cast<std::uint32_t>(counts.z)};
                           });
    return work;
}

std::size_t taps_of_beams(const gl::Framebuffer& beams) {
    const Grid<glm::vec4> channels = gl::read_second_color(beams);
    const auto taps = channels.samples();
    return std::accumulate(taps.begin(), taps.end(), std::size_t{0},
                           [](std::size_t sum, const glm::vec4& counts) {
                               return sum + static_cast<std::size_t>(counts.x);
                           });
}

} // namespace

Result<view::PictureWork> Driver::count_work(const view::FrameView& frame) {
    if (work_target_.size() != size()) {
        auto target = gl::Framebuffer::create({.size = size(), .color = gl::Format::rgba32f});
        if (!target) {
            return target.error();
        }
        work_target_ = std::move(*target);
    }
    view::FrameStats ignored;
    if (auto done = prepare(frame.list, false, ignored); !done) {
        return done.error();
    }
    if (auto prepared = counted_beams_.prepare(frame.list); !prepared) {
        return prepared.error();
    }
    if (auto drawn = draw_work(frame.list, work_target_); !drawn) {
        return drawn.error();
    }
    view::PictureWork work = work_of(work_target_);
    if (options_.skips.beams && needs_beams(frame.list)) {
        work.beam_taps = taps_of_beams(counted_beams_.framebuffer());
    }
    return work;
}

// Terrains only: nothing else counts.
Result<void> Driver::draw_work(const view::DrawList& list, const gl::Framebuffer& picture) {
    view::FrameStats ignored;
    picture.bind();
    picture.clear_color(glm::vec4(0.0F));
    DrawState state(shaders_, blocks_, options_.software, ignored);
    picture.clear_depth();
    frame_block_.bind_uniform_block(FrameBlock::layout.binding);
    const FrameContext frame{.list = list,
                             .residency = residency_,
                             .hits = false,
                             .features = scene_features(list, false, 1, options_.skips.features) |
                                         feature_counting,
                             .picture = picture,
                             .beams = counted_beams_.framebuffer(),
                             .no_vertices = no_vertices_,
                             .skips = options_.skips,
                             .state = state};
    auto drawn = draw_terrain_tiles(frame);
    drawn = drawn ? draw_reliefs(frame) : drawn;
    state.set_adding(false);
    return drawn;
}

Result<void> Driver::prepare(const view::DrawList& list, bool hits, view::FrameStats& stats) {
    if (!options_.skips.uploads) {
        residency_ = {};
    } else if (!options_.skips.cuts) {
        residency_.forget_cuts();
    }
    if (auto good = view::check_techniques(list); !good) {
        return good;
    }
    if (auto good = check_support(list, limits_); !good) {
        return good;
    }
    blocks_.begin_frame();
    write_frame_block(list, stats);
    if (auto prepared = beam_target_.prepare(list); !prepared) {
        return prepared;
    }
    std::vector<view::MeshDraw> casters;
    if (!hits) {
        if (auto prepared = ground_shadow_.prepare(list, limits_.max_texture_size, stats);
            !prepared) {
            return prepared;
        }
        if (auto prepared = mesh_shadow_.prepare(list, limits_.max_texture_size); !prepared) {
            return prepared;
        }
        casters = mesh_shadow_.casters_beside(list);
    }
    return residency_.prepare(list, !hits, casters, stats);
}

void Driver::write_frame_block(const view::DrawList& list, view::FrameStats& stats) {
    const FrameBlock block = frame_block(list);
    frame_block_.write(0, std::as_bytes(std::span(&block, 1)));
    ++stats.uploads;
    stats.upload_bytes += sizeof(block);
}

Result<void> Driver::draw_picture(const view::DrawList& list, view::FrameStats& stats) {
    if (auto drawn = draw_mesh_shadows(list, stats); !drawn) {
        return drawn;
    }
    const int samples = samples_of(list, size(), options_.samples);
    if (samples == 1) {
        return draw_pass(list, color_target_, stats);
    }
    if (!sample_target_.is_for(size(), samples)) {
        sample_target_ = {};
        auto made = SampleTarget::create(size(), samples);
        if (!made) {
            return made.error();
        }
        sample_target_ = std::move(*made);
    }
    return draw_samples(list, stats);
}

// Its triangles are not those of the picture.
Result<void> Driver::draw_mesh_shadows(const view::DrawList& list, view::FrameStats& stats) {
    if (!mesh_shadow_.is_cast()) {
        return {};
    }
    view::FrameStats drawn_stats;
    DrawState state(shaders_, blocks_, options_.software, drawn_stats);
    auto drawn = mesh_shadow_.draw(list, residency_, state);
    add_work(stats, drawn_stats);
    return drawn;
}

Result<void> Driver::draw_samples(const view::DrawList& list, view::FrameStats& stats) {
    const SamplePlan plan = sample_target_.plan();
    if (plan.passes == 1) {
        return draw_sample_pass(list, 0, stats);
    }
    view::DrawList shifted = list;
    for (int pass = 0; pass < plan.passes; ++pass) {
        view::FrameStats again;
        view::FrameStats& counted = pass == 0 ? stats : again;
        shifted.camera.shift = list.camera.shift + pass_shift(plan, pass);
        write_frame_block(shifted, counted);
        if (auto drawn = draw_sample_pass(shifted, pass, counted); !drawn) {
            return drawn;
        }
        add_work(stats, again);
    }
    return {};
}

Result<void> Driver::draw_sample_pass(const view::DrawList& list, int pass,
                                      view::FrameStats& stats) {
    if (auto drawn = draw_pass(list, sample_target_.picture(), stats); !drawn) {
        return drawn;
    }
    DrawState state(shaders_, blocks_, options_.software, stats);
    return sample_target_.add_pass(pass, color_target_, state, no_vertices_);
}

Result<void> Driver::draw_pass(const view::DrawList& list, const gl::Framebuffer& picture,
                               view::FrameStats& stats) {
    picture.bind();
    picture.clear_color(glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));
    return draw_content(list, picture, false, stats);
}

// What programs read of shadows and point lights.
Result<void> Driver::set_light(const view::DrawList& list, DrawState& state) const {
    if (mesh_shadow_.is_cast() || ground_shadow_.is_on_ground()) {
        if (auto bound = mesh_shadow_.bind(state); !bound) {
            return bound;
        }
    }
    const bool has_points = !list.point_lights.empty() || view::has_surface_shader(list);
    return has_points ? state.set(point_light_block(list)) : Result<void>();
}

Result<void> Driver::draw_content(const view::DrawList& list, const gl::Framebuffer& picture,
                                  bool hits, view::FrameStats& stats) {
    DrawState state(shaders_, blocks_, options_.software, stats);
    picture.clear_depth();
    frame_block_.bind_uniform_block(FrameBlock::layout.binding);
    const FrameContext frame{
        .list = list,
        .residency = residency_,
        .hits = hits,
        .features = scene_features(list, hits, picture.samples(), options_.skips.features),
        .picture = picture,
        .beams = beam_target_.framebuffer(),
        .no_vertices = no_vertices_,
        .skips = options_.skips,
        .state = state,
        .mesh_shadows = !hits && mesh_shadow_.is_cast() ? feature_mesh_shadows : 0U,
        .ground_shadow = hits ? nullptr : &ground_shadow_};
    if (!hits) {
        if (auto set = set_light(list, state); !set) {
            return set;
        }
    }
    for (const auto pass : {draw_terrain_tiles, draw_reliefs, draw_bases, draw_meshes, draw_sky}) {
        if (auto drawn = pass(frame); !drawn) {
            return drawn;
        }
    }
    return {};
}

Image Driver::read_color() const {
    return gl::read_color(color_target_);
}

void Driver::paint_over(glm::ivec2 first, glm::ivec2 size,
                        const std::function<void(Image&)>& paint) {
    Image colors = gl::read_area(color_target_, first, size);
    paint(colors);
    gl::write_area(color_target_, first, colors);
}

void Driver::show_in_window(glm::ivec2 window_size) const {
    color_target_.blit_to_window(window_size);
}

} // namespace reljef::render

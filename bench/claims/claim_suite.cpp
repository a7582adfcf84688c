#include "bench/claims/claim_suite.h"

#include <array>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "app/cli/message.h"
#include "app/cli/progress_line.h"
#include "bench/claims/warp_phases.h"
#include "bench/report/report_json.h"
#include "bench/runner/benchmark_scene.h"
#include "bench/runner/measure.h"
#include "bench/runner/suite.h"
#include "bench/runner/time_table.h"
#include "engine/core/stopwatch.h"
#include "engine/session/scene_renderer.h"
#include "engine/truth/draw.h"
#include "engine/truth/geometric_error.h"
#include "engine/truth/image_error.h"

namespace reljef::bench {
namespace {

// What draws a city.
struct ClaimVariant {
    std::vector<CityPiece> pieces;
    std::unique_ptr<scene::Scene> scene;
    std::unique_ptr<session::SceneRenderer> renderer;
    ClaimRow row;
    view::FrameStats stats; // of the last frame
};

// Names of forms.
constexpr const char* whole_form = "one terrain";
constexpr const char* tile_form = "one tile";
constexpr const char* pieces_form = "pieces";
constexpr const char* city_form = "city only";
constexpr const char* layers_form = "detail texture";

struct ClaimForm {
    const char* name = whole_form;
    PieceTechniques techniques;
};

scene::Technique bounded_triangles() {
    return scene::Technique{scene::Polygons{.error = session::default_max_error}};
}

void add_form(std::vector<ClaimForm>& forms, const char* name, const scene::Technique& technique) {
    forms.push_back({name, {technique, technique}});
}

// The first is texture on one terrain.
std::vector<ClaimForm> forms_of_repeat() {
    std::vector<ClaimForm> forms;
    for (const char* const name : {whole_form, tile_form}) {
        for (const scene::Technique& technique :
             {scene::Technique{scene::Texture{}}, scene::Technique{scene::Relief{}},
              scene::Technique{scene::Exact{}}, bounded_triangles()}) {
            add_form(forms, name, technique);
        }
    }
    return forms;
}

std::vector<ClaimForm> forms_of_lone_city() {
    std::vector<ClaimForm> forms;
    const scene::Technique texture{scene::Texture{}};
    add_form(forms, whole_form, texture);
    add_form(forms, whole_form, bounded_triangles());
    for (const scene::Technique& technique :
         {scene::Technique{scene::Relief{}}, scene::Technique{scene::Exact{}}}) {
        add_form(forms, whole_form, technique);
        add_form(forms, pieces_form, technique);
        forms.push_back({city_form, {technique, texture}});
    }
    return forms;
}

scene::Camera camera_over(const CutCity& city, scene::Pose pose) {
    const scene::TerrainSurface& whole = *city.whole.surface;
    return scene::pose_camera(pose, whole.bounds(), [&](double x, double y) {
        return whole.height_at(x, y).value_or(whole.bounds().low.z);
    });
}

FigureJson rms_figure(const std::optional<RowError::Geometric>& error) {
    return error ? FigureJson(error->distribution.rms) : FigureJson();
}

// In the order of the columns: wrong, of the terrain and of the picture, reprojection, FLIP.
std::array<FigureJson, 4> error_figures(const std::optional<RowError>& error) {
    if (!error) {
        return {nullptr, nullptr, nullptr, nullptr};
    }
    return {json_or_null(error->wrong_of_terrain_percent), error->wrong_percent,
            rms_figure(error->reprojection_px), error->flip};
}

class ClaimRun {
public:
    ClaimRun(ClaimResults& results, std::stop_token stop)
        : results_(results), options_(results.options), stop_(std::move(stop)),
          line_("measuring claims", options_.suite.quiet) {}

    Result<void> run() {
        auto device = make_device(options_.suite);
        if (!device) {
            return device.error();
        }
        results_.environment = environment_of(*device, options_.suite.threads);
        is_software_ = device->info().is_software;
        parts_ = (options_.copies.size() + 1) * options_.poses.size() + 2;
        for (const int copies : options_.copies) {
            const auto city = repeated_city(options_.tile, copies, threads());
            if (auto done = run_city("repeat", city, forms_of_repeat()); !done) {
                return done;
            }
        }
        const auto city = lone_city(options_.lone);
        if (auto done = run_city("city only", city, forms_of_lone_city()); !done) {
            return done;
        }
        if (auto done = run_warping(*city); !done) {
            return done;
        }
        return stop_.stop_requested() ? Result<void>() : run_layers();
    }

private:
    [[nodiscard]] unsigned threads() const { return static_cast<unsigned>(options_.suite.threads); }

    Result<void> run_city(const std::string& test, const Result<CutCity>& city,
                          const std::vector<ClaimForm>& forms) {
        if (!city) {
            return city.error();
        }
        for (const scene::Pose pose : options_.poses) {
            if (stop_.stop_requested()) {
                return {};
            }
            if (auto done = run_view(test, *city, forms, pose); !done) {
                return done;
            }
            line_.update(static_cast<double>(++parts_done_) / static_cast<double>(parts_));
        }
        return {};
    }

    [[nodiscard]] Result<ClaimVariant> variant_of(const CutCity& city, const ClaimForm& form,
                                                  const scene::Camera& camera) const {
        session::SceneRendererOptions drivers;
        drivers.opengl.emplace();
        drivers.opengl->size = options_.suite.size;
        drivers.opengl->shader_dir = options_.suite.shader_dir;
        drivers.opengl->software = is_software_;
        drivers.selects_always = true;
        auto renderer = session::SceneRenderer::create(drivers);
        if (!renderer) {
            return renderer.error();
        }
        const bool is_whole = form.name == std::string_view(whole_form);
        ClaimVariant made;
        made.pieces = is_whole ? std::vector{city.whole} : city.pieces;
        made.scene = std::make_unique<scene::Scene>(
            scene_of_pieces(city, made.pieces, form.techniques, camera));
        made.renderer = std::make_unique<session::SceneRenderer>(std::move(*renderer));
        made.row.scene = city.name;
        made.row.form = form.name;
        made.row.label = scene::to_string(form.techniques.buildings);
        made.row.nodes = made.pieces.size();
        return made;
    }

    Result<void> run_view(const std::string& test, const CutCity& city,
                          std::vector<ClaimForm> forms, scene::Pose pose) {
        const scene::Camera camera = camera_over(city, pose);
        const scene::Scene whole = scene_of_pieces(city, {city.whole}, {}, camera);
        const auto truth =
            truth::draw(whole, options_.suite.size, {.parallel = {threads(), stop_, {}}});
        if (!truth) {
            return stop_.stop_requested() ? Result<void>() : truth.error();
        }
        forms.push_back(forms.front()); // for the noise floor
        std::vector<ClaimVariant> variants;
        for (const ClaimForm& form : forms) {
            auto made = variant_of(city, form, camera);
            if (!made) {
                return made.error();
            }
            made->row.test = test;
            made->row.pose = pose;
            if (auto good = measure_error(city, *truth, *made); !good) {
                return good;
            }
            variants.push_back(std::move(*made));
        }
        return time_all(std::move(variants));
    }

    Result<void> measure_error(const CutCity& city, const truth::Picture& truth,
                               ClaimVariant& variant) const {
        const auto stats = variant.renderer->draw(*variant.scene, true);
        if (!stats) {
            return stats.error();
        }
        variant.row.bytes = stats->upload_bytes; // the first frame of this renderer
        const Image shown = variant.renderer->read_color();
        const auto hits = variant.renderer->draw_hits(*variant.scene);
        const auto work = variant.renderer->count_work(*variant.scene);
        if (!hits || !work) {
            return hits ? work.error() : hits.error();
        }
        const scene::TerrainSurface& whole = *city.whole.surface;
        const scene::Camera camera = variant.scene->camera();
        const truth::SurfaceView view{whole.heightfield().heights.view(), whole.placement(),
                                      glm::dmat4(1.0), camera};
        const auto geometric = truth::geometric_errors(
            view, hits_on_whole(city, variant.pieces, camera, *hits), truth.hits, threads());
        const auto image = truth::image_errors(shown, truth.image, {.threads = threads()});
        if (!geometric || !image) {
            return geometric ? image.error() : geometric.error();
        }
        variant.row.error = row_error_of(*geometric, *image);
        variant.row.taps = static_cast<double>(view::totals_of(*work).taps) /
                           static_cast<double>(hits->samples().size());
        return {};
    }

    Result<void> time_all(std::vector<ClaimVariant> variants) {
        std::vector<DrawFrame> frames;
        frames.reserve(variants.size());
        for (ClaimVariant& variant : variants) {
            frames.emplace_back([&variant]() -> Result<void> {
                auto stats = variant.renderer->draw(*variant.scene, true);
                if (!stats) {
                    return stats.error();
                }
                variant.stats = *stats;
                return {};
            });
        }
        MeasureOptions timing = timing_of_part();
        timing.null_pair = {0, frames.size() - 1};
        const auto measurement = measure(frames, timing);
        if (!measurement || measurement->ms.back().empty()) {
            return measurement ? Result<void>() : measurement.error();
        }
        for (std::size_t i = 0; i + 1 < variants.size(); ++i) {
            ClaimRow& row = variants[i].row;
            row.timing = timed(measurement->ms[i], measurement->noise_floor);
            row.timing.stats = variants[i].stats;
            results_.rows.push_back(std::move(row));
        }
        return {};
    }

    Result<void> run_warping(const CutCity& city) {
        const MeasureOptions timing = timing_of_part();
        const auto measurement = measure_warp_phases(city, timing, threads());
        if (!measurement || measurement->ms.back().empty()) {
            return measurement ? Result<void>() : measurement.error();
        }
        for (std::size_t i = 0; i < std::size(warp_phase_names); ++i) {
            results_.rows.push_back(
                {.test = "warping",
                 .scene = city.name,
                 .pose = scene::Pose::oblique,
                 .form = warp_phase_names[i],
                 .label = scene::to_string(scene::Technique{scene::Prewarp{}}),
                 .timing = timed(measurement->ms[i], measurement->noise_floor)});
        }
        line_.update(static_cast<double>(++parts_done_) / static_cast<double>(parts_));
        return {};
    }

    [[nodiscard]] MeasureOptions timing_of_part() const {
        MeasureOptions timing =
            measuring(options_.suite, parts_,
                      group_seconds(options_.suite, since_run_.seconds(), parts_ - parts_done_));
        timing.stop = stop_;
        return timing;
    }

    // Bricks are solid below their heights, which four layers show as well. One layer is measured
    // with its own steps, and with those of four.
    Result<void> run_layers() {
        SuiteOptions quiet = options_.suite;
        quiet.quiet = true;
        Results measured =
            run_suite({.name = "layers",
                       .groups = {{.test = "layers",
                                   .scene = {.terrain = "gallery", .detail = "brick"},
                                   .pose = scene::Pose::oblique,
                                   .candidates = candidates_of(
                                       {{scene::Relief{}},
                                        {scene::Relief{.linear_steps = 32, .bisection_steps = 6}},
                                        {scene::MultiLayer{}}})}},
                       .may_leave_out = false},
                      quiet, stop_);
        if (measured.failed) {
            return *measured.stopped;
        }
        for (Row& row : measured.rows) {
            if (!row.null_row) {
                results_.rows.push_back({.test = row.test,
                                         .scene = row.scene,
                                         .pose = row.pose,
                                         .form = layers_form,
                                         .label = row.setting.label,
                                         .timing = std::move(row.timing),
                                         .error = row.error});
            }
        }
        return {};
    }

    ClaimResults& results_;
    const ClaimOptions& options_;
    std::stop_token stop_;
    cli::ProgressLine line_;
    Stopwatch since_run_;
    bool is_software_ = true;
    std::size_t parts_ = 1;
    std::size_t parts_done_ = 0;
};

} // namespace

ClaimResults run_claims(const ClaimOptions& options, const std::stop_token& stop) {
    ClaimResults results;
    results.options = options;
    const auto done = ClaimRun(results, stop).run();
    results.end = run_end(done, stop, !results.rows.empty());
    return results;
}

FigureTable figure_table(const ClaimResults& results) {
    using namespace columns;
    FigureColumn ms = less("/ms/median", "median", "ms");
    ms.noise = "/noise_floor";
    FigureTable table{
        .suite = "tables-claims",
        .environment = results.environment,
        .shard = {},
        .settings = {{"size", size_text(results.options.suite.size)},
                     {"rounds", results.options.suite.rounds},
                     {"quick", results.options.suite.quick}},
        .summary = {},
        .columns = {group("/test", "test"), group("/scene", "scene"), group("/pose", "pose"),
                    name("/form", "drawn as"), name("/label", "technique"), ms,
                    plain("/noise_floor", "noise", "", 3), plain("/frames", "frames"),
                    plain("/nodes", "nodes"), less("/triangles", "triangles"),
                    less("/objects/bytes", "sent", "bytes"), less("/taps", "taps", "", 1),
                    less("/error/wrong_of_terrain_percent", "wrong", "%"),
                    detail(less("/error/wrong_percent", "wrong of the picture", "%")),
                    less("/error/reprojection_px/rms", "error", "px", 3),
                    less("/error/flip", "FLIP", "", 4)}};
    table.end = results.end;
    for (const ClaimRow& row : results.rows) {
        FigureJson figures{row.test,
                           row.scene,
                           std::string(scene::to_string(row.pose)),
                           row.form,
                           row.label,
                           row.timing.ms.median,
                           json_or_null(row.timing.noise_floor),
                           row.timing.frames,
                           row.nodes,
                           row.error ? FigureJson(row.timing.stats.triangles) : FigureJson(),
                           row.bytes > 0 ? FigureJson(row.bytes) : FigureJson(),
                           json_or_null(row.taps)};
        for (FigureJson& figure : error_figures(row.error)) {
            figures.push_back(std::move(figure));
        }
        table.rows.push_back(std::move(figures));
    }
    return table;
}

} // namespace reljef::bench

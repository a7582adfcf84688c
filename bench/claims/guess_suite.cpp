#include "bench/claims/guess_suite.h"

#include <cmath>

#include <fmt/format.h>

#include "app/cli/progress_line.h"
#include "bench/report/report_json.h"
#include "bench/runner/benchmark_scene.h"
#include "bench/runner/problems.h"
#include "engine/material/color_relief.h"
#include "engine/truth/draw.h"

namespace reljef::bench {
namespace {

// Guesses at the samples of the heights; a picture reaches from edge sample to edge sample.
Grid<float> guess_at_samples(const Image& colors, const Grid<float>& heights) {
    const Grid<float> guess = material::heights_from_colors(colors);
    Grid<float> resampled(heights.cols(), heights.rows());
    const auto place = [](int sample, int samples, int pixels) {
        const double share = samples > 1 ? static_cast<double>(sample) / (samples - 1) : 0.5;
        return share * pixels - 0.5;
    };
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            const glm::dvec2 pixel(place(col, heights.cols(), guess.cols()),
                                   place(row, heights.rows(), guess.rows()));
            resampled(col, row) = static_cast<float>(terrain::bilinear_height(guess.view(), pixel));
        }
    }
    return resampled;
}

// Means, variances and covariance of guess (x) and height (y).
struct Moments {
    double mean_x = 0.0;
    double mean_y = 0.0;
    double variance_x = 0.0;
    double variance_y = 0.0;
    double covariance = 0.0;

    [[nodiscard]] double correlation() const {
        const double product = variance_x * variance_y;
        return product > 0.0 ? covariance / std::sqrt(product) : 0.0;
    }
    [[nodiscard]] double slope() const { return variance_x > 0.0 ? covariance / variance_x : 0.0; }
};

Moments moments_of(const Grid<float>& x, const Grid<float>& y) {
    Moments moments;
    const auto xs = x.samples();
    const auto ys = y.samples();
    const auto count = static_cast<double>(xs.size());
    for (std::size_t i = 0; i < xs.size(); ++i) {
        moments.mean_x += static_cast<double>(xs[i]) / count;
        moments.mean_y += static_cast<double>(ys[i]) / count;
    }
    for (std::size_t i = 0; i < xs.size(); ++i) {
        const double dx = static_cast<double>(xs[i]) - moments.mean_x;
        const double dy = static_cast<double>(ys[i]) - moments.mean_y;
        moments.variance_x += dx * dx / count;
        moments.variance_y += dy * dy / count;
        moments.covariance += dx * dy / count;
    }
    return moments;
}

// offset + slope × guess.
struct Scaling {
    const char* name;
    double offset = 0.0;
    double slope = 0.0;
};

std::vector<Scaling> scalings_of(const Moments& moments, const terrain::HeightRange& range) {
    return {{"flat", moments.mean_y, 0.0},
            {"guessed", range.low, range.high - range.low},
            {"fitted", moments.mean_y - moments.slope() * moments.mean_x, moments.slope()}};
}

// The terrain with other heights, seen by the same camera.
Result<HitBuffer> hits_of(const BenchmarkScene& scene, const Grid<float>& guess,
                          const Scaling& scaling, const SuiteOptions& options) {
    const auto& surface = *scene.terrain().get<scene::TerrainNode>()->surface;
    terrain::Terrain terrain = surface.terrain();
    auto samples = terrain.heightfield.heights.samples();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto value = static_cast<double>(guess.samples()[i]);
        samples[i] = static_cast<float>(scaling.offset + scaling.slope * value);
    }
    terrain.heightfield.range =
        terrain::height_range(terrain.heightfield.heights, terrain.heightfield.void_mask);
    scene::Scene guessed;
    const auto node =
        guessed.add_terrain(std::move(terrain), {.placement = terrain::PlacementKind::plane});
    if (!node) {
        return node.error();
    }
    guessed.add_camera(scene.scene().camera());
    return truth::draw_hits(guessed, options.size,
                            {static_cast<unsigned>(options.threads), {}, {}});
}

Result<GuessRow> measure_guess(const BenchmarkScene& scene, const Grid<float>& guess,
                               const Scaling& scaling, const SuiteOptions& options) {
    const auto truth = truth::draw_hits(scene.scene(), options.size,
                                        {static_cast<unsigned>(options.threads), {}, {}});
    const auto shown = hits_of(scene, guess, scaling, options);
    if (!truth || !shown) {
        return truth ? shown.error() : truth.error();
    }
    const auto& surface = *scene.terrain().get<scene::TerrainNode>()->surface;
    const truth::SurfaceView view{surface.heightfield().heights.view(), surface.placement(),
                                  scene.terrain().world_from_local(), scene.scene().camera()};
    const auto errors =
        truth::geometric_errors(view, *shown, *truth, static_cast<unsigned>(options.threads));
    if (!errors) {
        return errors.error();
    }
    if (!errors->reprojection.distribution) {
        return Error{fmt::format("{}: no pixel of guessed heights found in the picture, some were "
                                 "expected",
                                 scene.name())};
    }
    GuessRow row;
    row.scene = scene.name();
    row.heights = scaling.name;
    row.reprojection = {*errors->reprojection.distribution, errors->reprojection.unbounded};
    row.wrong_percent = errors->wrong_percent;
    return row;
}

Result<void> measure_terrain(const std::string& terrain, GuessResults& results,
                             const std::stop_token& stop) {
    auto scene = BenchmarkScene::open({terrain}, results.options.suite, stop);
    if (!scene) {
        return scene.error();
    }
    scene->set_pose(scene::Pose::overview);
    const auto& surface = *scene->terrain().get<scene::TerrainNode>()->surface;
    if (surface.terrain().color.empty()) {
        return Error{fmt::format("{}: no colours found, some were expected to guess heights from",
                                 scene->name())};
    }
    const Grid<float>& heights = surface.heightfield().heights;
    const Grid<float> guess = guess_at_samples(surface.terrain().color, heights);
    const Moments moments = moments_of(guess, heights);
    for (const Scaling& scaling : scalings_of(moments, surface.heightfield().range)) {
        auto row = measure_guess(*scene, guess, scaling, results.options.suite);
        if (!row) {
            return row.error();
        }
        row->correlation = moments.correlation();
        results.rows.push_back(std::move(*row));
    }
    return {};
}

} // namespace

GuessResults run_guesses(const GuessOptions& options, const std::stop_token& stop) {
    GuessResults results;
    results.options = options;
    results.environment = environment_of(
        {.renderer = "exact rays in double precision", .version = "none", .context = "cpu"},
        options.suite.threads);
    cli::ProgressLine line("guessing heights", options.suite.quiet);
    Problems problems;
    for (std::size_t i = 0; i < options.terrains.size() && !stop.stop_requested(); ++i) {
        if (auto done = measure_terrain(options.terrains[i], results, stop); !done) {
            problems.add(done.error());
        }
        line.update(static_cast<double>(i + 1) / static_cast<double>(options.terrains.size()));
    }
    results.end = run_end(problems.end(), stop, !results.rows.empty());
    results.end.failed = results.end.failed && results.rows.empty();
    return results;
}

FigureTable figure_table(const GuessResults& results) {
    using namespace columns;
    FigureTable table{
        .suite = "tables-guesses",
        .environment = results.environment,
        .shard = {},
        .settings = {{"size", size_text(results.options.suite.size)}, {"pose", "overview"}},
        .summary = {},
        .columns = {group("/scene", "terrain"), name("/heights", "heights"),
                    plain("/correlation", "correlation"),
                    less("/error/reprojection_px/rms", "error", "px"),
                    less("/error/wrong_percent", "wrong", "%", 1)}};
    table.end = results.end;
    for (const GuessRow& row : results.rows) {
        table.rows.push_back({row.scene, row.heights, row.correlation,
                              row.reprojection.distribution.rms, row.wrong_percent});
    }
    return table;
}

} // namespace reljef::bench

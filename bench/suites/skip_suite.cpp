#include "bench/suites/skip_suite.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "app/cli/console_log.h"
#include "app/cli/progress_line.h"
#include "bench/runner/benchmark_scene.h"
#include "bench/runner/measure.h"
#include "bench/runner/problems.h"
#include "bench/runner/time_table.h"
#include "bench/suites/skip_check.h"
#include "bench/suites/skip_kinds.h"
#include "engine/core/stopwatch.h"
#include "engine/session/streaming.h"

namespace reljef::bench {
namespace {

// One row: its renderer skips everything, or all but one kind.
struct SkipVariant {
    Row row;
    std::unique_ptr<session::SceneRenderer> renderer;
    view::FrameStats stats; // of the last frame
};

struct SkipGroup {
    std::string terrain;
    scene::Pose pose = scene::Pose::overview;
};

std::vector<SkipGroup> skip_groups(const SkipOptions& options) {
    using scene::Pose;
    const std::vector<std::string> terrains =
        options.terrains.empty() ? std::vector<std::string>{"natural", "urban"} : options.terrains;
    std::vector<Pose> poses = options.poses;
    if (poses.empty()) {
        poses = options.suite.quick
                    ? std::vector<Pose>{Pose::low}
                    : std::vector<Pose>{Pose::overview, Pose::low, Pose::grazing, Pose::valley};
    }
    std::vector<SkipGroup> groups;
    for (const std::string& terrain : terrains) {
        for (const Pose pose : poses) {
            groups.push_back({terrain, pose});
        }
    }
    std::vector<SkipGroup> part;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        if (options.shard.has(i)) {
            part.push_back(groups[i]);
        }
    }
    return part;
}

std::vector<SkipTest> chosen_tests(const SkipOptions& options) {
    std::vector<SkipTest> tests = skip_tests();
    for (SkipTest& test : tests) {
        std::erase_if(test.kinds, [&](const SkipKind& kind) {
            return !options.kinds.empty() && std::find(options.kinds.begin(), options.kinds.end(),
                                                       kind.name) == options.kinds.end();
        });
    }
    const bool has_rays_only = options.suite.context == session::BackendKind::cpu;
    std::erase_if(tests, [&](const SkipTest& test) {
        return test.kinds.empty() || (has_rays_only && !test.by_rays);
    });
    return tests;
}

std::optional<double> more_without(std::optional<double> without, std::optional<double> all) {
    return without && all ? std::optional(*without - *all) : std::nullopt;
}

template <class Member>
std::optional<double> saved_work(const Row& without, const Row& all, Member member) {
    return without.work && all.work ? std::optional(static_cast<double>((*without.work).*member) -
                                                    static_cast<double>((*all.work).*member))
                                    : std::nullopt;
}

double as_number(std::size_t count) {
    return static_cast<double>(count);
}

RowSkip::Savings savings_of(const Row& without, const Row& all) {
    const view::FrameStats& on = all.timing.stats;
    const view::FrameStats& off = without.timing.stats;
    return {.ms = without.timing.ms.median - all.timing.ms.median,
            .taps = saved_work(without, all, &view::WorkTotals::taps),
            .steps = saved_work(without, all, &view::WorkTotals::steps),
            .rays = saved_work(without, all, &view::WorkTotals::rays),
            .triangles = as_number(off.triangles) - as_number(on.triangles),
            .bytes_uploaded = as_number(off.upload_bytes) - as_number(on.upload_bytes),
            .bytes_read = more_without(without.skip->bytes_read, all.skip->bytes_read),
            .state_changes = static_cast<double>(off.state_changes - on.state_changes)};
}

class SkipRun {
public:
    SkipRun(Results& results, const SkipOptions& options, std::stop_token stop)
        : results_(results), options_(options), stop_(std::move(stop)), log_(options.suite.quiet),
          line_("measuring skip", options.suite.quiet), views_(0) {}

    Result<void> run() {
        const auto groups = skip_groups(options_);
        const auto tests = chosen_tests(options_);
        if (tests.empty()) {
            return usage_error(fmt::format(
                "--kind: {} found, which --context cpu does not have; a kind of rays on "
                "the CPU was expected",
                fmt::join(options_.kinds, ", ")));
        }
        if (auto made = make_devices(); !made) {
            return made;
        }
        parts_ = groups.size() * tests.size();
        for (const SkipGroup& group : groups) {
            for (const SkipTest& test : tests) {
                if (stop_.stop_requested()) {
                    return {};
                }
                if (auto done = run_test(group, test); !done && !stop_.stop_requested()) {
                    problems_.add(done.error());
                    note(done.error().message);
                }
                ++parts_done_;
                line_.update(as_number(parts_done_) / as_number(parts_));
            }
        }
        return problems_.end();
    }

private:
    Result<void> make_devices() {
        results_.settings = run_settings(options_.suite);
        if (options_.suite.context == session::BackendKind::cpu) {
            auto rays = make_rays_device(options_.suite);
            if (!rays) {
                return rays.error();
            }
            results_.environment = environment_of(*rays, options_.suite.threads);
            return {};
        }
        auto device = make_device(options_.suite);
        if (!device) {
            return device.error();
        }
        device_.emplace(std::move(*device));
        results_.environment = environment_of(*device_, options_.suite.threads);
        is_software_ = device_->info().is_software;
        return {};
    }

    // Of all skipping.
    [[nodiscard]] Result<session::SceneRendererOptions> drivers_of(const SkipTest& test) const {
        const SuiteOptions& suite = options_.suite;
        session::SceneRendererOptions drivers;
        if (!test.by_rays) {
            drivers.opengl.emplace();
            drivers.opengl->size = suite.size;
            drivers.opengl->shader_dir = suite.shader_dir;
            drivers.opengl->software = is_software_;
            return drivers;
        }
        const auto target = session::simd_target_of(suite.simd);
        if (!target) {
            return target.error();
        }
        drivers.rays.emplace();
        drivers.rays->size = suite.size;
        drivers.rays->threads = static_cast<unsigned>(suite.threads);
        drivers.rays->target = *target;
        return drivers;
    }

    Result<SkipVariant> variant(const SkipGroup& group, const SkipTest& test,
                                const SkipKind* kind) const {
        auto drivers = drivers_of(test);
        if (!drivers) {
            return drivers.error();
        }
        if (kind != nullptr) {
            kind->switch_off(*drivers);
        }
        auto renderer = session::SceneRenderer::create(*drivers);
        if (!renderer) {
            return renderer.error();
        }
        SkipVariant made;
        made.row.suite = "skip";
        made.row.test = test.name;
        made.row.pose = group.pose;
        made.row.setting = setting_of(test.technique);
        made.row.setting.label =
            kind != nullptr ? fmt::format("without {}", kind->name) : "everything skipped";
        made.row.size = options_.suite.size;
        made.row.skip.emplace();
        made.row.skip->without = kind != nullptr ? kind->name : "";
        made.row.skip->meaning = kind != nullptr ? kind->meaning : "";
        made.renderer = std::make_unique<session::SceneRenderer>(std::move(*renderer));
        return made;
    }

    // Everything skipped; without each kind; everything skipped again.
    Result<std::vector<SkipVariant>> variants(const SkipGroup& group, const SkipTest& test) const {
        std::vector<const SkipKind*> kinds{nullptr};
        for (const SkipKind& kind : test.kinds) {
            kinds.push_back(&kind);
        }
        kinds.push_back(nullptr);
        std::vector<SkipVariant> made;
        for (const SkipKind* const kind : kinds) {
            auto next = variant(group, test, kind);
            if (!next) {
                return next.error();
            }
            made.push_back(std::move(*next));
        }
        made.back().row.null_row = true;
        return made;
    }

    [[nodiscard]] SceneChoice choice_of(const SkipGroup& group, const SkipTest& test) const {
        SceneChoice choice{.terrain = group.terrain};
        if (test.is_streamed) {
            choice.memory_megabytes = options_.memory_megabytes;
        }
        return choice;
    }

    // Kept from test to test. Streams are opened anew: what they read is counted.
    Result<BenchmarkScene*> scene_of(const SkipGroup& group, const SkipTest& test) {
        const SceneChoice choice = choice_of(group, test);
        if (test.is_streamed || scene_choice_ != choice) {
            scene_.reset();
            scene_choice_.reset();
            SuiteOptions suite = options_.suite;
            suite.quiet = suite.quiet || !noted_.insert(choice.terrain).second;
            auto opened = BenchmarkScene::open(choice, suite, stop_);
            if (!opened) {
                return opened.error();
            }
            scene_.emplace(std::move(*opened));
            scene_choice_ = choice;
        }
        scene_->set_pose(group.pose);
        scene_->set_daylight(test.daylight);
        scene_->set_technique(test.technique);
        return &*scene_;
    }

    [[nodiscard]] static bool is_streamed(const BenchmarkScene& scene) {
        return scene.terrain().get<scene::TerrainNode>()->stream != nullptr;
    }

    Result<void> run_test(const SkipGroup& group, const SkipTest& test) {
        const Stopwatch since_begin;
        auto scene = scene_of(group, test);
        if (!scene) {
            return scene.error();
        }
        if (test.is_streamed && !is_streamed(**scene)) {
            note(fmt::format("{}: not measured as a stream, as it is no georeferenced file that "
                             "does not fit {} MB",
                             (*scene)->name(), options_.memory_megabytes));
            return {};
        }
        auto made = variants(group, test);
        if (!made) {
            return made.error();
        }
        if (test.is_streamed) {
            if (auto counted = count_bytes(group, test, *made); !counted) {
                return counted;
            }
            scene = &*scene_;
        }
        if (auto checked = check_pictures(test, **scene, *made); !checked) {
            return checked;
        }
        return time_all(**scene, std::move(*made), since_begin);
    }

    void note(const std::string& text) {
        if (std::find(results_.notes.begin(), results_.notes.end(), text) == results_.notes.end()) {
            results_.notes.push_back(text);
        }
    }

    void wait_for_tiles(BenchmarkScene& scene, session::SceneRenderer& renderer) {
        session::wait_for_tiles(scene.scene(), options_.suite.size, renderer.selector(), log_,
                                stop_);
    }

    // Of each variant, with a stream that has read nothing yet but its overview.
    Result<void> count_bytes(const SkipGroup& group, const SkipTest& test,
                             std::vector<SkipVariant>& variants) {
        for (SkipVariant& variant : variants) {
            auto scene = scene_of(group, test);
            if (!scene) {
                return scene.error();
            }
            wait_for_tiles(**scene, *variant.renderer);
            double bytes = 0.0;
            for (const auto& stats : session::stream_stats((*scene)->scene())) {
                bytes += as_number(stats.bytes_read);
            }
            variant.row.skip->bytes_read = bytes;
            variant.renderer->forget_scene();
        }
        return {};
    }

    Result<void> check_pictures(const SkipTest& test, BenchmarkScene& scene,
                                std::vector<SkipVariant>& variants) {
        std::optional<DrawnPicture> all;
        for (std::size_t i = 0; i < variants.size() && !stop_.stop_requested(); ++i) {
            SkipVariant& variant = variants[i];
            variant.row.scene = scene.name();
            if (test.is_streamed) {
                wait_for_tiles(scene, *variant.renderer);
            }
            auto drawn = draw_picture(scene.scene(), *variant.renderer);
            if (!drawn) {
                return drawn.error();
            }
            if (!all) {
                all = std::move(*drawn);
            } else {
                const bool is_again = i > test.kinds.size();
                compare(scene, *all, *drawn,
                        is_again ? SkipRounding::none : test.kinds[i - 1].rounding, variant.row);
            }
            if (auto counted = count_work(scene, variant); !counted) {
                return counted;
            }
        }
        return measure_error(test, scene, variants.front());
    }

    void compare(const BenchmarkScene& scene, const DrawnPicture& all, const DrawnPicture& without,
                 SkipRounding rounding, Row& row) {
        row.skip->difference = difference_of(scene.scene(), scene.terrain(), all, without,
                                             rounding == SkipRounding::hits);
        row.skip->difference.tolerance_levels = rounding == SkipRounding::colors ? 1 : 0;
    }

    Result<void> count_work(const BenchmarkScene& scene, SkipVariant& variant) {
        auto work = variant.renderer->count_work(scene.scene());
        if (!work) {
            return work.error();
        }
        variant.row.work = view::totals_of(*work);
        if (options_.suite.keep_views) {
            work_ = std::move(work->pixels);
        }
        return {};
    }

    // Of the row that skips everything; the others show the same.
    Result<void> measure_error(const SkipTest& test, BenchmarkScene& scene, SkipVariant& variant) {
        if (test.is_streamed || test.daylight != Daylight::scene || stop_.stop_requested()) {
            return {};
        }
        auto measured = scene.measure_error(test.technique, *variant.renderer, stop_);
        if (!measured) {
            return stop_.stop_requested() ? Result<void>() : measured.error();
        }
        variant.row.error = measured->error;
        if (measured->view) {
            measured->view->work = std::move(work_);
            auto view = views_.make(*measured->view);
            if (!view) {
                return view.error();
            }
            variant.row.view = std::move(*view);
        }
        return {};
    }

    DrawFrame frame_of(SkipVariant& variant, const BenchmarkScene& scene) const {
        return [&]() -> Result<void> {
            auto stats = variant.renderer->draw(scene.scene(), true);
            if (!stats) {
                return stats.error();
            }
            variant.stats = *stats;
            return {};
        };
    }

    Result<void> time_all(const BenchmarkScene& scene, std::vector<SkipVariant> variants,
                          const Stopwatch& since_begin) {
        if (stop_.stop_requested()) {
            return {};
        }
        std::vector<DrawFrame> frames;
        frames.reserve(variants.size());
        for (SkipVariant& variant : variants) {
            frames.push_back(frame_of(variant, scene));
        }
        const double share =
            group_seconds(options_.suite, since_run_.seconds(), parts_ - parts_done_);
        MeasureOptions timing = measuring(options_.suite, parts_, share - since_begin.seconds());
        timing.stop = stop_;
        timing.null_pair = {0, frames.size() - 1};
        auto measurement = measure(frames, timing);
        if (!measurement) {
            return measurement.error();
        }
        const bool is_whole =
            std::none_of(measurement->ms.begin(), measurement->ms.end(),
                         [](const std::vector<double>& ms) { return ms.empty(); });
        if (is_whole) {
            keep_rows(std::move(variants), *measurement);
        }
        return {};
    }

    void keep_rows(std::vector<SkipVariant> variants, const Measurement& measurement) {
        const std::size_t first = results_.rows.size();
        for (std::size_t i = 0; i < variants.size(); ++i) {
            Row& row = variants[i].row;
            row.timing = timed(measurement.ms[i], measurement.noise_floor);
            row.timing.stats = variants[i].stats;
            row.skip->saved = i == 0 ? RowSkip::Savings() : savings_of(row, results_.rows[first]);
            results_.rows.push_back(std::move(row));
        }
    }

    Results& results_;
    const SkipOptions& options_;
    std::stop_token stop_;
    std::set<std::string> noted_; // terrains whose notes were shown
    cli::ConsoleLog log_;
    cli::ProgressLine line_;
    RowViews views_;
    Stopwatch since_run_;
    std::size_t parts_ = 1;
    std::size_t parts_done_ = 0;
    std::optional<session::Device> device_; // its context is current
    bool is_software_ = true;
    std::optional<SceneChoice> scene_choice_;
    std::optional<BenchmarkScene> scene_;
    Grid<view::PixelWork> work_; // of the last variant
    Problems problems_;
};

} // namespace

Results run_skip(const SkipOptions& options, const std::stop_token& stop) {
    Results results;
    results.shard = options.shard;
    const auto done = SkipRun(results, options, stop).run();
    if (stop.stop_requested()) {
        results.stopped =
            Error{results.rows.empty() ? "interrupted before the first frame was timed"
                                       : "interrupted, the tables hold the tests done until then"};
    } else if (!done) {
        results.stopped = done.error();
        results.failed = results.rows.empty();
    }
    return results;
}

Result<void> check_same_pictures(const Results& results) {
    for (const Row& row : results.rows) {
        if (row.skip && !row.skip->difference.is_allowed()) {
            const RowSkip::Difference& found = row.skip->difference;
            return Error{fmt::format(
                "{}, {}, {}: another picture found {}: {} pixels, and hits up to {:.3g} px off; "
                "the same was expected",
                row.scene, scene::to_string(row.pose), row.test, row.setting.label, found.pixels,
                found.max_px)};
        }
    }
    return {};
}

} // namespace reljef::bench

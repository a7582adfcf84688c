#include "bench/runner/suite.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/progress_line.h"
#include "bench/runner/measure.h"
#include "bench/runner/moving_view.h"
#include "bench/runner/problems.h"
#include "bench/runner/time_table.h"
#include "engine/core/stopwatch.h"

namespace reljef::bench {
namespace {

struct Entry {
    Row row;
    scene::Technique technique;
    bool by_rays = false;
    view::FrameStats stats{};     // of the last frame
    std::vector<double> gpu_ms{}; // of every frame
    int frames = 0;               // drawn
};

class SuiteProgress {
public:
    SuiteProgress(std::string_view label, std::size_t groups, const SuiteOptions& options)
        : line_(fmt::format("measuring {}", label), options.quiet), progress_(options.progress),
          groups_(static_cast<double>(groups)), error_share_(options.quick ? 0.7 : 0.2) {}

    void begin_group(std::size_t index) { index_ = static_cast<double>(index); }
    void report_checked(double fraction) { report(error_share_ * fraction); }
    void report_timed(double fraction) { report(std::lerp(error_share_, 1.0, fraction)); }

private:
    void report(double fraction_of_group) {
        const double fraction = (index_ + fraction_of_group) / groups_;
        line_.update(fraction);
        if (progress_) {
            progress_(fraction);
        }
    }

    cli::ProgressLine line_;
    const Progress& progress_;
    double groups_;
    double error_share_; // estimate: the part of a group's time spent on errors
    double index_ = 0.0;
};

Setting labelled(const Candidate& candidate) {
    Setting setting = setting_of(candidate.technique);
    setting.label += candidate.by_rays ? " on cpu" : "";
    return setting;
}

Suite with_rays(Suite suite) {
    for (Group& group : suite.groups) {
        std::vector<Candidate> candidates;
        for (Candidate& candidate : group.candidates) {
            Candidate by_rays{candidate.technique, {}, true};
            candidates.push_back(std::move(candidate));
            if (group.scene.detail.empty() && session::rays_draw(by_rays.technique)) {
                candidates.push_back(std::move(by_rays));
            }
        }
        group.candidates = std::move(candidates);
    }
    return suite;
}

std::vector<Entry> entries_of(const Group& group, std::string_view suite, const std::string& scene,
                              glm::ivec2 size) {
    check(!group.candidates.empty(), "a group without candidates");
    std::vector<Entry> entries;
    for (const Candidate& candidate : group.candidates) {
        Row row;
        row.suite = suite;
        row.test = group.test;
        row.scene = scene;
        row.pose = group.pose;
        row.setting = labelled(candidate);
        row.size = size;
        row.source = candidate.source;
        entries.push_back({std::move(row), candidate.technique, candidate.by_rays});
    }
    return entries;
}

// Index of the entry that the null row repeats: the first that shows terrain, or texture if none
// does.
std::size_t repeated_entry(std::span<const Entry> entries) {
    const auto first = std::find_if(entries.begin(), entries.end(),
                                    [](const Entry& entry) { return !entry.row.shows_nothing(); });
    return first == entries.end() ? 0 : static_cast<std::size_t>(first - entries.begin());
}

std::vector<Entry> with_null_row(std::vector<Entry> entries) {
    if (!entries.empty()) {
        const Entry& repeated = entries[repeated_entry(entries)];
        Entry null_entry{repeated.row, repeated.technique, repeated.by_rays};
        null_entry.row.null_row = true;
        null_entry.row.source.reset();
        null_entry.row.view.reset();
        null_entry.frames = MovingView::half_period; // elsewhere, or it would find what was cut
        entries.push_back(std::move(null_entry));
    }
    return entries;
}

DrawFrame frame_of(Entry& entry, BenchmarkScene& scene, session::SceneRenderer& driver,
                   const std::optional<MovingView>& moving) {
    return [&]() -> Result<void> {
        scene.set_technique(entry.technique);
        if (moving) {
            scene.set_camera(moving->at(entry.frames++));
        }
        auto stats = driver.draw(scene.scene(), true);
        if (!stats) {
            return stats.error();
        }
        entry.stats = *stats;
        entry.gpu_ms.push_back(stats->gpu_ms);
        return {};
    };
}

// Whether the run was stopped before every entry was drawn once.
bool lacks_a_round(const Measurement& measurement) {
    return measurement.stopped &&
           std::any_of(measurement.ms.begin(), measurement.ms.end(),
                       [](const std::vector<double>& ms) { return ms.empty(); });
}

MeasureOptions one_round() {
    MeasureOptions options;
    options.warm_up_rounds = 0;
    options.min_rounds = 1;
    options.max_rounds = 1;
    return options;
}

// Absent if the null row (the last list) or the row it repeats has too few frames.
std::optional<double> noise_floor_of(const Measurement& measurement, std::size_t repeated) {
    const bool is_reliable =
        std::min(measurement.ms[repeated].size(), measurement.ms.back().size()) >= min_frames;
    return is_reliable ? measurement.noise_floor : std::nullopt;
}

LeftOut left_out_of(const Group& group, const std::string& scene, std::span<const Row> rows) {
    LeftOut left_out{scene, group.pose, 0, {}};
    std::set<scene::TechniqueId> found;
    for (const Candidate& candidate : group.candidates) {
        const bool is_first = found.insert(candidate.technique.id()).second;
        const Setting setting = labelled(candidate);
        const bool has_row = std::any_of(rows.begin(), rows.end(), [&](const Row& row) {
            return row.setting.label == setting.label;
        });
        if (!has_row) {
            ++left_out.settings;
            if (is_first) {
                left_out.techniques.push_back(setting.technique);
            }
        }
    }
    return left_out;
}

std::string left_out_note(const LeftOut& left_out, std::size_t candidates, bool is_stopped) {
    return fmt::format("{}, {}: {} of {} settings left out, {}{}{}", left_out.scene,
                       scene::to_string(left_out.pose), left_out.settings, candidates,
                       is_stopped ? "as the run was stopped" : "there was no time for them",
                       left_out.techniques.empty() ? "" : "; even the first of ",
                       fmt::join(left_out.techniques, ", "));
}

class SuiteRun {
public:
    SuiteRun(Results& results, const Suite& suite, const SuiteOptions& options,
             std::stop_token stop)
        : results_(results), suite_(suite), options_(options), stop_(std::move(stop)),
          scenes_(options, stop_, suite.keep_scenes), views_(suite.max_view_cols) {}

    Result<void> run() {
        if (suite_.groups.empty()) {
            return Error{"--technique: none found that draws what is measured; the gallery shows "
                         "what bump, emboss, normal, displacement and the layers draw, terrains "
                         "what polygons draws"};
        }
        auto device = make_device(options_);
        if (!device) {
            return device.error();
        }
        if (options_.context == session::BackendKind::cpu) {
            auto rays = make_rays_device(options_);
            if (!rays) {
                return rays.error();
            }
            rays_.emplace(std::move(*rays));
            results_.notes.push_back(
                fmt::format("on cpu: {}, {}", rays_->info().renderer, rays_->info().version));
        }
        results_.environment = environment_of(*device, options_.threads);
        results_.settings = run_settings(options_);
        is_software_ = device->info().is_software;
        open_scenes();
        SuiteProgress progress(suite_.name, suite_.groups.size(), options_);
        for (std::size_t i = 0; i < suite_.groups.size() && !stop_.stop_requested(); ++i) {
            progress.begin_group(i);
            if (is_left_out(suite_.groups[i].scene)) {
                continue;
            }
            if (auto done = run_group(i, device->renderer(), progress);
                !done && !stop_.stop_requested()) {
                problems_.add(done.error());
            }
        }
        for (const std::string& sentence : problems_.sentences()) {
            results_.notes.push_back(sentence);
        }
        return problems_.end();
    }

private:
    // The scene's name, or its path if another scene has the same name.
    [[nodiscard]] const std::string& name_of(const Group& group,
                                             const BenchmarkScene& scene) const {
        return shared_names_.contains(scene.name()) ? group.scene.terrain : scene.name();
    }

    [[nodiscard]] bool is_left_out(const SceneChoice& scene) const {
        return std::find(left_out_.begin(), left_out_.end(), scene) != left_out_.end();
    }

    // Opens all scenes first, so that their names are known. A scene that cannot be opened costs
    // the others nothing.
    void open_scenes() {
        if (!suite_.keep_scenes) {
            return;
        }
        std::map<std::string, SceneChoice> owners; // by name
        for (const Group& group : suite_.groups) {
            if (stop_.stop_requested() || is_left_out(group.scene)) {
                continue;
            }
            const auto scene = scenes_.get(group.scene);
            if (!scene) {
                problems_.add(scene.error());
                left_out_.push_back(group.scene);
                continue;
            }
            const std::string& name = (*scene)->name();
            if (owners.emplace(name, group.scene).first->second != group.scene) {
                shared_names_.insert(name);
            }
        }
    }

    Result<void> run_group(std::size_t index, session::SceneRenderer& driver,
                           SuiteProgress& progress) {
        const Group& group = suite_.groups[index];
        const std::size_t left = suite_.groups.size() - index;
        const double seconds = group_seconds(options_, since_begin_.seconds(), left);
        since_group_ = Stopwatch();
        driver.forget_scene();
        if (rays_) {
            rays_->renderer().forget_scene();
        }
        const auto scene = scenes_.get(group.scene);
        if (!scene) {
            return scene.error();
        }
        (*scene)->set_pose(group.pose);
        const std::string& name = name_of(group, **scene);
        auto entries = check_errors(entries_of(group, suite_.name, name, options_.size), seconds,
                                    **scene, driver, progress);
        if (!entries || entries->empty()) {
            return entries ? Result<void>() : entries.error();
        }
        MeasureOptions timing = measuring(options_, suite_.groups.size(),
                                          group_seconds(options_, since_begin_.seconds(), left));
        timing.stop = stop_;
        timing.progress = [&](double fraction) { progress.report_timed(fraction); };
        const std::size_t first_row = results_.rows.size();
        if (auto timed = time_all(std::move(*entries), **scene, driver, timing); !timed) {
            return timed;
        }
        note_left_out(group, name, std::span(results_.rows).subspan(first_row));
        return {};
    }

    // Measures errors. Returns the entries to time, with the null row: those that fit into
    // `seconds` if entries may be left out, but always texture; after a stop, those that are done.
    Result<std::vector<Entry>> check_errors(std::vector<Entry> entries, double seconds,
                                            BenchmarkScene& scene, session::SceneRenderer& driver,
                                            SuiteProgress& progress) {
        std::vector<Entry> kept;
        GroupCost cost;
        const std::size_t count = entries.size();
        for (std::size_t i = 0; i < count && !stop_.stop_requested(); ++i) {
            const bool may_leave_out = suite_.may_leave_out && i > 0;
            cost.elapsed = since_group_.seconds();
            if (may_leave_out && !fits(with_another(cost, frame_seconds(entries[i])), seconds)) {
                continue;
            }
            auto after = check_error(entries[i], cost, scene, driver);
            if (!after && stop_.stop_requested()) {
                break;
            }
            if (!after) {
                return after.error();
            }
            if (may_leave_out && !fits(*after, seconds)) {
                continue;
            }
            cost = *after;
            kept.push_back(std::move(entries[i]));
            progress.report_checked(static_cast<double>(i + 1) / static_cast<double>(count));
        }
        return with_null_row(std::move(kept));
    }

    Result<GroupCost> check_error(Entry& entry, const GroupCost& cost, BenchmarkScene& scene,
                                  session::SceneRenderer& driver) {
        const bool is_texture = cost.frames == 0;
        const Stopwatch since_begin;
        auto measured = scene.measure_error(entry.technique, renderer_of(entry, driver), stop_);
        if (!measured) {
            return measured.error();
        }
        entry.row.error = measured->error;
        if (auto counted = count_work(entry, *measured, scene, renderer_of(entry, driver));
            !counted) {
            return counted.error();
        }
        if (measured->view) {
            auto view = views_.make(*measured->view);
            if (!view) {
                return view.error();
            }
            entry.row.view = std::move(*view);
        }
        const Stopwatch since_checked;
        if (auto drawn = frame_of(entry, scene, renderer_of(entry, driver), {})(); !drawn) {
            return drawn.error();
        }
        const double frame = since_checked.seconds();
        frame_seconds_[entry.row.setting.label] = frame;
        const int frames = is_texture ? 2 : 1; // and the null row
        return GroupCost{
            since_group_.seconds(), is_texture ? 0.0 : cost.error_seconds + since_begin.seconds(),
            is_texture ? 0 : cost.checked + 1, cost.round + frames * frame, cost.frames + frames};
    }

    // Meshes do not count.
    static Result<void> count_work(Entry& entry, MeasuredError& measured, BenchmarkScene& scene,
                                   session::SceneRenderer& renderer) {
        auto work = renderer.count_work(scene.scene());
        if (!work) {
            return work.error();
        }
        const view::WorkTotals totals = view::totals_of(*work);
        if (totals.taps > 0) {
            entry.row.work = totals;
            if (measured.view) {
                measured.view->work = std::move(work->pixels);
            }
        }
        return {};
    }

    session::SceneRenderer& renderer_of(const Entry& entry, session::SceneRenderer& driver) {
        return entry.by_rays ? rays_->renderer() : driver;
    }

    // Of the last frame with the same setting.
    [[nodiscard]] std::optional<double> frame_seconds(const Entry& entry) const {
        const auto known = frame_seconds_.find(entry.row.setting.label);
        return known == frame_seconds_.end() ? std::nullopt : std::optional(known->second);
    }

    Result<void> time_all(std::vector<Entry> entries, BenchmarkScene& scene,
                          session::SceneRenderer& driver, MeasureOptions timing) {
        std::optional<MovingView> moving;
        if (options_.moving) {
            moving.emplace(scene.scene().camera(), scene.bounds(),
                           [&](double x, double y) { return scene.ground(x, y); });
        }
        std::vector<DrawFrame> frames;
        frames.reserve(entries.size());
        for (Entry& entry : entries) {
            frames.push_back(frame_of(entry, scene, renderer_of(entry, driver), moving));
        }
        const std::size_t repeated = repeated_entry(entries);
        timing.null_pair = {repeated, frames.size() - 1};
        auto measurement = measure(frames, timing);
        if (measurement && lacks_a_round(*measurement)) {
            measurement = measure(frames, one_round());
        }
        if (!measurement) {
            return measurement.error();
        }
        if (moving) {
            scene.set_camera(moving->at(0));
        }
        keep_rows(std::move(entries), *measurement, noise_floor_of(*measurement, repeated));
        return {};
    }

    void keep_rows(std::vector<Entry> entries, const Measurement& measurement,
                   std::optional<double> noise_floor) {
        const bool has_ratios = !entries.front().row.shows_nothing();
        const double texture = median(measurement.ms.front());
        for (std::size_t i = 0; i < entries.size(); ++i) {
            Entry& entry = entries[i];
            const std::vector<double>& ms = measurement.ms[i];
            Timing timing = timed(ms, noise_floor);
            if (has_ratios) {
                timing.ratio_to_texture = timing.ms.median / texture;
            }
            if (!is_software_) {
                timing.gpu_ms = median(std::span(entry.gpu_ms).last(ms.size()));
            }
            timing.stats = entry.stats;
            entry.row.timing = timing;
            results_.rows.push_back(std::move(entry.row));
        }
    }

    void note_left_out(const Group& group, const std::string& scene, std::span<const Row> rows) {
        LeftOut left_out = left_out_of(group, scene, rows);
        if (left_out.settings > 0) {
            results_.notes.push_back(
                left_out_note(left_out, group.candidates.size(), stop_.stop_requested()));
            results_.left_out.push_back(std::move(left_out));
        }
    }

    Results& results_;
    const Suite& suite_;
    const SuiteOptions& options_;
    std::stop_token stop_;
    Stopwatch since_begin_;
    Stopwatch since_group_;
    BenchmarkScenes scenes_;
    RowViews views_;
    std::optional<session::Device> rays_;
    bool is_software_ = true;
    std::map<std::string, double> frame_seconds_; // by label
    std::set<std::string> shared_names_;
    std::vector<SceneChoice> left_out_; // scenes that cannot be opened
    Problems problems_;
};

} // namespace

std::vector<Candidate> candidates_of(const std::vector<scene::Technique>& techniques) {
    const scene::Technique texture{scene::Texture{}};
    std::vector<Candidate> candidates{{texture}};
    for (const scene::Technique& technique : techniques) {
        if (technique != texture) {
            candidates.push_back({technique});
        }
    }
    return candidates;
}

Results run_suite(const Suite& suite, const SuiteOptions& options, const std::stop_token& stop) {
    Results results;
    const bool has_rays = options.context == session::BackendKind::cpu;
    const Suite measured = has_rays ? with_rays(suite) : suite;
    const auto done = SuiteRun(results, measured, options, stop).run();
    if (stop.stop_requested()) {
        results.stopped =
            Error{results.rows.empty() ? "interrupted before the first frame was timed"
                                       : "interrupted, the table holds the frames drawn "
                                         "until then"};
    } else if (!done) {
        results.stopped = done.error();
        results.failed = results.rows.empty();
    }
    return results;
}

} // namespace reljef::bench

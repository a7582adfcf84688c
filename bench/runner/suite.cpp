#include "bench/runner/suite.h"

#include <algorithm>
#include <map>
#include <set>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/progress_line.h"
#include "bench/runner/measure.h"
#include "bench/runner/row_error.h"
#include "bench/runner/time_table.h"
#include "engine/core/stopwatch.h"

namespace reljef::bench {
namespace {

// One thing drawn; what its last frame drew.
struct Entry {
    Row row;
    std::optional<scene::Technique> technique;
    view::FrameStats stats{};
    std::vector<double> gpu_ms{}; // of every frame
};

// Tells the progress of all groups from that of each.
class SuiteProgress {
public:
    SuiteProgress(std::string_view label, std::size_t groups, const SuiteOptions& options)
        : line_(fmt::format("measuring {}", label), options.quiet), progress_(options.progress),
          groups_(static_cast<double>(groups)), judging_(options.quick ? 0.7 : 0.2) {}

    void begin_group(std::size_t index) { index_ = static_cast<double>(index); }
    void report_judged(double fraction) { report(judging_ * fraction); }
    void report_timed(double fraction) { report(std::lerp(judging_, 1.0, fraction)); }

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
    double judging_; // the share of a group's time, about
    double index_ = 0.0;
};

std::vector<Entry> entries_of(const Group& group, std::string_view suite, const std::string& scene,
                              glm::ivec2 size) {
    check(!group.candidates.empty() && group.candidates.front().technique.has_value(),
          "a group does not begin with texture");
    std::vector<Entry> entries;
    for (const Candidate& candidate : group.candidates) {
        Row row;
        row.suite = suite;
        row.test = group.test;
        row.scene = scene;
        row.pose = group.pose;
        row.setting = candidate.setting;
        row.size = size;
        row.source = candidate.source;
        entries.push_back({std::move(row), candidate.technique});
    }
    return entries;
}

// What is drawn twice for the noise floor: the first that shows some of the terrain, as the time of
// others says nothing; texture where none does.
std::size_t drawn_twice(std::span<const Entry> entries) {
    const auto first = std::find_if(entries.begin(), entries.end(), [](const Entry& entry) {
        return entry.technique && !entry.row.shows_nothing();
    });
    return first == entries.end() ? 0 : static_cast<std::size_t>(first - entries.begin());
}

// It again last.
std::vector<Entry> ended_by_null_row(std::vector<Entry> entries) {
    if (!entries.empty()) {
        const Entry& twice = entries[drawn_twice(entries)];
        Entry null_entry{twice.row, twice.technique};
        null_entry.row.null_row = true;
        null_entry.row.source.reset();
        null_entry.row.view.reset();
        entries.push_back(std::move(null_entry));
    }
    return entries;
}

DrawFrame frame_of(Entry& entry, BenchmarkScene& scene, session::SceneRenderer& driver) {
    return [&]() -> Result<void> {
        scene.set_technique(*entry.technique);
        auto stats = driver.draw(scene.scene(), true);
        if (!stats) {
            return stats.error();
        }
        entry.stats = *stats;
        entry.gpu_ms.push_back(stats->gpu_ms);
        return {};
    };
}

// So that what was judged is not lost when the run is stopped before all was drawn once.
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

// Absent where what is drawn twice, as one thing and as the last, has few frames.
std::optional<double> noise_floor_of(const Measurement& measurement, std::size_t twice) {
    const bool is_reliable =
        std::min(measurement.ms[twice].size(), measurement.ms.back().size()) >= min_frames;
    return is_reliable ? measurement.noise_floor : std::nullopt;
}

Timing timing_of(const std::vector<double>& ms, std::optional<double> noise_floor) {
    Timing timing;
    timing.frames = ms.size();
    timing.ms = summarize(ms);
    timing.fps_1_percent_low = 1000.0 / mean_of_largest(ms, 0.01);
    if (ms.size() >= min_frames) {
        timing.interval = median_interval(ms);
        timing.noise_floor = noise_floor;
    }
    return timing;
}

bool has_row_of(const Candidate& candidate, std::span<const Row> rows) {
    return std::any_of(rows.begin(), rows.end(), [&](const Row& row) {
        return row.setting.label == candidate.setting.label;
    });
}

// The candidates that are none of the rows.
LeftOut left_out_of(const Group& group, const std::string& scene, std::span<const Row> rows) {
    LeftOut left_out{scene, group.pose, 0, {}};
    std::set<std::string> begun; // techniques
    for (const Candidate& candidate : group.candidates) {
        const bool is_first = begun.insert(candidate.setting.technique).second;
        if (!has_row_of(candidate, rows)) {
            ++left_out.settings;
            if (is_first) {
                left_out.techniques.push_back(candidate.setting.technique);
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

// Measures one suite on one device.
class SuiteRun {
public:
    SuiteRun(const Suite& suite, const SuiteOptions& options, std::stop_token stop)
        : suite_(suite), options_(options), stop_(std::move(stop)),
          scenes_({options.size, options.threads, options.quiet}, stop_, suite.keep_scenes),
          views_(suite.max_view_cols) {}

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
        results_.environment = environment_of(device->context(), options_.threads);
        is_software_ = device->context().is_software();
        if (auto opened = open_stages(); !opened) {
            return opened;
        }
        SuiteProgress progress(suite_.name, suite_.groups.size(), options_);
        for (std::size_t i = 0; i < suite_.groups.size() && !stop_.stop_requested(); ++i) {
            progress.begin_group(i);
            if (auto done = run_group(i, device->renderer(), progress); !done) {
                return done;
            }
        }
        return {};
    }

    Results take() { return std::move(results_); }

private:
    // That of its scene; where several have it, the path.
    [[nodiscard]] const std::string& name_of(const Group& group,
                                             const BenchmarkScene& scene) const {
        return shared_names_.contains(scene.name()) ? group.scene.terrain : scene.name();
    }

    // All of them, so that a mistake in the last does not cost the time of measuring the others.
    Result<void> open_stages() {
        for (const Group& group : suite_.groups) {
            if (suite_.keep_scenes) {
                const auto scene = scenes_.get(group.scene);
                if (!scene) {
                    return scene.error();
                }
                const std::string& name = (*scene)->name();
                const auto first = owners_.emplace(name, group.scene).first;
                if (first->second != group.scene) {
                    shared_names_.insert(name);
                }
            }
        }
        return {};
    }

    Result<void> run_group(std::size_t index, session::SceneRenderer& driver,
                           SuiteProgress& progress) {
        const Group& group = suite_.groups[index];
        const std::size_t left = suite_.groups.size() - index;
        const double seconds = group_seconds(options_, since_begin_.seconds(), left);
        since_group_ = Stopwatch();
        driver.forget_scene();
        const auto scene = scenes_.get(group.scene);
        if (!scene) {
            return scene.error();
        }
        (*scene)->set_pose(group.pose);
        const std::string& name = name_of(group, **scene);
        auto entries = judge_all(entries_of(group, suite_.name, name, options_.size), seconds,
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

    // Those there is time for in `seconds`, where any may be left out, but texture at any rate, and
    // its null row; where the run is stopped, those that are judged by then.
    Result<std::vector<Entry>> judge_all(std::vector<Entry> entries, double seconds,
                                         BenchmarkScene& scene, session::SceneRenderer& driver,
                                         SuiteProgress& progress) {
        std::vector<Entry> kept;
        GroupCost cost;
        const std::size_t count = entries.size();
        for (std::size_t i = 0; i < count && !stop_.stop_requested(); ++i) {
            const bool may_leave_out = suite_.may_leave_out && i > 0 && entries[i].technique;
            cost.elapsed = since_group_.seconds();
            if (may_leave_out && !fits(with_another(cost, frame_seconds(entries[i])), seconds)) {
                continue;
            }
            auto after = judge_one(entries[i], cost, scene, driver);
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
            progress.report_judged(static_cast<double>(i + 1) / static_cast<double>(count));
        }
        return ended_by_null_row(std::move(kept));
    }

    // What the group has cost then. Missing techniques cost nothing.
    Result<GroupCost> judge_one(Entry& entry, const GroupCost& cost, BenchmarkScene& scene,
                                session::SceneRenderer& driver) {
        if (!entry.technique) {
            return cost;
        }
        const bool is_texture = cost.frames == 0;
        const Stopwatch since_begin;
        auto judgement =
            judge(scene, *entry.technique, driver,
                  {static_cast<unsigned>(options_.threads), options_.keep_views, stop_});
        if (!judgement) {
            return judgement.error();
        }
        entry.row.error = judgement->error;
        if (auto kept = keep_view(entry.row, judgement->view); !kept) {
            return kept.error();
        }
        const Stopwatch since_judged;
        if (auto drawn = frame_of(entry, scene, driver)(); !drawn) {
            return drawn.error();
        }
        const double frame = since_judged.seconds();
        frame_seconds_[entry.row.setting.label] = frame;
        const int frames = is_texture ? 2 : 1; // its null row
        return GroupCost{
            since_group_.seconds(), is_texture ? 0.0 : cost.judging + since_begin.seconds(),
            is_texture ? 0 : cost.judged + 1, cost.round + frames * frame, cost.frames + frames};
    }

    // As the run drew it last.
    [[nodiscard]] std::optional<double> frame_seconds(const Entry& entry) const {
        const auto known = frame_seconds_.find(entry.row.setting.label);
        return known == frame_seconds_.end() ? std::nullopt : std::optional(known->second);
    }

    Result<void> keep_view(Row& row, const std::optional<ShownView>& shown) {
        if (shown) {
            auto view = views_.make(*shown);
            if (!view) {
                return view.error();
            }
            row.view = std::move(*view);
        }
        return {};
    }

    Result<void> time_all(std::vector<Entry> entries, BenchmarkScene& scene,
                          session::SceneRenderer& driver, MeasureOptions timing) {
        std::vector<DrawFrame> frames;
        std::size_t twice = 0; // of the frames
        for (std::size_t i = 0; i < entries.size(); ++i) {
            twice = i == drawn_twice(entries) ? frames.size() : twice;
            if (entries[i].technique) {
                frames.push_back(frame_of(entries[i], scene, driver));
            }
        }
        timing.null_pair = {twice, frames.size() - 1};
        auto measurement = measure(frames, timing);
        if (measurement && lacks_a_round(*measurement)) {
            measurement = measure(frames, one_round());
        }
        if (!measurement) {
            return measurement.error();
        }
        keep_rows(std::move(entries), *measurement, noise_floor_of(*measurement, twice));
        return {};
    }

    void keep_rows(std::vector<Entry> entries, const Measurement& measurement,
                   std::optional<double> noise_floor) {
        const bool has_measure = !entries.front().row.shows_nothing();
        const double texture = median(measurement.ms.front());
        std::size_t place = 0;
        for (Entry& entry : entries) {
            if (entry.technique) {
                const std::vector<double>& ms = measurement.ms[place++];
                Timing timing = timing_of(ms, noise_floor);
                if (has_measure) {
                    timing.ratio_to_texture = timing.ms.median / texture;
                }
                if (!is_software_) {
                    timing.gpu_ms = median(std::span(entry.gpu_ms).last(ms.size()));
                }
                timing.stats = entry.stats;
                entry.row.timing = timing;
            }
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

    const Suite& suite_;
    const SuiteOptions& options_;
    std::stop_token stop_;
    Stopwatch since_begin_;
    Stopwatch since_group_;
    BenchmarkScenes scenes_;
    RowViews views_;
    bool is_software_ = true;
    std::map<std::string, double> frame_seconds_; // by label
    std::map<std::string, SceneChoice> owners_;   // by name, the first that has it
    std::set<std::string> shared_names_;
    Results results_;
};

} // namespace

Candidate candidate_of(const scene::Technique& technique) {
    return {setting_of(technique), technique, std::nullopt};
}

std::vector<Candidate> candidates_of(const std::vector<scene::Technique>& techniques) {
    const scene::Technique texture{scene::Texture{}};
    std::vector<Candidate> candidates{candidate_of(texture)};
    for (const scene::Technique& technique : techniques) {
        if (technique != texture) {
            candidates.push_back(candidate_of(technique));
        }
    }
    return candidates;
}

Results run_suite(const Suite& suite, const SuiteOptions& options, const std::stop_token& stop) {
    SuiteRun run(suite, options, stop);
    const auto done = run.run();
    Results results = run.take();
    if (stop.stop_requested()) {
        results.stopped =
            Error{results.rows.empty() ? "interrupted before the first frame was timed"
                                       : "interrupted, the table holds the frames drawn "
                                         "until then"};
    } else if (!done) {
        results.stopped = done.error();
        results.failed = true;
    }
    return results;
}

} // namespace reljef::bench

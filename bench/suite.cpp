#include "bench/suite.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <limits>

#include <fmt/format.h>

#include "app/device.h"
#include "app/progress_line.h"
#include "bench/measure.h"
#include "bench/row_error.h"

namespace reljef::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double seconds_a_group = 20.0;
constexpr double noisy_seconds_a_group = 60.0;
constexpr int most_rounds = 2000;
constexpr double quick_seconds = 10.0; // of measuring, all groups together
constexpr int most_quick_rounds = 200;
constexpr double quick_limit = 48.0; // seconds for all of it, a slow machine's reserve left out

// One thing drawn; what its last frame drew.
struct Entry {
    Row row;
    std::optional<scene::Technique> technique;
    render::FrameStats stats{};
};

// A parameter of a technique that does not exist yet; one that is no number is left out.
std::optional<Setting::Parameter> parameter_named(std::string_view text) {
    const auto equals = std::min(text.find('='), text.size());
    const std::string_view digits = text.substr(std::min(equals + 1, text.size()));
    double value = 0.0;
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return code == std::errc{} && end == digits.data() + digits.size()
               ? std::optional(Setting::Parameter{std::string(text.substr(0, equals)), value})
               : std::nullopt;
}

Setting setting_named(const std::string& text) {
    const auto colon = std::min(text.find(':'), text.size());
    Setting setting{text.substr(0, colon), {}, text};
    for (std::size_t begin = colon + 1; begin < text.size();) {
        const auto end = std::min(text.find(',', begin), text.size());
        if (auto parameter = parameter_named(std::string_view(text).substr(begin, end - begin))) {
            setting.parameters.push_back(std::move(*parameter));
        }
        begin = end + 1;
    }
    return setting;
}

// Shares the time of a run among its groups.
class TimeTable {
public:
    TimeTable(const SuiteOptions& options, std::size_t groups)
        : options_(options), groups_(static_cast<double>(groups)) {}

    // Until the next group must have judged its candidates, when `left` groups are left, this one
    // among them: half of its time.
    [[nodiscard]] Clock::time_point judging_ends(std::size_t left) const {
        const bool is_bounded = options_.quick && options_.rounds == 0;
        const std::chrono::duration<double> share(0.5 * seconds_left() / static_cast<double>(left));
        return is_bounded ? Clock::now() + std::chrono::duration_cast<Clock::duration>(share)
                          : Clock::time_point::max();
    }

    // Of the next group, when `left` are left, this one among them.
    [[nodiscard]] MeasureOptions next(std::size_t left) const {
        MeasureOptions measure;
        measure.most_noise = most_noise;
        measure.most_rounds = most_rounds;
        measure.seconds = seconds_a_group;
        measure.noisy_seconds = noisy_seconds_a_group;
        if (options_.quick) {
            measure.warm_up_rounds = 1;
            measure.most_rounds = most_quick_rounds;
            measure.seconds = quick_seconds / groups_;
            measure.noisy_seconds = 2.0 * measure.seconds;
            measure.most_seconds = seconds_left() / static_cast<double>(left);
        }
        if (options_.rounds > 0) {
            measure.least_rounds = options_.rounds;
            measure.most_rounds = options_.rounds;
            measure.seconds = 0.0;
            measure.most_seconds = std::numeric_limits<double>::infinity();
        }
        return measure;
    }

private:
    [[nodiscard]] double seconds_left() const {
        return quick_limit - std::chrono::duration<double>(Clock::now() - begin_).count();
    }

    const SuiteOptions& options_;
    double groups_;
    Clock::time_point begin_ = Clock::now();
};

// Tells the progress of all groups from that of each.
class SuiteProgress {
public:
    SuiteProgress(std::string_view label, std::size_t groups, const SuiteOptions& options)
        : line_(fmt::format("measuring {}", label), options.quiet),
          groups_(static_cast<double>(groups)), judging_(options.quick ? 0.7 : 0.2) {}

    void begin_group(std::size_t index) { index_ = static_cast<double>(index); }
    void tell_judged(double fraction) { line_.update((index_ + judging_ * fraction) / groups_); }
    void tell_timed(double fraction) {
        line_.update((index_ + std::lerp(judging_, 1.0, fraction)) / groups_);
    }

private:
    app::ProgressLine line_;
    double groups_;
    double judging_; // the share of a group's time, about
    double index_ = 0.0;
};

Result<app::Device> make_device(const SuiteOptions& options) {
    app::DeviceOptions device;
    device.threads = options.threads;
    device.context = options.context;
    device.context_options.size = options.size;
    device.context_options.visible = false;
    device.driver.size = options.size;
    device.driver.shader_dir = options.shader_dir;
    return app::Device::create(device);
}

// Texture again last: the null row.
std::vector<Entry> entries_of(const Group& group, std::string_view suite, const Stage& stage,
                              glm::ivec2 size) {
    check(!group.candidates.empty() && group.candidates.front().technique.has_value(),
          "a group does not begin with texture");
    std::vector<Entry> entries;
    for (const Candidate& candidate : group.candidates) {
        Row row;
        row.suite = suite;
        row.test = group.test;
        row.scene = stage.name();
        row.pose = group.pose;
        row.setting = candidate.setting;
        row.size = size;
        row.source = candidate.source;
        entries.push_back({std::move(row), candidate.technique});
    }
    Entry null_entry = entries.front();
    null_entry.row.null_row = true;
    null_entry.row.source.reset();
    entries.push_back(std::move(null_entry));
    return entries;
}

DrawFrame frame_of(Entry& entry, Stage& stage, render::Driver& driver) {
    return [&]() -> Result<void> {
        stage.set_technique(*entry.technique);
        auto stats = driver.draw(stage.scene(), true);
        if (!stats) {
            return stats.error();
        }
        entry.stats = *stats;
        return {};
    };
}

// Measures one suite on one device.
class SuiteRun {
public:
    SuiteRun(const Suite& suite, const SuiteOptions& options, std::stop_token stop)
        : suite_(suite), options_(options), stop_(std::move(stop)),
          time_table_(options, suite.groups.size()),
          stages_({options.size, options.threads, options.quiet}, stop_, suite.keep_stages) {}

    Result<void> run() {
        auto device = make_device(options_);
        if (!device) {
            return device.error();
        }
        results_.environment = environment_of(device->context(), options_.threads);
        if (auto opened = open_stages(); !opened) {
            return opened;
        }
        SuiteProgress progress(suite_.name, suite_.groups.size(), options_);
        for (std::size_t i = 0; i < suite_.groups.size() && !stop_.stop_requested(); ++i) {
            progress.begin_group(i);
            if (auto done = run_group(i, device->driver(), progress); !done) {
                return done;
            }
        }
        return {};
    }

    Results take() { return std::move(results_); }

private:
    // All of them, so that a mistake in the last does not cost the time of measuring the others.
    Result<void> open_stages() {
        for (const Group& group : suite_.groups) {
            if (suite_.keep_stages) {
                if (auto stage = stages_.get(group.stage); !stage) {
                    return stage.error();
                }
            }
        }
        return {};
    }

    Result<void> run_group(std::size_t index, render::Driver& driver, SuiteProgress& progress) {
        const Group& group = suite_.groups[index];
        const auto stage = stages_.get(group.stage);
        if (!stage) {
            return stage.error();
        }
        (*stage)->set_pose(group.pose);
        std::vector<Entry> entries = entries_of(group, suite_.name, **stage, options_.size);
        const std::size_t left = suite_.groups.size() - index;
        const Clock::time_point end = time_table_.judging_ends(left);
        if (auto judged = judge_all(entries, end, **stage, driver, progress); !judged) {
            return judged;
        }
        MeasureOptions measuring = time_table_.next(left);
        measuring.stop = stop_;
        measuring.progress = [&](double fraction) { progress.tell_timed(fraction); };
        return time_all(entries, **stage, driver, std::move(measuring));
    }

    // Leaves out what there is no time for before `end`, where that is allowed, but not texture.
    Result<void> judge_all(std::vector<Entry>& entries, Clock::time_point end, Stage& stage,
                           render::Driver& driver, SuiteProgress& progress) {
        const JudgeOptions options{static_cast<unsigned>(options_.threads), options_.keep_views,
                                   stop_};
        const std::size_t count = entries.size() - 1;
        for (std::size_t i = 0; i < count; ++i) {
            if (suite_.may_leave_out && i > 0 && Clock::now() >= end) {
                leave_out(entries, i, stage.name());
                break;
            }
            if (entries[i].technique) {
                auto judgement = judge(stage, *entries[i].technique, driver, options);
                if (!judgement) {
                    return judgement.error();
                }
                entries[i].row.error = judgement->error;
                entries[i].row.view = std::move(judgement->view);
            }
            progress.tell_judged(static_cast<double>(i + 1) / static_cast<double>(count));
        }
        entries.back().row.error = entries.front().row.error;
        return {};
    }

    // All from `first` on, but the null row.
    void leave_out(std::vector<Entry>& entries, std::size_t first, const std::string& stage) {
        results_.notes.push_back(
            fmt::format("{}, {}: {} of {} settings left out, there was no time for them", stage,
                        scene::to_string(entries.front().row.pose), entries.size() - 1 - first,
                        entries.size() - 1));
        entries.erase(entries.begin() + static_cast<std::ptrdiff_t>(first), entries.end() - 1);
    }

    Result<void> time_all(std::vector<Entry>& entries, Stage& stage, render::Driver& driver,
                          MeasureOptions measuring) {
        std::vector<DrawFrame> frames;
        for (Entry& entry : entries) {
            if (entry.technique) {
                frames.push_back(frame_of(entry, stage, driver));
            }
        }
        measuring.null_pair = {0, frames.size() - 1};
        const auto measurement = measure(frames, measuring);
        if (!measurement) {
            return measurement.error();
        }
        keep_rows(std::move(entries), *measurement);
        return {};
    }

    // Every row that has a frame, and the missing ones; none where texture has no frame.
    void keep_rows(std::vector<Entry> entries, const Measurement& measurement) {
        if (measurement.ms.front().empty()) {
            return;
        }
        const double texture = median(measurement.ms.front());
        std::size_t place = 0;
        for (Entry& entry : entries) {
            if (entry.technique) {
                const std::vector<double>& ms = measurement.ms[place++];
                if (ms.empty()) {
                    continue;
                }
                entry.row.timing = timing_of(ms, texture, measurement.noise_floor);
                entry.row.timing->stats = entry.stats;
            }
            results_.rows.push_back(std::move(entry.row));
        }
    }

    static Timing timing_of(const std::vector<double>& ms, double texture,
                            std::optional<double> noise_floor) {
        Timing timing;
        timing.frames = ms.size();
        timing.ms = summarize(ms);
        timing.interval = median_interval(ms);
        timing.fps_1_percent_low = 1000.0 / mean_of_largest(ms, 0.01);
        timing.ratio_to_texture = timing.ms.median / texture;
        timing.noise_floor = noise_floor;
        return timing;
    }

    const Suite& suite_;
    const SuiteOptions& options_;
    std::stop_token stop_;
    TimeTable time_table_;
    Stages stages_;
    Results results_;
};

} // namespace

Candidate candidate_of(const scene::Technique& technique) {
    return {setting_of(technique), technique, std::nullopt};
}

Candidate candidate_named(const std::string& text) {
    const auto technique = scene::parse_technique(text);
    return technique ? candidate_of(*technique)
                     : Candidate{setting_named(text), std::nullopt, std::nullopt};
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
    }
    return results;
}

} // namespace reljef::bench

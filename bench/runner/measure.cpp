#include "bench/runner/measure.h"

#include <algorithm>

#include "engine/core/check.h"
#include "engine/core/statistics.h"
#include "engine/core/stopwatch.h"

namespace reljef::bench {
namespace {

class Rounds {
public:
    Rounds(std::span<const DrawFrame> frames, const MeasureOptions& options)
        : frames_(frames), options_(options),
          now_ms_(options.now_ms ? options.now_ms
                                 : [watch = Stopwatch()] { return watch.milliseconds(); }),
          begin_ms_(now_ms_()) {
        result_.ms.resize(frames.size());
    }

    Result<void> warm_up() {
        for (int round = 0; round < options_.warm_up_rounds; ++round) {
            for (std::size_t i = 0; i < frames_.size() && !stopped(); ++i) {
                if (auto drawn = frames_[i](); !drawn) {
                    return drawn;
                }
                report_progress(now_ms_());
            }
        }
        warm_up_seconds_ = seconds_until(now_ms_());
        return {};
    }

    Result<void> time_all() {
        for (int round = 0; !enough(round); ++round) {
            for (std::size_t i = 0; i < frames_.size() && !stopped(); ++i) {
                if (auto drawn = time_one(i); !drawn) {
                    return drawn;
                }
            }
        }
        return {};
    }

    Measurement take() {
        result_.noise_floor = noise_floor();
        return std::move(result_);
    }

private:
    bool stopped() {
        result_.stopped = result_.stopped || options_.stop.stop_requested();
        return result_.stopped;
    }

    Result<void> time_one(std::size_t index) {
        const double begin = now_ms_();
        auto drawn = frames_[index]();
        const double end = now_ms_();
        result_.ms[index].push_back(end - begin);
        report_progress(end);
        return drawn;
    }

    bool enough(int rounds) {
        if (rounds == 0 || stopped()) {
            return stopped();
        }
        const double elapsed = seconds_until(now_ms_());
        const double timed = elapsed - *warm_up_seconds_;
        const bool has_minimum = rounds >= options_.min_rounds && timed >= options_.seconds;
        return rounds >= options_.max_rounds || elapsed + timed / rounds > options_.max_seconds ||
               (has_minimum && (timed >= options_.noisy_seconds || is_quiet(rounds)));
    }

    bool is_quiet(int rounds) {
        if (!options_.null_pair) {
            return true;
        }
        if (rounds < next_check_) {
            return false;
        }
        next_check_ = rounds + std::max(rounds / 4, 1);
        return *noise_floor() <= options_.max_noise;
    }

    [[nodiscard]] std::optional<double> noise_floor() const {
        if (!options_.null_pair || result_.ms[options_.null_pair->first].empty() ||
            result_.ms[options_.null_pair->second].empty()) {
            return std::nullopt;
        }
        return relative_distance(median(result_.ms[options_.null_pair->first]),
                                 median(result_.ms[options_.null_pair->second]));
    }

    void report_progress(double now) {
        ++frames_drawn_;
        if (options_.progress) {
            const double elapsed = seconds_until(now);
            const double expected = expected_seconds(elapsed);
            const double fraction = expected > 0.0 ? elapsed / expected : 0.0;
            fraction_ = std::clamp(fraction, fraction_, 1.0);
            options_.progress(fraction_);
        }
    }

    // Of the whole measurement, if frames keep their mean time.
    [[nodiscard]] double expected_seconds(double elapsed) const {
        const double round = elapsed * static_cast<double>(frames_.size()) / frames_drawn_;
        const double warm_up = warm_up_seconds_.value_or(options_.warm_up_rounds * round);
        const double min = (options_.warm_up_rounds + options_.min_rounds) * round;
        const double max = (options_.warm_up_rounds + options_.max_rounds) * round;
        return std::min({std::max(min, warm_up + options_.seconds), max, options_.max_seconds});
    }

    [[nodiscard]] double seconds_until(double now) const { return 1e-3 * (now - begin_ms_); }

    std::span<const DrawFrame> frames_;
    const MeasureOptions& options_;
    std::function<double()> now_ms_;
    Measurement result_;
    double begin_ms_;
    std::optional<double> warm_up_seconds_; // absent during the warm-up
    int frames_drawn_ = 0;
    int next_check_ = 0; // round of the next noise check
    double fraction_ = 0.0;
};

} // namespace

Result<Measurement> measure(std::span<const DrawFrame> frames, const MeasureOptions& options) {
    check(!frames.empty(), "nothing to measure");
    check(options.min_rounds >= 1 && options.max_rounds >= options.min_rounds,
          "measuring needs a round");
    check(!options.null_pair ||
              std::max(options.null_pair->first, options.null_pair->second) < frames.size(),
          "a null pair that is not drawn");
    Rounds rounds(frames, options);
    if (auto warm = rounds.warm_up(); !warm) {
        return warm.error();
    }
    if (auto timed = rounds.time_all(); !timed) {
        return timed.error();
    }
    return rounds.take();
}

} // namespace reljef::bench

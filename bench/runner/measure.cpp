#include "bench/runner/measure.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include "engine/core/check.h"
#include "engine/core/statistics.h"

namespace reljef::bench {
namespace {

double steady_now_ms() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(now).count();
}

// Draws frames in turn and writes down what each took.
class Rounds {
public:
    Rounds(std::span<const DrawFrame> frames, const MeasureOptions& options)
        : frames_(frames), options_(options),
          now_ms_(options.now_ms ? options.now_ms : steady_now_ms), begin_ms_(now_ms_()) {
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
        const bool has_the_least = rounds >= options_.min_rounds && timed >= options_.seconds;
        return rounds >= options_.max_rounds || elapsed + timed / rounds > options_.max_seconds ||
               (has_the_least && (timed >= options_.noisy_seconds || is_quiet(rounds)));
    }

    // Precondition: a round is done.
    bool is_quiet(int rounds) {
        if (!options_.null_pair) {
            return true;
        }
        if (rounds < ask_at_round_) {
            return false;
        }
        ask_at_round_ = rounds + std::max(rounds / 4, 1);
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
            fraction_ = std::clamp(elapsed / expected_seconds(elapsed), fraction_, 1.0);
            options_.progress(fraction_);
        }
    }

    // Of all of it, if frames go on taking what they took so far.
    [[nodiscard]] double expected_seconds(double elapsed) const {
        const double round = elapsed * static_cast<double>(frames_.size()) / frames_drawn_;
        const double warm_up = warm_up_seconds_.value_or(options_.warm_up_rounds * round);
        const double least = (options_.warm_up_rounds + options_.min_rounds) * round;
        const double most = (options_.warm_up_rounds + options_.max_rounds) * round;
        return std::min({std::max(least, warm_up + options_.seconds), most, options_.max_seconds});
    }

    [[nodiscard]] double seconds_until(double now) const { return 1e-3 * (now - begin_ms_); }

    std::span<const DrawFrame> frames_;
    const MeasureOptions& options_;
    std::function<double()> now_ms_;
    Measurement result_;
    double begin_ms_;
    std::optional<double> warm_up_seconds_; // once it is over
    int frames_drawn_ = 0;
    int ask_at_round_ = 0; // how noisy it is
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

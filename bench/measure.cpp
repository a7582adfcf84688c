#include "bench/measure.h"

#include <algorithm>
#include <chrono>

#include "engine/core/check.h"

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
          now_ms_(options.now_ms ? options.now_ms : steady_now_ms) {
        result_.ms.resize(frames.size());
    }

    Result<void> warm_up() {
        for (int round = 0; round < options_.warm_up_rounds; ++round) {
            for (std::size_t i = 0; i < frames_.size() && !stopped(); ++i) {
                if (auto drawn = frames_[i](); !drawn) {
                    return drawn;
                }
            }
        }
        return {};
    }

    Result<void> time_all() {
        begin_ms_ = now_ms_();
        for (int round = 0; !enough(round); ++round) {
            for (std::size_t i = 0; i < frames_.size() && !stopped(); ++i) {
                if (auto drawn = time_one(i); !drawn) {
                    return drawn;
                }
            }
        }
        return {};
    }

    Measurement take() { return std::move(result_); }

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
        ++frames_drawn_;
        if (options_.progress) {
            options_.progress(fraction_done(end));
        }
        return drawn;
    }

    bool enough(int rounds) {
        return stopped() || rounds >= options_.most_rounds ||
               (rounds >= options_.least_rounds &&
                seconds_since_begin(now_ms_()) >= options_.seconds);
    }

    // Both the least rounds and the time have to be reached, or else the most rounds.
    [[nodiscard]] double fraction_done(double now) const {
        const double rounds =
            static_cast<double>(frames_drawn_) / static_cast<double>(frames_.size());
        const double of_time =
            options_.seconds > 0.0 ? seconds_since_begin(now) / options_.seconds : 1.0;
        const double of_least = std::min(rounds / options_.least_rounds, of_time);
        return std::min(std::max(of_least, rounds / options_.most_rounds), 1.0);
    }

    [[nodiscard]] double seconds_since_begin(double now) const { return 1e-3 * (now - begin_ms_); }

    std::span<const DrawFrame> frames_;
    const MeasureOptions& options_;
    std::function<double()> now_ms_;
    Measurement result_;
    double begin_ms_ = 0.0;
    std::size_t frames_drawn_ = 0;
};

} // namespace

Result<Measurement> measure(std::span<const DrawFrame> frames, const MeasureOptions& options) {
    check(!frames.empty(), "nothing to measure");
    check(options.least_rounds >= 1 && options.most_rounds >= options.least_rounds,
          "measuring needs a round");
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

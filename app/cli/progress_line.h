#pragma once

#include <chrono>
#include <string>

#include "engine/core/parallel_for.h"

namespace reljef::cli {

/// Shows how far a long operation has come, on stderr: one line that is drawn anew on a terminal, a
/// line a quarter elsewhere. Says nothing in the first half second, so that short work stays
/// silent.
class ProgressLine {
public:
    explicit ProgressLine(std::string label, bool quiet = false);
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    ~ProgressLine();

    /// `fraction` in [0,1]; any thread, one at a time.
    void update(double fraction);
    /// For options that take a Progress; valid as long as this line.
    [[nodiscard]] Progress callback();

private:
    std::string label_;
    bool quiet_;
    bool terminal_;
    std::chrono::steady_clock::time_point start_;
    std::chrono::steady_clock::time_point shown_at_;
    int shown_quarter_ = 0;
    bool shown_ = false;
};

} // namespace reljef::cli

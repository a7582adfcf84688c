#pragma once

#include <chrono>
#include <string>

#include "engine/session/log.h"

namespace reljef::cli {

/// Shows progress on stderr: one updated line on a terminal, else a line per quarter. Shows nothing
/// in the first half second.
class ProgressLine : public session::Task {
public:
    explicit ProgressLine(std::string label, bool quiet = false);
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    ~ProgressLine() override;

    void update(double fraction) override;

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

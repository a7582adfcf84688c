#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "engine/core/back_off.h"

namespace reljef::io {

/// Files that fail again and again: they are passed over for a while, so that not every tile waits
/// for them. Safe from several threads at a time.
class FailingFiles {
public:
    /// Of BackOff's pauses the first.
    explicit FailingFiles(std::chrono::milliseconds first_pause = BackOff::usual_first_pause)
        : first_pause_(first_pause) {}

    void note(const std::filesystem::path& path, std::string message) {
        const std::lock_guard lock(mutex_);
        Failures& failures =
            failures_.try_emplace(path, Failures{BackOff(first_pause_), {}}).first->second;
        failures.back_off.fail(BackOff::Clock::now());
        failures.message = std::move(message);
    }
    void forget(const std::filesystem::path& path) {
        const std::lock_guard lock(mutex_);
        failures_.erase(path);
    }
    /// Whether it has since it was last forgotten.
    [[nodiscard]] bool has_failed(const std::filesystem::path& path) const {
        const std::lock_guard lock(mutex_);
        return failures_.contains(path);
    }
    /// What was wrong with a file that is given up for now, else nothing.
    [[nodiscard]] std::optional<std::string> given_up(const std::filesystem::path& path) const {
        const std::lock_guard lock(mutex_);
        const auto found = failures_.find(path);
        const bool passed_over =
            found != failures_.end() && found->second.back_off.is_given_up(BackOff::Clock::now());
        return passed_over ? std::optional(found->second.message) : std::nullopt;
    }

private:
    struct Failures {
        BackOff back_off;
        std::string message; // of the last
    };
    const std::chrono::milliseconds first_pause_;
    mutable std::mutex mutex_;
    std::map<std::filesystem::path, Failures> failures_;
};

} // namespace reljef::io

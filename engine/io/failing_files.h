#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace reljef::io {

/// Files that fail again and again: they are passed over for a while, so that not every tile waits
/// for them. Safe from several threads at a time.
class FailingFiles {
public:
    /// `most`: failures after which a file is given up for half a minute.
    explicit FailingFiles(int most) : most_(most) {}

    void note(const std::filesystem::path& path, std::string message) {
        const std::lock_guard lock(mutex_);
        Failures& failures = failures_[path];
        ++failures.count;
        failures.message = std::move(message);
        failures.last = Clock::now();
    }
    void forget(const std::filesystem::path& path) {
        const std::lock_guard lock(mutex_);
        failures_.erase(path);
    }
    /// What was wrong with a file that is given up for now, else nothing.
    [[nodiscard]] std::optional<std::string> given_up(const std::filesystem::path& path) const {
        const std::lock_guard lock(mutex_);
        const auto found = failures_.find(path);
        const bool passed_over = found != failures_.end() && found->second.count >= most_ &&
                                 Clock::now() < found->second.last + pause;
        return passed_over ? std::optional(found->second.message) : std::nullopt;
    }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds pause{30};
    struct Failures {
        int count = 0;
        std::string message; // of the last
        Clock::time_point last;
    };
    const int most_;
    mutable std::mutex mutex_;
    std::map<std::filesystem::path, Failures> failures_;
};

} // namespace reljef::io

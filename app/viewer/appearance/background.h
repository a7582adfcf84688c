#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "engine/core/result.h"

namespace reljef::app {

/// Runs a function on its own thread. The destructor requests a stop and waits.
template <class T> class Background {
public:
    using Work = std::function<Result<T>(const std::stop_token&)>;

    explicit Background(Work work)
        : thread_([this, work = std::move(work)](const std::stop_token& stop) {
              result_.emplace(run(work, stop));
              done_ = true;
          }) {}
    Background(const Background&) = delete;
    Background& operator=(const Background&) = delete;

    [[nodiscard]] bool is_done() const { return done_; }
    void request_stop() { thread_.request_stop(); }

    /// Waits for the result; an exception of a library becomes an error. Call it once.
    Result<T> take() {
        thread_.join();
        return *std::move(result_);
    }

private:
    static Result<T> run(const Work& work, const std::stop_token& stop) {
        try {
            return work(stop);
        } catch (const std::exception& thrown) { // out of memory
            return Error{thrown.what()};
        }
    }

    std::optional<Result<T>> result_;
    std::atomic<bool> done_ = false;
    std::jthread thread_; // last: it ends before other members are destroyed
};

} // namespace reljef::app

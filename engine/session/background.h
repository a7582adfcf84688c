#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

namespace reljef::session {

/// Runs a function on a thread of its own. When this object goes, the function is asked to stop and
/// waited for.
template <class T> class Background {
public:
    using Work = std::function<T(const std::stop_token&)>;

    explicit Background(Work work)
        : thread_([this, work = std::move(work)](const std::stop_token& stop) {
              try {
                  result_ = work(stop);
              } catch (...) { // out of memory: for whoever takes the result
                  exception_ = std::current_exception();
              }
              done_ = true;
          }) {}
    Background(const Background&) = delete;
    Background& operator=(const Background&) = delete;

    [[nodiscard]] bool is_done() const { return done_; }
    void request_stop() { thread_.request_stop(); }

    /// What the function returned, or throws what it threw; waits for it. Once only.
    T take() {
        thread_.join();
        if (exception_) {
            std::rethrow_exception(exception_);
        }
        return *std::move(result_);
    }

private:
    std::optional<T> result_;
    std::exception_ptr exception_;
    std::atomic<bool> done_ = false;
    std::jthread thread_; // last: it ends before the rest goes
};

} // namespace reljef::session

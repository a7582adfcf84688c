#include "engine/core/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace reljef {
namespace {

// What threads throw: std::bad_alloc. A thread that does not catch it ends the process.
class FirstException {
public:
    explicit operator bool() const { return is_caught_; }

    template <class Call> void catch_from(const Call& call) {
        try {
            call();
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!is_caught_) {
                exception_ = std::current_exception();
                is_caught_ = true;
            }
        }
    }
    void rethrow() const {
        if (is_caught_) {
            std::rethrow_exception(exception_);
        }
    }

private:
    std::mutex mutex_;
    std::atomic<bool> is_caught_{false};
    std::exception_ptr exception_;
};

} // namespace

unsigned thread_count(unsigned requested) {
    return requested > 0 ? requested : std::max(1U, std::thread::hardware_concurrency());
}

bool parallel_for(int count, const std::function<void(int index)>& body,
                  const ParallelOptions& options) {
    std::atomic<int> next{0};
    std::atomic<int> done{0};
    std::mutex progress_mutex;
    FirstException thrown;
    const auto call = [&](int index) {
        body(index);
        ++done;
        if (options.progress) {
            const std::lock_guard lock(progress_mutex);
            options.progress(static_cast<double>(done.load()) / count);
        }
    };
    const auto work = [&] {
        for (int index = next++; index < count; index = next++) {
            if (options.stop.stop_requested() || thrown) {
                return;
            }
            thrown.catch_from([&] { call(index); });
        }
    };
    {
        const auto helpers =
            std::min(thread_count(options.threads), static_cast<unsigned>(std::max(count, 1))) - 1;
        std::vector<std::jthread> threads;
        threads.reserve(helpers);
        for (unsigned i = 0; i < helpers; ++i) {
            try {
                threads.emplace_back(work);
            } catch (const std::exception&) {
                break; // no more threads, or memory: the running ones do all the work
            }
        }
        work();
    }
    thrown.rethrow();
    return done.load() >= count;
}

} // namespace reljef

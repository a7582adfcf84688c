#include "engine/core/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace reljef {

unsigned thread_count(unsigned requested) {
    return requested > 0 ? requested : std::max(1U, std::thread::hardware_concurrency());
}

bool parallel_for(int count, const std::function<void(int index)>& body,
                  const ParallelOptions& options) {
    std::atomic<int> next{0};
    std::atomic<int> done{0};
    std::mutex progress_mutex;
    const auto work = [&] {
        for (int index = next++; index < count; index = next++) {
            if (options.stop.stop_requested()) {
                return;
            }
            body(index);
            ++done;
            if (options.progress) {
                const std::lock_guard lock(progress_mutex);
                options.progress(static_cast<double>(done.load()) / count);
            }
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
            } catch (const std::system_error&) {
                break; // no more threads: the running ones do all the work
            }
        }
        work();
    }
    return done.load() >= count;
}

} // namespace reljef

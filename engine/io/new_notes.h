#pragma once

#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace reljef::io {

/// Notes that come up while one reads, each once. Safe from several threads at a time.
class NewNotes {
public:
    void add(const std::string& sentence) {
        const std::lock_guard lock(mutex_);
        if (known_.insert(sentence).second) {
            notes_.push_back(sentence);
        }
    }
    /// Those that nobody has taken.
    [[nodiscard]] std::vector<std::string> take() {
        const std::lock_guard lock(mutex_);
        return std::exchange(notes_, {});
    }

private:
    std::mutex mutex_;
    std::set<std::string> known_;
    std::vector<std::string> notes_;
};

} // namespace reljef::io

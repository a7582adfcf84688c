#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

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
    /// Note on a file, ready to follow its name. Files with the same note share a sentence.
    void add(const std::filesystem::path& file, const std::string& words) {
        const std::lock_guard lock(mutex_);
        if (known_.insert(file.string() + ": " + words).second) {
            of_files_[words].insert(file);
        }
    }
    /// Those that nobody has taken.
    [[nodiscard]] std::vector<std::string> take() {
        const std::lock_guard lock(mutex_);
        for (const auto& [words, files] : std::exchange(of_files_, {})) {
            const std::string first = files.begin()->string();
            notes_.push_back(files.size() == 1 ? fmt::format("{}: {}", first, words)
                                               : fmt::format("{} and {} more: {}", first,
                                                             files.size() - 1, words));
        }
        return std::exchange(notes_, {});
    }

private:
    std::mutex mutex_;
    std::map<std::string, std::set<std::filesystem::path>> of_files_; // words, and of which
    std::set<std::string> known_;
    std::vector<std::string> notes_;
};

} // namespace reljef::io

#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "engine/core/back_off.h"
#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {

// State that concurrent readers of files share. All classes are thread-safe.

/// Keeps rasters open between reads; each loan is exclusive.
class DatasetPool {
public:
    static constexpr std::size_t max_idle = 32;

    using Opener =
        std::function<Result<Dataset>(const std::filesystem::path&, const GdalMessages&)>;
    explicit DatasetPool(Opener open = open_raster, std::size_t idle = max_idle)
        : open_(std::move(open)), max_idle_(idle) {}

    /// Changes when a local file is replaced; always the same for remote files.
    struct FileState {
        std::filesystem::file_time_type changed;
        std::uintmax_t bytes = 0;
        friend bool operator==(const FileState&, const FileState&) = default;
    };

    /// An open raster; the destructor returns it to the pool.
    class Loan {
    public:
        /// `opened`: state of the file before it was opened.
        Loan(DatasetPool& pool, std::filesystem::path path, FileState opened, Dataset dataset)
            : pool_(&pool), path_(std::move(path)), opened_(opened), dataset_(std::move(dataset)) {}
        ~Loan();
        Loan(Loan&&) = default;
        Loan& operator=(Loan&&) = delete;

        GDALDataset& operator*() const { return *dataset_; }
        GDALDataset* operator->() const { return dataset_.get(); }
        /// Whether this is the first loan of a file that changed since it was first opened.
        [[nodiscard]] bool found_change() const { return found_change_; }
        /// Closes a raster that failed.
        void discard();

    private:
        friend class DatasetPool;

        DatasetPool* pool_;
        std::filesystem::path path_;
        FileState opened_;
        Dataset dataset_;
        bool found_change_ = false;
    };

    /// Checks or replaces a dataset that was just opened.
    using Check = std::function<Result<Dataset>(Dataset)>;

    /// Opens the file unless an idle dataset of its current state exists. Fails like the opener or
    /// `check`.
    Result<Loan> borrow(const std::filesystem::path& path, const GdalMessages& messages,
                        const Check& check = {});

    /// How often an opened file had another state than when it was opened before.
    [[nodiscard]] std::uint64_t changes() const { return changes_; }

private:
    struct Idle {
        std::filesystem::path path;
        FileState opened;
        Dataset dataset;
    };
    void give_back(Idle idle);
    bool is_changed(const std::filesystem::path& path, const FileState& now);

    const Opener open_;
    const std::size_t max_idle_;
    std::mutex mutex_;
    std::list<Idle> idle_; // newest first
    std::map<std::filesystem::path, FileState> opened_;
    std::atomic<std::uint64_t> changes_{0};
};

/// A note on a file with DatasetPool::Loan::found_change().
inline constexpr const char* changed_note =
    "changed while open: its tiles are read again; the overview shows what it held until the next "
    "start";

/// Files that failed repeatedly. Readers skip them for a while (BackOff).
class FailingFiles {
public:
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
    /// Whether it has failed since the last forget().
    [[nodiscard]] bool has_failed(const std::filesystem::path& path) const {
        const std::lock_guard lock(mutex_);
        return failures_.contains(path);
    }
    /// The last error of a file to skip now; else absent.
    [[nodiscard]] std::optional<std::string> skip_reason(const std::filesystem::path& path) const {
        const std::lock_guard lock(mutex_);
        const auto found = failures_.find(path);
        const bool skipped =
            found != failures_.end() && found->second.back_off.is_given_up(BackOff::Clock::now());
        return skipped ? std::optional(found->second.message) : std::nullopt;
    }

private:
    struct Failures {
        BackOff back_off;
        std::string message; // last error
    };
    const std::chrono::milliseconds first_pause_;
    mutable std::mutex mutex_;
    std::map<std::filesystem::path, Failures> failures_;
};

/// Notes of readers, each once.
class NewNotes {
public:
    void add(const std::string& sentence) {
        const std::lock_guard lock(mutex_);
        if (known_.insert(sentence).second) {
            notes_.push_back(sentence);
        }
    }
    /// A note that follows the file's name. Files with the same note share a sentence.
    void add(const std::filesystem::path& file, const std::string& note) {
        const std::lock_guard lock(mutex_);
        if (known_.insert(file.string() + ": " + note).second) {
            files_by_note_[note].insert(file);
        }
    }
    /// New notes since the last call.
    [[nodiscard]] std::vector<std::string> take() {
        const std::lock_guard lock(mutex_);
        for (const auto& [note, files] : std::exchange(files_by_note_, {})) {
            const std::string first = files.begin()->string();
            notes_.push_back(files.size() == 1 ? fmt::format("{}: {}", first, note)
                                               : fmt::format("{} and {} more: {}", first,
                                                             files.size() - 1, note));
        }
        return std::exchange(notes_, {});
    }

private:
    std::mutex mutex_;
    std::map<std::string, std::set<std::filesystem::path>> files_by_note_;
    std::set<std::string> known_;
    std::vector<std::string> notes_;
};

} // namespace reljef::io

#include "engine/io/files/dataset_pool.h"

#include <algorithm>
#include <exception>

#include "engine/io/remote/remote_files.h"

namespace reljef::io {
namespace {

DatasetPool::FileState state_of(const std::filesystem::path& path) {
    if (is_remote(path)) {
        return {};
    }
    std::error_code ignored;
    return {std::filesystem::last_write_time(path, ignored),
            std::filesystem::file_size(path, ignored)};
}

void forget(const std::filesystem::path& path) {
    if (is_remote(path)) {
        forget_remote_file(path.string());
    }
}

} // namespace

void DatasetPool::Loan::discard() {
    dataset_.reset();
    forget(path_);
}

DatasetPool::Loan::~Loan() {
    if (dataset_ == nullptr) {
        return;
    }
    try {
        pool_->give_back({std::move(path_), opened_, std::move(dataset_)});
    } catch (const std::exception&) {
        // Without memory for the list of idle datasets this one is closed.
    }
}

Result<DatasetPool::Loan> DatasetPool::borrow(const std::filesystem::path& path,
                                              const GdalMessages& messages, const Check& check) {
    const FileState now = state_of(path); // before opening: later changes are detected
    {
        const std::lock_guard lock(mutex_);
        idle_.remove_if([&](const Idle& idle) { return idle.path == path && idle.opened != now; });
        const auto found = std::find_if(idle_.begin(), idle_.end(),
                                        [&](const Idle& idle) { return idle.path == path; });
        if (found != idle_.end()) {
            Dataset dataset = std::move(found->dataset);
            idle_.erase(found);
            return Loan(*this, path, now, std::move(dataset));
        }
    }
    auto opened = open_(path, messages);
    if (opened && check) {
        opened = check(std::move(*opened));
    }
    if (!opened) {
        forget(path);
    }
    if (!opened) {
        return opened.error();
    }
    Loan loan(*this, path, now, std::move(*opened));
    loan.found_change_ = is_changed(path, now);
    return loan;
}

// A file may change again and again: each change counts once.
bool DatasetPool::is_changed(const std::filesystem::path& path, const FileState& now) {
    const std::lock_guard lock(mutex_);
    const auto [found, is_new] = opened_.try_emplace(path, now);
    const bool is_changed = !is_new && found->second != now;
    found->second = now;
    changes_ += is_changed ? 1 : 0;
    return is_changed;
}

void DatasetPool::give_back(Idle idle) {
    const std::lock_guard lock(mutex_);
    idle_.push_front(std::move(idle));
    if (idle_.size() > max_idle_) {
        idle_.pop_back();
    }
}

} // namespace reljef::io

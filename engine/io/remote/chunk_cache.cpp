#include "engine/io/remote/chunk_cache.h"

#include <algorithm>

namespace reljef::io {
namespace {

constexpr std::size_t max_chunks = 1024;
constexpr std::chrono::seconds failure_time{5};

} // namespace

std::optional<FileVersion> ChunkCache::version(const std::string& url) const {
    const std::lock_guard lock(mutex_);
    const auto file = files_.find(url);
    return file != files_.end() ? file->second.version : std::nullopt;
}

ChunkCache::Chunk ChunkCache::find(const std::string& url, const FileVersion& version,
                                   std::uint64_t index) {
    const std::lock_guard lock(mutex_);
    const auto file = files_.find(url);
    if (file == files_.end() || file->second.version != version) {
        return nullptr;
    }
    const auto entry = file->second.chunks.find(index);
    if (entry == file->second.chunks.end()) {
        return nullptr;
    }
    entry->second.last_use = ++uses_;
    return entry->second.chunk;
}

std::optional<std::vector<ChunkCache::Chunk>> ChunkCache::add(const std::string& url,
                                                              const FileVersion& version,
                                                              std::uint64_t first,
                                                              const std::string& bytes) {
    const std::lock_guard lock(mutex_);
    File& file = files_[url];
    if (file.version.value_or(version) != version) {
        return std::nullopt;
    }
    file.version = version;
    std::vector<Chunk> added;
    for (std::size_t at = 0; at < bytes.size(); at += chunk_bytes) {
        const auto [entry, is_new] = file.chunks.try_emplace(first + at / chunk_bytes);
        count_ += is_new ? 1 : 0;
        added.push_back(std::make_shared<const std::string>(bytes, at, chunk_bytes));
        entry->second = {added.back(), ++uses_};
    }
    if (count_ > max_chunks) {
        evict();
    }
    return added;
}

// Keeps the half that was used last.
void ChunkCache::evict() {
    std::vector<std::uint64_t> uses;
    for (const auto& [url, file] : files_) {
        for (const auto& [index, entry] : file.chunks) {
            uses.push_back(entry.last_use);
        }
    }
    const auto middle = uses.end() - max_chunks / 2;
    std::nth_element(uses.begin(), middle, uses.end());
    for (auto& [url, file] : files_) {
        count_ -= std::erase_if(file.chunks,
                                [&](const auto& chunk) { return chunk.second.last_use < *middle; });
    }
}

std::optional<std::string> ChunkCache::failure(const std::string& url) const {
    const std::lock_guard lock(mutex_);
    const auto file = files_.find(url);
    const bool failed = file != files_.end() && !file->second.failure.empty() &&
                        Clock::now() < file->second.failed + failure_time;
    return failed ? std::optional(file->second.failure) : std::nullopt;
}

void ChunkCache::fail(const std::string& url, const std::string& message) {
    const std::lock_guard lock(mutex_);
    File& file = files_[url];
    file.failure = message;
    file.failed = Clock::now();
}

void ChunkCache::forget(const std::string& url) {
    const std::lock_guard lock(mutex_);
    const auto file = files_.find(url);
    if (file != files_.end()) {
        count_ -= file->second.chunks.size();
        files_.erase(file);
    }
}

} // namespace reljef::io

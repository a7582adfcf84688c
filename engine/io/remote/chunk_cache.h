#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/remote/http_client.h"

namespace reljef::io {

/// Parts of files on servers that were read lately, 16 MB in all, and failures. Thread-safe.
class ChunkCache {
public:
    static constexpr std::size_t chunk_bytes = 16384;
    using Chunk = std::shared_ptr<const std::string>; ///< shorter at the end of a file

    [[nodiscard]] std::optional<FileVersion> version(const std::string& url) const;
    /// Null if it is not there in this version.
    Chunk find(const std::string& url, const FileVersion& version, std::uint64_t index);
    /// Stores and returns chunks from `first`. Absent if the file has another version than before.
    std::optional<std::vector<Chunk>> add(const std::string& url, const FileVersion& version,
                                          std::uint64_t first, const std::string& bytes);

    /// The error of a read in the last five seconds. Readers that try again at once, as GDAL does,
    /// need not wait again.
    [[nodiscard]] std::optional<std::string> failure(const std::string& url) const;
    void fail(const std::string& url, const std::string& message);

    void forget(const std::string& url);

private:
    using Clock = std::chrono::steady_clock;
    struct Entry {
        Chunk chunk;
        std::uint64_t last_use = 0;
    };
    struct File {
        std::optional<FileVersion> version;
        std::map<std::uint64_t, Entry> chunks;
        std::string failure;
        Clock::time_point failed;
    };
    void evict();

    mutable std::mutex mutex_;
    std::map<std::string, File> files_;
    std::size_t count_ = 0; // of chunks
    std::uint64_t uses_ = 0;
};

} // namespace reljef::io

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.h"

namespace reljef::io {

/// A part of a file, bytes.
struct ByteRange {
    std::uint64_t first = 0;
    std::size_t count = 0;
};

/// A file as its server describes it. A file that changes gets another version.
struct FileVersion {
    std::uint64_t bytes = 0;
    std::string changed; ///< Last-Modified, else ETag; empty without both
    friend bool operator==(const FileVersion&, const FileVersion&) = default;
};

struct HttpPart {
    bool found = true; ///< false: HTTP 204, 404 or 410
    std::string bytes; ///< fewer than requested only at the end of the file
    FileVersion version;
};

/// When a read is too slow.
struct ReadLimits {
    /// Seconds until the first bytes count: a connection over satellites takes three.
    double start = 10.0;
    /// Slower, the tiles of one view (8 MB) would take over an hour.
    double min_bytes_per_second = 2000.0;
};

/// Reads parts of files from servers. Thread-safe.
class HttpClient {
public:
    explicit HttpClient(ReadLimits limits = {});

    /// Reads the parts at the same time. Retries requests that an overloaded server refuses (HTTP
    /// 429, 5xx), after pauses of a second (GDAL_HTTP_RETRY_DELAY).
    ///
    /// A read fails, with its redirects and retries, if it takes longer than 60 s
    /// (GDAL_HTTP_TIMEOUT), or longer than 10 s plus a second for each 2 kB that came (ReadLimits).
    /// A part also fails if it brings under 100 bytes a second for 10 s (GDAL_HTTP_LOW_SPEED_LIMIT
    /// and _TIME). It ends within 0.1 s of a stop (ReadScope). All reads for one open or one window
    /// of samples (ReadDeadline) fail after five times 60 s.
    ///
    /// The address may name any host by http:// or https://. Redirects are followed, at most five,
    /// to https:// addresses of public hosts, without the user's credentials and proxy.
    ///
    /// The errors do not name the address. Precondition: no range is empty.
    Result<std::vector<HttpPart>> read(const std::string& url, std::span<const ByteRange> ranges,
                                       int max_retries = 0);

private:
    struct MultiCloser {
        void operator()(void* multi) const;
    };
    using Multi = std::unique_ptr<void, MultiCloser>; ///< libcurl's, with open connections
    Multi borrow();

    ReadLimits limits_;
    std::mutex mutex_;
    std::vector<Multi> idle_;
};

} // namespace reljef::io

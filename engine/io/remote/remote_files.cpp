#include "engine/io/remote/remote_files.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_vsi_virtual.h>
#include <fmt/format.h>

#include "engine/io/remote/chunk_cache.h"
#include "engine/io/remote/http_client.h"
#include "engine/io/remote/read_scope.h"

namespace reljef::io {
namespace {

constexpr std::string_view prefix = "/vsicurl/";
constexpr std::uint64_t chunk_bytes = ChunkCache::chunk_bytes;
constexpr std::uint64_t max_ahead = 128;                 // chunks: 2 MB
constexpr std::size_t max_read = std::size_t{512} << 20; // bytes; blocks have at most 256 MB
constexpr std::chrono::seconds max_answer_time{5};       // longer: the server hangs
constexpr std::uint64_t max_gap = 4096; // bytes between parts that are worth no second request

constexpr const char* no_such_file = "the server has no such file";

/// How much to read ahead: twice as much each time while a file is read from its begin to its end.
struct Ahead {
    std::uint64_t next = 1; ///< the chunk after those requested
    std::uint64_t count = 1;
};

std::string url_of(std::string_view name) {
    return std::string(name.starts_with(prefix) ? name.substr(prefix.size()) : name);
}

/// Whether it would hold overviews or masks of overviews or masks. A server that has all that it is
/// asked for would be asked for ever deeper ones.
bool is_nested_sidecar(const std::string& url) {
    constexpr std::size_t length = 4;
    const auto is_sidecar = [&](std::size_t end) {
        const std::string word = end > length ? url.substr(end - length, length) : "";
        return EQUAL(word.c_str(), ".ovr") || EQUAL(word.c_str(), ".msk");
    };
    return is_sidecar(url.size()) && is_sidecar(url.size() - length);
}

/// "https://host:port".
std::string origin_of(const std::string& url) {
    const auto host = url.find("://");
    return host == std::string::npos ? url : url.substr(0, url.find('/', host + 3));
}

/// Reads files on servers through a cache. Errors do not name the file.
class RemoteReader {
public:
    /// Absent if the server has no such file.
    Result<std::optional<FileVersion>> version(const std::string& url) {
        if (const auto known = cache_.version(url)) {
            return known;
        }
        if (cache_.failure(url) == no_such_file) {
            return std::optional<FileVersion>();
        }
        auto parts = request(url, std::array{ByteRange{0, chunk_bytes}});
        if (!parts) {
            if (!ReadScope::stop_requested()) {
                cache_.fail(url, parts.error().message);
            }
            return parts.error();
        }
        const HttpPart& part = parts->front();
        if (!part.found) {
            cache_.fail(url, no_such_file);
            return std::optional<FileVersion>();
        }
        if (!cache_.add(url, part.version, 0, part.bytes)) {
            return changed(url);
        }
        return std::optional(part.version);
    }

    /// Reads through the cache. Precondition: the range lies in the file.
    Result<void> read(const std::string& url, const FileVersion& version, ByteRange range,
                      Ahead& ahead, char* into) {
        const std::uint64_t begin = range.first / chunk_bytes;
        const std::uint64_t end = (range.first + range.count - 1) / chunk_bytes + 1;
        std::vector<ChunkCache::Chunk> chunks;
        for (std::uint64_t index = begin; index < end; ++index) {
            chunks.push_back(cache_.find(url, version, index));
        }
        const auto is_missing = [](const ChunkCache::Chunk& chunk) { return chunk == nullptr; };
        const auto first = std::find_if(chunks.begin(), chunks.end(), is_missing);
        if (first != chunks.end()) {
            const auto last = std::find_if(chunks.rbegin(), chunks.rend(), is_missing);
            const auto offset = static_cast<std::uint64_t>(first - chunks.begin());
            ahead.count = begin + offset == ahead.next ? std::min(2 * ahead.count, max_ahead) : 1;
            const auto count =
                std::max(ahead.count, static_cast<std::uint64_t>(last.base() - first));
            ahead.next = begin + offset + count;
            if (auto got = request_chunks(url, version, begin + offset, count, begin, chunks);
                !got) {
                return got;
            }
        }
        for (std::size_t i = 0; i < chunks.size(); ++i) {
            const std::uint64_t chunk_begin = (begin + i) * chunk_bytes;
            const std::uint64_t from = std::max(chunk_begin, range.first);
            const std::uint64_t to =
                std::min(chunk_begin + chunks[i]->size(), range.first + range.count);
            std::memcpy(into + (from - range.first), chunks[i]->data() + (from - chunk_begin),
                        to - from);
        }
        return {};
    }

    /// Reads past the cache. Precondition: as read().
    Result<std::vector<HttpPart>> read_parts(const std::string& url, const FileVersion& version,
                                             std::span<const ByteRange> ranges) {
        auto parts = request(url, ranges);
        for (std::size_t i = 0; parts && i < parts->size(); ++i) {
            const HttpPart& part = (*parts)[i];
            if (!part.found) {
                return Error{no_such_file};
            }
            if (part.version != version || part.bytes.size() != ranges[i].count) {
                return changed(url);
            }
        }
        return parts;
    }

    /// In one request; past the cache, without retries and without a memory of failures.
    Result<HttpPart> read_whole(const std::string& url, std::size_t max_bytes) {
        auto parts = client_.read(url, std::array{ByteRange{0, max_bytes}});
        return parts ? Result<HttpPart>(std::move(parts->front())) : parts.error();
    }

    void forget(const std::string& url) {
        cache_.forget(url);
        cache_.forget(origin_of(url));
    }

private:
    /// Makes the requests unless the file could not be opened just now, or its server hung.
    Result<std::vector<HttpPart>> request(const std::string& url,
                                          std::span<const ByteRange> ranges) {
        for (const std::string& failed : {url, origin_of(url)}) {
            if (auto failure = cache_.failure(failed)) {
                return Error{std::move(*failure)};
            }
        }
        const auto begin = std::chrono::steady_clock::now();
        const int retries = std::atoi(CPLGetConfigOption("GDAL_HTTP_MAX_RETRY", "2"));
        auto parts = client_.read(url, ranges, retries);
        const bool hangs = std::chrono::steady_clock::now() - begin > max_answer_time;
        if (!parts && hangs && !ReadScope::stop_requested()) {
            cache_.fail(origin_of(url), parts.error().message);
        }
        return parts;
    }

    Result<void> request_chunks(const std::string& url, const FileVersion& version,
                                std::uint64_t first, std::uint64_t count, std::uint64_t begin,
                                std::vector<ChunkCache::Chunk>& chunks) {
        const std::uint64_t offset = first * chunk_bytes;
        const ByteRange range{offset, std::min(count * chunk_bytes, version.bytes - offset)};
        const auto parts = read_parts(url, version, std::array{range});
        if (!parts) {
            return parts.error();
        }
        const auto added = cache_.add(url, version, first, parts->front().bytes);
        if (!added) {
            return changed(url);
        }
        for (std::uint64_t i = first; i < std::min(first + count, begin + chunks.size()); ++i) {
            ChunkCache::Chunk& chunk = chunks[i - begin];
            if (chunk == nullptr) {
                chunk = (*added)[i - first];
            }
        }
        return {};
    }

    Error changed(const std::string& url) {
        cache_.forget(url);
        return {"the file changed while it was read"};
    }

    HttpClient client_;
    ChunkCache cache_;
};

// Later messages of drivers follow from this one, see GdalMessages.
void report(const Error& error) {
    CPLError(CE_Failure, CPLE_HttpResponse, "%s", error.message.c_str());
}

/// An open file.
class RemoteHandle final : public VSIVirtualHandle {
public:
    RemoteHandle(RemoteReader& reader, std::string url, FileVersion version)
        : reader_(reader), url_(std::move(url)), version_(std::move(version)) {}

    int Seek(vsi_l_offset offset, int whence) override {
        position_ = whence == SEEK_SET   ? offset
                    : whence == SEEK_CUR ? position_ + offset
                                         : version_.bytes + offset;
        at_end_ = false;
        return 0;
    }
    vsi_l_offset Tell() override { return position_; }
    int Eof() override { return at_end_ ? 1 : 0; }
    int Close() override { return 0; }
    std::size_t Write(const void* /*bytes*/, std::size_t /*size*/, std::size_t /*count*/) override {
        errno = EROFS;
        return 0;
    }

    std::size_t Read(void* into, std::size_t size, std::size_t count) override {
        if (size == 0 || count == 0) {
            return 0;
        }
        const std::uint64_t left = version_.bytes - std::min(position_, version_.bytes);
        at_end_ = count > left / size;
        const auto bytes = at_end_ ? static_cast<std::size_t>(left) : size * count;
        if (bytes == 0) {
            return 0;
        }
        if (bytes > max_read) {
            report({fmt::format("{} bytes were requested at once, at most {} were expected", bytes,
                                max_read)});
            return 0;
        }
        const auto read =
            reader_.read(url_, version_, {position_, bytes}, ahead_, static_cast<char*>(into));
        if (!read) {
            report(read.error());
            return 0;
        }
        position_ += bytes;
        return bytes / size;
    }

    int ReadMultiRange(int count, void** into, const vsi_l_offset* offsets,
                       const std::size_t* sizes) override {
        const auto parts = static_cast<std::size_t>(count);
        return read_parts({into, parts}, {offsets, parts}, {sizes, parts}) ? 0 : -1;
    }

private:
    bool read_parts(std::span<void* const> into, std::span<const vsi_l_offset> offsets,
                    std::span<const std::size_t> sizes) {
        std::vector<ByteRange> ranges;     // merged
        std::vector<std::size_t> range_of; // of each part
        for (std::size_t i = 0; i < into.size(); ++i) {
            if (!add_part({offsets[i], sizes[i]}, ranges)) {
                return false;
            }
            range_of.push_back(ranges.size() - 1);
        }
        const auto read = reader_.read_parts(url_, version_, ranges);
        if (!read) {
            report(read.error());
            return false;
        }
        for (std::size_t i = 0; i < into.size(); ++i) {
            const std::string& bytes = (*read)[range_of[i]].bytes;
            std::memcpy(into[i], bytes.data() + (offsets[i] - ranges[range_of[i]].first), sizes[i]);
        }
        return true;
    }

    /// Lengthens the last range or begins another one. False if the part does not lie in the file.
    bool add_part(const ByteRange& part, std::vector<ByteRange>& ranges) const {
        if (part.count == 0 || part.count > max_read || part.first > version_.bytes ||
            part.count > version_.bytes - part.first) {
            return false;
        }
        if (!ranges.empty()) {
            ByteRange& last = ranges.back();
            const std::uint64_t end = last.first + last.count;
            if (part.first >= end && part.first - end <= max_gap &&
                last.count + part.count <= max_read) {
                last.count = static_cast<std::size_t>(part.first - last.first) + part.count;
                return true;
            }
        }
        ranges.push_back(part);
        return true;
    }

    RemoteReader& reader_;
    std::string url_;
    FileVersion version_;
    std::uint64_t position_ = 0;
    bool at_end_ = false;
    Ahead ahead_;
};

class RemoteFiles final : public VSIFilesystemHandler {
public:
    RemoteReader& reader() { return reader_; }

    VSIVirtualHandle* Open(const char* name, const char* access, bool set_error,
                           CSLConstList /*options*/) override {
        if (std::strpbrk(access, "wa+") != nullptr) {
            errno = EROFS;
            return nullptr;
        }
        const auto version = known_version(name, set_error);
        return version ? new RemoteHandle(reader_, url_of(name), *version) : nullptr;
    }
    int Stat(const char* name, VSIStatBufL* stat, int /*flags*/) override {
        *stat = {};
        const auto version = known_version(name, false);
        if (!version) {
            return -1;
        }
        stat->st_mode = S_IFREG;
        stat->st_size = static_cast<decltype(stat->st_size)>(version->bytes);
        return 0;
    }
    int HasOptimizedReadMultiRange(const char* /*path*/) override { return TRUE; }
    bool IsLocal(const char* /*path*/) override { return false; }
    bool SupportsSequentialWrite(const char* /*path*/, bool /*temporary*/) override {
        return false;
    }
    bool SupportsRandomWrite(const char* /*path*/, bool /*temporary*/) override { return false; }

private:
    std::optional<FileVersion> known_version(const char* name, bool set_error) {
        const std::string url = url_of(name);
        auto version = is_nested_sidecar(url) ? Result<std::optional<FileVersion>>(std::nullopt)
                                              : reader_.version(url);
        if (!version) {
            report(version.error());
            errno = EIO;
            return std::nullopt;
        }
        if (!version->has_value()) {
            errno = ENOENT;
            if (set_error) {
                VSIError(VSIE_HttpError, "%s", no_such_file);
            }
        }
        return *version;
    }

    RemoteReader reader_;
};

RemoteFiles* installed_files() {
    return dynamic_cast<RemoteFiles*>(VSIFileManager::GetHandler(prefix.data()));
}

} // namespace

void install_remote_files() {
    // GDAL's own reader stays with "/vsicurl?", which GDAL deletes at its end.
    // NOLINTNEXTLINE(clang-analyzer-cplusplus.NewDeleteLeaks): GDAL owns it
    VSIFileManager::InstallHandler(std::string(prefix), new RemoteFiles);
} // NOLINT(clang-analyzer-cplusplus.NewDeleteLeaks)

void forget_remote_file(const std::string& name) {
    if (RemoteFiles* files = installed_files()) {
        files->reader().forget(url_of(name));
    }
}

Result<std::optional<std::string>> read_remote_file(const std::string& url, std::size_t max_bytes) {
    RemoteFiles& files = checked_pointer(installed_files(), "install_remote_files() was expected");
    auto whole = files.reader().read_whole(url, max_bytes);
    if (!whole) {
        return whole.error();
    }
    if (whole->version.bytes > max_bytes) {
        return Error{fmt::format("{} bytes were found, at most {} were expected",
                                 whole->version.bytes, max_bytes)};
    }
    return whole->found ? std::optional(std::move(whole->bytes)) : std::nullopt;
}

} // namespace reljef::io

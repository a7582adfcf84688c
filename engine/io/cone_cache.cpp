#include "engine/io/cone_cache.h"

#include <array>
#include <bit>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "engine/core/atomic_file.h"

namespace reljef::io {
namespace fs = std::filesystem;
namespace {

constexpr std::uint32_t cone_file_version = 1;

// What begins a file; then the plain and the relaxed ratios, floats, row after row.
struct ConeFileHeader {
    std::array<char, 8> magic{'r', 'e', 'l', 'c', 'o', 'n', 'e', 's'};
    std::uint32_t version = cone_file_version;
    std::uint32_t endian = 0x01020304;
    std::int32_t cols = 0; // cells
    std::int32_t rows = 0;
    std::uint64_t heights = 0; // checksums
    std::uint64_t ratios = 0;
};
static_assert(sizeof(ConeFileHeader) == 40 && std::is_trivially_copyable_v<ConeFileHeader>);

// FNV-1a (Fowler, Noll and Vo 1991) over words of four bytes.
constexpr std::uint64_t checksum_start = 14695981039346656037ULL;
std::uint64_t checksum(std::span<const float> values, std::uint64_t sum) {
    for (const float value : values) {
        sum = (sum ^ std::bit_cast<std::uint32_t>(value)) * 1099511628211ULL;
    }
    return sum;
}

std::uint64_t checksum_of(GridView<const float> heights) {
    std::uint64_t sum = checksum_start ^ static_cast<std::uint64_t>(heights.cols());
    for (int row = 0; row < heights.rows(); ++row) {
        sum = checksum(heights.row(row), sum);
    }
    return sum;
}

std::uint64_t checksum_of(const terrain::ConeMaps& cones) {
    return checksum(cones.relaxed.samples(), checksum(cones.plain.samples(), checksum_start));
}

ConeFileHeader header_of(GridView<const float> heights, std::uint64_t ratios) {
    ConeFileHeader header;
    header.cols = heights.cols() - 1;
    header.rows = heights.rows() - 1;
    header.heights = checksum_of(heights);
    header.ratios = ratios;
    return header;
}

std::vector<std::byte> bytes_of(GridView<const float> heights, const terrain::ConeMaps& cones) {
    const ConeFileHeader header = header_of(heights, checksum_of(cones));
    std::vector<std::byte> bytes;
    for (const auto part :
         {std::as_bytes(std::span(&header, 1)), std::as_bytes(cones.plain.samples()),
          std::as_bytes(cones.relaxed.samples())}) {
        bytes.insert(bytes.end(), part.begin(), part.end());
    }
    return bytes;
}

Error unusable(const fs::path& path, std::string_view found) {
    return Error{fmt::format("{}: {} found, the cones of these heights (version {}) were expected; "
                             "they are made anew",
                             path.string(), found, cone_file_version)};
}

Result<terrain::ConeMaps> parse_cones(const std::string& bytes, GridView<const float> heights,
                                      const fs::path& path) {
    terrain::ConeMaps cones{Grid<float>(heights.cols() - 1, heights.rows() - 1),
                            Grid<float>(heights.cols() - 1, heights.rows() - 1)};
    const std::size_t map_bytes = cones.plain.samples().size_bytes();
    if (bytes.size() != sizeof(ConeFileHeader) + 2 * map_bytes) {
        return unusable(path, fmt::format("a length of {} bytes", bytes.size()));
    }
    ConeFileHeader header;
    std::memcpy(&header, bytes.data(), sizeof(header));
    std::memcpy(cones.plain.samples().data(), bytes.data() + sizeof(header), map_bytes);
    std::memcpy(cones.relaxed.samples().data(), bytes.data() + sizeof(header) + map_bytes,
                map_bytes);
    const ConeFileHeader expected = header_of(heights, checksum_of(cones));
    if (header.version != expected.version) {
        return unusable(path, fmt::format("version {}", header.version));
    }
    if (std::memcmp(&header, &expected, sizeof(header)) != 0) {
        return unusable(path, "a wrong checksum");
    }
    return cones;
}

// Nothing where there is no such file.
std::optional<Result<terrain::ConeMaps>> read_cones(const fs::path& path,
                                                    GridView<const float> heights) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) {
        return std::nullopt;
    }
    constexpr std::size_t longest = std::size_t{1} << 32U;
    const auto bytes = read_text_file(path, longest);
    return bytes ? parse_cones(*bytes, heights, path) : Result<terrain::ConeMaps>(bytes.error());
}

Result<void> write_cones(const fs::path& path, GridView<const float> heights,
                         const terrain::ConeMaps& cones) {
    std::error_code code;
    fs::create_directories(path.parent_path(), code); // what is wrong with it, writing will tell
    return write_file(path, bytes_of(heights, cones));
}

using ConeClock = std::chrono::steady_clock;

} // namespace

std::optional<fs::path> cache_folder() {
    const char* const cache = std::getenv("XDG_CACHE_HOME");
    if (cache != nullptr && fs::path(cache).is_absolute()) {
        return fs::path(cache) / "reljef";
    }
    const char* const home = std::getenv("HOME");
    if (home != nullptr && fs::path(home).is_absolute()) {
        return fs::path(home) / ".cache" / "reljef";
    }
    return std::nullopt;
}

fs::path cone_file(const fs::path& folder, GridView<const float> unit_heights) {
    return folder / fmt::format("{:016x}.cones", checksum_of(unit_heights));
}

std::optional<CachedCones> cached_cones(GridView<const float> unit_heights,
                                        const ConeCacheOptions& options) {
    const fs::path path = options.folder ? cone_file(*options.folder, unit_heights) : fs::path();
    CachedCones cached;
    if (!path.empty()) {
        if (auto read = read_cones(path, unit_heights)) {
            if (*read) {
                cached.cones = std::make_shared<const terrain::ConeMaps>(std::move(**read));
                return cached;
            }
            cached.note = read->error().message;
        }
    }
    const auto start = ConeClock::now();
    auto made = terrain::cone_maps(unit_heights, {.parallel = options.parallel});
    if (!made) {
        return std::nullopt;
    }
    const std::chrono::duration<double> seconds = ConeClock::now() - start;
    cached.cones = std::make_shared<const terrain::ConeMaps>(std::move(*made));
    if (!path.empty() && seconds.count() >= options.least_seconds) {
        const auto written = write_cones(path, unit_heights, *cached.cones);
        cached.note = written ? cached.note : written.error().message;
    }
    return cached;
}

} // namespace reljef::io

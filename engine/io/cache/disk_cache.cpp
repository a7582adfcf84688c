#include "engine/io/cache/disk_cache.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "engine/core/stopwatch.h"
#include "engine/io/cache/cache_file.h"
#include "engine/io/cache/fnv_hash.h"

namespace reljef::io {
namespace fs = std::filesystem;
namespace {

struct CacheKind {
    std::array<char, 8> magic{};
    std::uint32_t version = 1; // increase when the algorithm changes
    std::string_view name;
    std::string_view extension;
};
constexpr CacheKind cone_kind{
    {'r', 'e', 'l', 'c', 'o', 'n', 'e', 's'}, 1, "the cones of these heights", "cones"};
constexpr CacheKind bisection_kind{
    {'r', 'e', 'l', 's', 'p', 'l', 'i', 't'}, 3, "the error bounds of these heights", "bisection"};

struct CacheKey {
    CacheKind kind;
    glm::ivec2 size{0};       // grid
    std::uint64_t source = 0; // checksum of the inputs

    [[nodiscard]] fs::path file_in(const fs::path& folder) const {
        return folder / fmt::format("{:016x}.{}", source, kind.extension);
    }
};

// Start of a cache file; numbers of four bytes follow.
struct CacheHeader {
    std::array<char, 8> magic{};
    std::uint32_t version = 0;
    std::uint32_t endian = 0x01020304;
    std::int32_t cols = 0;
    std::int32_t rows = 0;
    std::uint64_t source = 0; // checksums
    std::uint64_t numbers = 0;
};
static_assert(sizeof(CacheHeader) == 40 && std::is_trivially_copyable_v<CacheHeader>);

// FNV-1a over words instead of bytes.
template <class Word, class T>
std::uint64_t word_hash(std::span<const T> values, std::uint64_t hash = fnv_start) {
    for (const T value : values) {
        hash = (hash ^ std::bit_cast<Word>(value)) * fnv_prime;
    }
    return hash;
}

std::uint64_t hash_of(GridView<const float> heights) {
    std::uint64_t hash = fnv_start ^ static_cast<std::uint64_t>(heights.cols());
    for (int row = 0; row < heights.rows(); ++row) {
        hash = word_hash<std::uint32_t, float>(heights.row(row), hash);
    }
    return hash;
}

CacheKey cone_key(GridView<const float> heights) {
    return {cone_kind, {heights.cols() - 1, heights.rows() - 1}, hash_of(heights)};
}

CacheKey bisection_key(const terrain::Heightfield& heightfield,
                       const terrain::Placement& placement) {
    constexpr int positions = 17; // per side; they identify a placement
    const glm::ivec2 size(heightfield.heights.cols(), heightfield.heights.rows());
    const glm::dvec2 last(size - 1);
    std::vector<double> numbers{placement.exaggeration(), heightfield.range.low,
                                heightfield.range.high,
                                placement.kind() == terrain::PlacementKind::plane ? 0.0 : 1.0};
    for (int i = 0; i < positions * positions; ++i) {
        const glm::dvec2 sample =
            last * glm::dvec2(i % positions, i / positions) / (positions - 1.0);
        for (const double height : {0.0, 1000.0}) {
            const glm::dvec3 world = placement.world_from_sample({sample, height});
            numbers.insert(numbers.end(), {world.x, world.y, world.z});
        }
    }
    return {bisection_kind, size,
            word_hash<std::uint64_t, double>(numbers, hash_of(heightfield.heights.view()))};
}

template <class Number>
CacheHeader header_of(const CacheKey& key, std::span<const Number> numbers) {
    CacheHeader header;
    header.magic = key.kind.magic;
    header.version = key.kind.version;
    header.cols = key.size.x;
    header.rows = key.size.y;
    header.source = key.source;
    header.numbers = word_hash<std::uint32_t>(numbers);
    return header;
}

constexpr std::string_view computed_again = "; they are computed again";

Error unusable(const fs::path& path, const CacheKind& kind, std::string_view found) {
    return Error{fmt::format("{}: {} found, {} (version {}) were expected{}", path.string(), found,
                             kind.name, kind.version, computed_again)};
}

// Reads and verifies `count` numbers; absent if there is no file.
template <class Number>
Result<std::optional<std::vector<Number>>> read_numbers(const fs::path& path, const CacheKey& key,
                                                        std::size_t count) {
    using Numbers = std::optional<std::vector<Number>>;
    const std::size_t expected_bytes = sizeof(CacheHeader) + count * sizeof(Number);
    const auto file = read_cache_file(path, expected_bytes);
    if (!file) {
        return Error{fmt::format("{}{}", file.error().message, computed_again)};
    }
    if (!*file) {
        return Numbers();
    }
    const std::string& bytes = **file;
    if (bytes.size() != expected_bytes) {
        return unusable(path, key.kind, fmt::format("a length of {} bytes", bytes.size()));
    }
    std::vector<Number> numbers(count);
    const auto content = std::as_writable_bytes(std::span(numbers));
    CacheHeader header;
    std::memcpy(&header, bytes.data(), sizeof(header));
    if (header.version != key.kind.version) {
        return unusable(path, key.kind, fmt::format("version {}", header.version));
    }
    std::memcpy(content.data(), bytes.data() + sizeof(header), content.size());
    const CacheHeader expected = header_of<Number>(key, numbers);
    if (std::memcmp(&header, &expected, sizeof(header)) != 0) {
        return unusable(path, key.kind, "a wrong checksum");
    }
    return Numbers(std::move(numbers));
}

template <class Number>
Result<void> write_numbers(const fs::path& path, const CacheKey& key,
                           std::span<const Number> numbers) {
    const CacheHeader header = header_of(key, numbers);
    return write_cache_file(path, {std::as_bytes(std::span(&header, 1)), std::as_bytes(numbers)});
}

// The value of a file; absent if there is none, null if stopped.
template <class T, class Number, class Restore, class IsValid>
Result<std::optional<std::shared_ptr<const T>>>
read_value(const fs::path& path, const CacheKey& key, std::size_t count, const Restore& restore,
           const IsValid& is_valid) {
    using Value = std::optional<std::shared_ptr<const T>>;
    const auto numbers = read_numbers<Number>(path, key, count);
    if (!numbers) {
        return numbers.error();
    }
    Value value = *numbers ? Value(restore(**numbers)) : std::nullopt;
    if (value && *value && !is_valid(**numbers, **value)) {
        return unusable(path, key.kind, "nonsense");
    }
    return value;
}

// `restore(numbers)` and `compute()` return null if stopped; `numbers_of` is the inverse of
// `restore`, and `is_valid(numbers, value)` finds nonsense. `make_key` is called only if there is a
// folder.
template <class T, class Number, class MakeKey, class Restore, class IsValid, class Compute,
          class NumbersOf>
std::optional<Cached<T>> cached(const CacheOptions& options, std::size_t count,
                                const MakeKey& make_key, const Restore& restore,
                                const IsValid& is_valid, const Compute& compute,
                                const NumbersOf& numbers_of) {
    Cached<T> result;
    const CacheKey key = options.folder ? make_key() : CacheKey();
    const fs::path path = key.file_in(options.folder.value_or(fs::path()));
    if (options.folder) {
        auto found = read_value<T, Number>(path, key, count, restore, is_valid);
        if (found && *found) {
            result.value = std::move(**found);
            return result.value ? std::optional(result) : std::nullopt;
        }
        result.note = found ? "" : found.error().message;
    }
    const Stopwatch watch;
    result.value = compute();
    if (!result.value) {
        return std::nullopt;
    }
    if (options.folder && watch.seconds() >= options.min_seconds) {
        const auto written = write_numbers<Number>(path, key, numbers_of(*result.value));
        result.note = written ? result.note : written.error().message;
    }
    return result;
}

// An infinite error forces a split.
bool are_in_range(std::span<const terrain::SplitBounds> bounds) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    return std::all_of(bounds.begin(), bounds.end(), [](const terrain::SplitBounds& split) {
        return split.error.value() <= infinity && split.radius.value() < infinity;
    });
}

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

std::optional<fs::path> driver_cache_folder() {
    constexpr std::uintmax_t min_free_bytes = std::uintmax_t{16} << 20U; // ten times Mesa's index
    const auto folder = cache_folder();
    if (!folder || !make_cache_folder(*folder)) {
        return std::nullopt;
    }
    const fs::path of_mesa = *folder / "mesa_shader_cache"; // of Mesa 22
    std::error_code code;
    const bool has_room = fs::space(*folder, code).available >= min_free_bytes && !code;
    const bool is_trusted =
        make_cache_folder(of_mesa) && open_cache_file(of_mesa / "index", CacheAccess::read);
    return has_room && is_trusted ? folder : std::nullopt;
}

fs::path cone_file(const fs::path& folder, GridView<const float> unit_heights) {
    return cone_key(unit_heights).file_in(folder);
}

fs::path bisection_file(const fs::path& folder, const terrain::Heightfield& heightfield,
                        const terrain::Placement& placement) {
    return bisection_key(heightfield, placement).file_in(folder);
}

std::optional<Cached<material::ConeMaps>> cached_cones(GridView<const float> unit_heights,
                                                       const CacheOptions& options) {
    using material::ConeMaps;
    const glm::ivec2 size(unit_heights.cols() - 1, unit_heights.rows() - 1);
    const auto count = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
    const auto restore = [&](std::span<const float> numbers) {
        ConeMaps cones{Grid<float>(size.x, size.y), Grid<float>(size.x, size.y)};
        std::copy_n(numbers.begin(), count, cones.plain.samples().begin());
        std::copy_n(numbers.begin() + std::ssize(numbers) / 2, count,
                    cones.relaxed.samples().begin());
        return std::make_shared<const ConeMaps>(std::move(cones));
    };
    const auto compute = [&] {
        auto cones = material::cone_maps(unit_heights, options.parallel);
        return cones ? std::make_shared<const ConeMaps>(std::move(*cones)) : nullptr;
    };
    const auto numbers_of = [](const ConeMaps& cones) {
        const auto relaxed = cones.relaxed.samples();
        std::vector<float> numbers(cones.plain.samples().begin(), cones.plain.samples().end());
        numbers.insert(numbers.end(), relaxed.begin(), relaxed.end());
        return numbers;
    };
    return cached<ConeMaps, float>(
        options, 2 * count, [&] { return cone_key(unit_heights); }, restore,
        [&](const std::vector<float>&, const ConeMaps& cones) {
            return material::are_cones_of(cones, unit_heights);
        },
        compute, numbers_of);
}

std::optional<Cached<terrain::Bisection>> cached_bisection(const terrain::Heightfield& heightfield,
                                                           const terrain::Placement& placement,
                                                           const CacheOptions& options) {
    using terrain::Bisection;
    using Shared = std::shared_ptr<const Bisection>;
    const auto unless_stopped = [&](Shared bisection) {
        return options.parallel.stop.stop_requested() ? Shared() : std::move(bisection);
    };
    const auto restore = [&](const std::vector<terrain::SplitBounds>& bounds) {
        return unless_stopped(
            std::make_shared<const Bisection>(heightfield, placement, bounds, options.parallel));
    };
    const auto compute = [&] {
        return unless_stopped(
            std::make_shared<const Bisection>(heightfield, placement, options.parallel));
    };
    const std::size_t count =
        Bisection::bounds_count({heightfield.heights.cols(), heightfield.heights.rows()});
    return cached<Bisection, terrain::SplitBounds>(
        options, count, [&] { return bisection_key(heightfield, placement); }, restore,
        [&](const std::vector<terrain::SplitBounds>& bounds, const Bisection& bisection) {
            const std::uint64_t hash = word_hash<std::uint32_t, terrain::SplitBounds>(bounds);
            return are_in_range(bounds) &&
                   bisection.is_valid(static_cast<std::uint32_t>(hash >> 32U), options.parallel);
        },
        compute, [](const Bisection& bisection) { return bisection.bounds(); });
}

} // namespace reljef::io

#include "engine/io/cache/cone_cache.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "engine/core/stopwatch.h"
#include "engine/io/cache/array_cache.h"

namespace reljef::io {
namespace fs = std::filesystem;
namespace {

constexpr KeptKind cone_kind{
    {'r', 'e', 'l', 'c', 'o', 'n', 'e', 's'}, 1, "the cones of these heights"};

KeptKey cone_key(GridView<const float> heights) {
    return {cone_kind, {heights.cols() - 1, heights.rows() - 1}, checksum_of(heights)};
}

// The plain and the relaxed ratios, row after row. Nothing where there is no such file.
std::optional<Result<material::ConeMaps>> read_cones(const fs::path& path,
                                                     GridView<const float> heights) {
    material::ConeMaps cones{Grid<float>(heights.cols() - 1, heights.rows() - 1),
                             Grid<float>(heights.cols() - 1, heights.rows() - 1)};
    const auto numbers = read_numbers(path, cone_key(heights), 2 * cones.plain.size());
    if (!numbers) {
        return std::nullopt;
    }
    if (!*numbers) {
        return Result<material::ConeMaps>(numbers->error());
    }
    const std::span<const float> both = **numbers;
    const auto plain = both.first(cones.plain.size());
    const auto relaxed = both.last(cones.relaxed.size());
    std::copy(plain.begin(), plain.end(), cones.plain.samples().begin());
    std::copy(relaxed.begin(), relaxed.end(), cones.relaxed.samples().begin());
    return Result<material::ConeMaps>(std::move(cones));
}

Result<void> write_cones(const fs::path& path, GridView<const float> heights,
                         const material::ConeMaps& cones) {
    const std::array<std::span<const float>, 2> parts{cones.plain.samples(),
                                                      cones.relaxed.samples()};
    return write_numbers(path, cone_key(heights), parts);
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
                cached.cones = std::make_shared<const material::ConeMaps>(std::move(**read));
                return cached;
            }
            cached.note = read->error().message;
        }
    }
    const Stopwatch watch;
    auto made = material::cone_maps(unit_heights, options.parallel);
    if (!made) {
        return std::nullopt;
    }
    const double seconds = watch.seconds();
    cached.cones = std::make_shared<const material::ConeMaps>(std::move(*made));
    if (!path.empty() && seconds >= options.min_seconds) {
        const auto written = write_cones(path, unit_heights, *cached.cones);
        cached.note = written ? cached.note : written.error().message;
    }
    return cached;
}

} // namespace reljef::io

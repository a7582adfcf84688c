#include "engine/io/cache/bisection_cache.h"

#include <array>
#include <vector>

#include <fmt/format.h>

#include "engine/core/stopwatch.h"
#include "engine/io/cache/array_cache.h"

namespace reljef::io {
namespace fs = std::filesystem;
namespace {

// The version changes with what bisection.cpp finds.
constexpr KeptKind bisection_kind{
    {'r', 'e', 'l', 's', 'p', 'l', 'i', 't'}, 1, "the error bounds of these heights"};

// So many places along each side tell a placement from others.
constexpr int places_along = 17;

std::uint64_t checksum_of_placed(const terrain::Heightfield& heightfield,
                                 const terrain::Placement& placement) {
    const glm::dvec2 last(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1);
    std::vector<double> numbers{placement.exaggeration(), heightfield.range.low,
                                heightfield.range.high,
                                placement.kind() == terrain::PlacementKind::plane ? 0.0 : 1.0};
    for (int i = 0; i < places_along * places_along; ++i) {
        const glm::dvec2 sample =
            last * glm::dvec2(i % places_along, i / places_along) / (places_along - 1.0);
        for (const double height : {0.0, 1000.0}) {
            const glm::dvec3 world = placement.world_from_sample({sample, height});
            numbers.insert(numbers.end(), {world.x, world.y, world.z});
        }
    }
    return checksum(numbers, checksum_of(heightfield.heights.view()));
}

KeptKey bisection_key(const terrain::Heightfield& heightfield,
                      const terrain::Placement& placement) {
    return {bisection_kind,
            {heightfield.heights.cols(), heightfield.heights.rows()},
            checksum_of_placed(heightfield, placement)};
}

fs::path bisection_file(const fs::path& folder, const KeptKey& key) {
    return folder / fmt::format("{:016x}.bisection", key.source);
}

// What is wrong with writing it.
std::string keep(const fs::path& path, const KeptKey& key, const terrain::Bisection& bisection) {
    const std::vector<float> bounds = bisection.bounds();
    const std::array<std::span<const float>, 1> parts{bounds};
    const auto written = write_numbers(path, key, parts);
    return written ? std::string() : written.error().message;
}

} // namespace

fs::path bisection_file(const fs::path& folder, const terrain::Heightfield& heightfield,
                        const terrain::Placement& placement) {
    return bisection_file(folder, bisection_key(heightfield, placement));
}

std::optional<CachedBisection> cached_bisection(const terrain::Heightfield& heightfield,
                                                const terrain::Placement& placement,
                                                const BisectionCacheOptions& options) {
    CachedBisection cached;
    const KeptKey key = options.folder ? bisection_key(heightfield, placement) : KeptKey();
    const fs::path path = options.folder ? bisection_file(*options.folder, key) : fs::path();
    const auto read = path.empty()
                          ? std::nullopt
                          : read_numbers(path, key, terrain::Bisection::bounds_count(key.size));
    const Stopwatch watch;
    if (read && *read) {
        cached.bisection = std::make_shared<const terrain::Bisection>(heightfield, placement,
                                                                      **read, options.parallel);
    } else {
        cached.note = read ? read->error().message : std::string();
        cached.bisection =
            std::make_shared<const terrain::Bisection>(heightfield, placement, options.parallel);
    }
    if (options.parallel.stop.stop_requested()) {
        return std::nullopt;
    }
    const bool is_to_keep =
        !path.empty() && !(read && *read) && watch.seconds() >= options.min_seconds;
    if (is_to_keep) {
        const std::string fault = keep(path, key, *cached.bisection);
        cached.note = fault.empty() ? cached.note : fault;
    }
    return cached;
}

} // namespace reljef::io

// Files of the disk cache: bisections ('b') and cones ('c') behind right checksums, or any bytes.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "engine/io/cache/disk_cache.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/io/cache/resealed.h"

namespace reljef::fuzz {
namespace {

constexpr int cached_side = 9;

struct CacheStage {
    InputFolder folder;
    terrain::Heightfield field;
    Grid<float> unit{cached_side, cached_side};
    terrain::Placement placement;
    io::CacheOptions options;
    std::filesystem::path bisection;
    std::filesystem::path cones;
    std::string good_bisection;
    std::string good_cones;

    CacheStage() : field(made_field()), unit(field.heights), placement(placed(field)) {
        options = {.folder = folder.path(), .min_seconds = 0.0, .parallel = {.threads = 1}};
        bisection = io::bisection_file(folder.path(), field, placement);
        cones = io::cone_file(folder.path(), unit.view());
        static_cast<void>(io::cached_bisection(field, placement, options));
        static_cast<void>(io::cached_cones(unit.view(), options));
        good_bisection = bytes_of(bisection);
        good_cones = bytes_of(cones);
    }

    static terrain::Heightfield made_field() {
        terrain::Heightfield made;
        made.heights = Grid<float>(cached_side, cached_side);
        for (int row = 0; row < cached_side; ++row) {
            for (int col = 0; col < cached_side; ++col) {
                made.heights(col, row) = 0.5F + 0.4F * std::sin(0.7F * static_cast<float>(col)) *
                                                    std::cos(0.5F * static_cast<float>(row));
            }
        }
        return made;
    }
    static terrain::Placement placed(const terrain::Heightfield& field) {
        auto made = terrain::Placement::create(field, terrain::PlacementKind::plane, 1.0);
        expect(static_cast<bool>(made), "a placement");
        return std::move(*made);
    }

    static std::string bytes_of(const std::filesystem::path& path) {
        std::ifstream file(path, std::ios::binary);
        expect(file.good(), "a cache file");
        return (std::ostringstream() << file.rdbuf()).str();
    }
};

std::string with_numbers(const std::string& good, std::string_view numbers) {
    return test::resealed<std::uint32_t>(good, [&](std::span<std::uint32_t> old) {
        std::memcpy(old.data(), numbers.data(), std::min(old.size_bytes(), numbers.size()));
    });
}

void write(const std::filesystem::path& path, std::string_view bytes) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

} // namespace

void cache_target(std::string_view input) {
    static const CacheStage stage;
    const char kind = input.empty() ? 'r' : input.front();
    input.remove_prefix(input.empty() ? 0 : 1);
    if (kind == 'c') {
        write(stage.cones, with_numbers(stage.good_cones, input));
    } else {
        write(stage.bisection,
              kind == 'b' ? with_numbers(stage.good_bisection, input) : std::string(input));
    }
    const auto cones = io::cached_cones(stage.unit.view(), stage.options);
    expect(cones && cones->value, "cones");
    expect(std::ranges::all_of(cones->value->plain.samples(),
                               [](float ratio) { return std::isfinite(ratio); }),
           "finite cones");
    const auto bisection = io::cached_bisection(stage.field, stage.placement, stage.options);
    expect(bisection && bisection->value, "a bisection");
    expect(bisection->value->bounds().size() ==
               terrain::Bisection::bounds_count({cached_side, cached_side}),
           "all bounds");
}

} // namespace reljef::fuzz

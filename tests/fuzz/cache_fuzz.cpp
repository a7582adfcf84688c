// Files of the disk cache: bisections ('b') and cones ('c') behind right checksums, or any bytes.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "engine/io/cache/disk_cache.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/io/cache/resealed.h"

namespace {

using namespace reljef;

constexpr int side = 9;

struct Stage {
    fuzz::InputFolder folder;
    terrain::Heightfield field;
    Grid<float> unit{side, side};
    terrain::Placement placement;
    io::CacheOptions options;
    std::filesystem::path bisection;
    std::filesystem::path cones;
    std::string good_bisection;
    std::string good_cones;

    Stage() : field(made_field()), unit(field.heights), placement(placed(field)) {
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
        made.heights = Grid<float>(side, side);
        for (int row = 0; row < side; ++row) {
            for (int col = 0; col < side; ++col) {
                made.heights(col, row) = 0.5F + 0.4F * std::sin(0.7F * static_cast<float>(col)) *
                                                    std::cos(0.5F * static_cast<float>(row));
            }
        }
        return made;
    }
    static terrain::Placement placed(const terrain::Heightfield& field) {
        auto made = terrain::Placement::create(field, terrain::PlacementKind::plane, 1.0);
        fuzz::expect(static_cast<bool>(made), "a placement");
        return std::move(*made);
    }

    static std::string bytes_of(const std::filesystem::path& path) {
        std::ifstream file(path, std::ios::binary);
        fuzz::expect(file.good(), "a cache file");
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

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Stage stage;
    std::string_view input = fuzz::text_of(data, size);
    const char kind = input.empty() ? 'r' : input.front();
    input.remove_prefix(input.empty() ? 0 : 1);
    if (kind == 'c') {
        write(stage.cones, with_numbers(stage.good_cones, input));
    } else {
        write(stage.bisection,
              kind == 'b' ? with_numbers(stage.good_bisection, input) : std::string(input));
    }
    const auto cones = io::cached_cones(stage.unit.view(), stage.options);
    fuzz::expect(cones && cones->value, "cones");
    fuzz::expect(std::ranges::all_of(cones->value->plain.samples(),
                                     [](float ratio) { return std::isfinite(ratio); }),
                 "finite cones");
    const auto bisection = io::cached_bisection(stage.field, stage.placement, stage.options);
    fuzz::expect(bisection && bisection->value, "a bisection");
    fuzz::expect(bisection->value->bounds().size() ==
                     terrain::Bisection::bounds_count({side, side}),
                 "all bounds");
    return 0;
}

// Camera paths (TOML) and tracks of all formats.
#include <array>
#include <cmath>
#include <vector>

#include "engine/io/formats/flight_file.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

using namespace reljef;

template <class Key> void expect_order(const std::vector<Key>& keys) {
    fuzz::expect(!keys.empty() && keys.size() <= 100'000, "1 to 100,000 keys");
    for (std::size_t i = 0; i < keys.size(); ++i) {
        fuzz::expect(std::isfinite(keys[i].time), "finite times");
        fuzz::expect(i == 0 || keys[i - 1].time < keys[i].time, "increasing times");
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::array kinds{fuzz::FileKind{"p.toml"}, fuzz::FileKind{"p.gpx"},
                               fuzz::FileKind{"p.kml"}, fuzz::FileKind{"p.geojson"},
                               fuzz::FileKind{"p.kmz"}};
    static const fuzz::InputFolder folder;
    const auto path = fuzz::write_as_kind(folder, fuzz::text_of(data, size), kinds);
    const auto flight = io::read_flight(path);
    if (flight) {
        std::visit([](const auto& keys) { expect_order(keys); }, flight->keys);
    } else {
        fuzz::expect(!flight.error().message.empty(), "a reason");
    }
    return 0;
}

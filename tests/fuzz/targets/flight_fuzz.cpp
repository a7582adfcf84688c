// Camera paths (TOML) and tracks of all formats.
#include <array>
#include <cmath>
#include <vector>

#include "engine/io/formats/flight_file.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {
namespace {

template <class Key> void expect_order(const std::vector<Key>& keys) {
    expect(!keys.empty() && keys.size() <= 100'000, "1 to 100,000 keys");
    for (std::size_t i = 0; i < keys.size(); ++i) {
        expect(std::isfinite(keys[i].time), "finite times");
        expect(i == 0 || keys[i - 1].time < keys[i].time, "increasing times");
    }
}

} // namespace

void flight_target(std::string_view input) {
    constexpr std::array kinds{FileKind{"p.toml"}, FileKind{"p.gpx"}, FileKind{"p.kml"},
                               FileKind{"p.geojson"}, FileKind{"p.kmz"}};
    static const InputFolder folder;
    const auto path = write_as_kind(folder, input, kinds);
    const auto flight = io::read_flight(path);
    if (flight) {
        std::visit([](const auto& keys) { expect_order(keys); }, flight->keys);
    } else {
        expect(!flight.error().message.empty(), "a reason");
    }
}

} // namespace reljef::fuzz

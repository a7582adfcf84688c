// Files of places: small and large pieces find the same.
#include <vector>

#include "app/place_file.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {
namespace {

// Absent if the file is refused.
std::optional<std::vector<glm::dvec2>> places_in(const std::string& name, std::size_t piece_bytes) {
    auto file = app::PlaceFile::open(name, piece_bytes);
    std::vector<glm::dvec2> places;
    while (file && !file->at_end()) {
        const auto piece = file->next();
        if (!piece) {
            return std::nullopt;
        }
        expect(piece->places.size() == piece->texts.size(), "a text for each place");
        for (const glm::dvec2 place : piece->places) {
            expect(app::is_place(place), "places on the Earth");
        }
        places.insert(places.end(), piece->places.begin(), piece->places.end());
    }
    return file ? std::optional(places) : std::nullopt;
}

} // namespace

void place_target(std::string_view input) {
    static const InputFolder folder;
    const std::string name = folder.write("places.txt", input).string();
    const auto small = places_in(name, 64);
    const auto whole = places_in(name, input.size() + 2);
    // A line may be too long for small pieces only.
    expect(!small || (whole && *small == *whole), "the same places in pieces");
}

} // namespace reljef::fuzz

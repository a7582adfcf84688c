// Files of places: small and large pieces find the same.
#include <vector>

#include "app/place_file.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

using namespace reljef;

// Absent if the file is refused.
std::optional<std::vector<glm::dvec2>> places_in(const std::string& name, std::size_t piece_bytes) {
    auto file = app::PlaceFile::open(name, piece_bytes);
    std::vector<glm::dvec2> places;
    while (file && !file->at_end()) {
        const auto piece = file->next();
        if (!piece) {
            return std::nullopt;
        }
        fuzz::expect(piece->places.size() == piece->texts.size(), "a text for each place");
        for (const glm::dvec2 place : piece->places) {
            fuzz::expect(app::is_place(place), "places on the Earth");
        }
        places.insert(places.end(), piece->places.begin(), piece->places.end());
    }
    return file ? std::optional(places) : std::nullopt;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const fuzz::InputFolder folder;
    const std::string name = folder.write("places.txt", fuzz::text_of(data, size)).string();
    const auto small = places_in(name, 64);
    const auto whole = places_in(name, size + 2);
    // A line may be too long for small pieces only.
    fuzz::expect(!small || (whole && *small == *whole), "the same places in pieces");
    return 0;
}

// Indexes of tile folders, behind a right checksum: each that is read is written as it was.
#include <cstring>

#include "engine/io/cache/fnv_hash.h"
#include "engine/io/files/file_index.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {

void tile_index_target(std::string_view input) {
    static_cast<void>(io::index_from_bytes(input));
    constexpr std::string_view magic = "reljef tile index 2\n";
    std::string bytes(magic);
    const std::uint64_t hash = io::fnv_hash(input);
    bytes.append(reinterpret_cast<const char*>(&hash), sizeof(hash));
    bytes += input;
    if (const auto index = io::index_from_bytes(bytes)) {
        expect(io::bytes_of(*index) == bytes, "the same bytes again");
    }
}

} // namespace reljef::fuzz

// Indexes of tile folders, behind a right checksum: each that is read is written as it was.
#include <cstring>

#include "engine/io/cache/fnv_hash.h"
#include "engine/io/files/file_index.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace reljef;
    const std::string_view content = fuzz::text_of(data, size);
    static_cast<void>(io::index_from_bytes(content));
    constexpr std::string_view magic = "reljef tile index 2\n";
    std::string bytes(magic);
    const std::uint64_t hash = io::fnv_hash(content);
    bytes.append(reinterpret_cast<const char*>(&hash), sizeof(hash));
    bytes += content;
    if (const auto index = io::index_from_bytes(bytes)) {
        fuzz::expect(io::bytes_of(*index) == bytes, "the same bytes again");
    }
    return 0;
}

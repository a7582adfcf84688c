// Hits in OpenEXR files.
#include "engine/io/image/image.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace reljef;
    static const fuzz::InputFolder folder;
    static_cast<void>(io::read_hits(folder.write("hits.exr", fuzz::text_of(data, size))));
    return 0;
}

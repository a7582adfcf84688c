// Hits in OpenEXR files.
#include "engine/io/image/image.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {

void hits_target(std::string_view input) {
    static const InputFolder folder;
    static_cast<void>(io::read_hits(folder.write("hits.exr", input)));
}

} // namespace reljef::fuzz

// What libFuzzer calls. RELJEF_FUZZ_TARGET is the target of this program.
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/fuzz_targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    reljef::fuzz::RELJEF_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
    return 0;
}

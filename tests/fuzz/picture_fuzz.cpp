// Pictures of all formats: as colours, and as channels.
#include <array>

#include "engine/io/image/channels.h"
#include "engine/io/image/image.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace reljef;
    constexpr std::array kinds{
        fuzz::FileKind{"p.png"}, fuzz::FileKind{"p.jpg"},  fuzz::FileKind{"p.tif"},
        fuzz::FileKind{"p.exr"}, fuzz::FileKind{"p.bmp"},  fuzz::FileKind{"p.tga"},
        fuzz::FileKind{"p.hdr"}, fuzz::FileKind{"p.webp"}, fuzz::FileKind{"p.pnm"}};
    static const fuzz::InputFolder folder;
    const auto path = fuzz::write_as_kind(folder, fuzz::text_of(data, size), kinds);
    static_cast<void>(io::read_image(path));
    if (const auto read = io::read_channels(path)) {
        fuzz::expect(read->cols > 0 && read->rows > 0 && read->count > 0, "a picture of some size");
    }
    return 0;
}

// Pictures of all formats: as colours, and as channels.
#include <array>

#include "engine/io/image/channels.h"
#include "engine/io/image/image.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {

void picture_target(std::string_view input) {
    constexpr std::array kinds{FileKind{"p.png"}, FileKind{"p.jpg"},  FileKind{"p.tif"},
                               FileKind{"p.exr"}, FileKind{"p.bmp"},  FileKind{"p.tga"},
                               FileKind{"p.hdr"}, FileKind{"p.webp"}, FileKind{"p.pnm"}};
    static const InputFolder folder;
    const auto path = write_as_kind(folder, input, kinds);
    static_cast<void>(io::read_image(path));
    if (const auto read = io::read_channels(path)) {
        expect(read->cols > 0 && read->rows > 0 && read->count > 0, "a picture of some size");
    }
}

} // namespace reljef::fuzz

#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include <glm/vec2.hpp>

#include "engine/core/color.h"

namespace reljef::io {

/// Encodes an opaque picture as PNG in sRGB, some rows at a time from the top, with the bytes that
/// OpenImageIO would write: its libraries take longer to load than many a picture to draw.
class PngStream {
public:
    /// Takes encoded bytes; false if it cannot.
    using Sink = std::function<bool(std::span<const std::byte>)>;

    PngStream(glm::ivec2 size, Sink sink);
    PngStream(const PngStream&) = delete;
    PngStream& operator=(const PngStream&) = delete;
    ~PngStream();

    /// The next rows, as wide as the picture. False if that fails; then error() says why.
    bool write(const Image& rows);
    /// After all rows.
    bool end();
    [[nodiscard]] const std::string& error() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace reljef::io

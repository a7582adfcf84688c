#pragma once

#include <algorithm>

namespace reljef::material {

/// The surface beyond a tile: copies of the tile, its border texels, nothing.
enum class WrapMode { wrap, clamp, discard };

/// The index of the texel at any `index`: wrapped, else clamped. Precondition: count > 0.
inline int index_beyond(int index, int count, WrapMode border) {
    return border == WrapMode::wrap ? ((index % count) + count) % count
                                    : std::clamp(index, 0, count - 1);
}

} // namespace reljef::material

#pragma once

#include <algorithm>

namespace reljef::material {

/// What lies beyond a tile: its own copies; its border, drawn out for ever; nothing.
enum class WrapMode { wrap, clamp, discard };

/// Which of `count` texels lies at an index that may be beyond them: that of the next copy, or else
/// that at the border. Precondition: count > 0.
inline int index_beyond(int index, int count, WrapMode border) {
    return border == WrapMode::wrap ? ((index % count) + count) % count
                                    : std::clamp(index, 0, count - 1);
}

} // namespace reljef::material

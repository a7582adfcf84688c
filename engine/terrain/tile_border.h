#pragma once

namespace reljef::terrain {

/// What lies beyond a tile: its own copies; its border, drawn out for ever; nothing.
enum class TileBorder { wrap, clamp, discard };

} // namespace reljef::terrain

#pragma once

#include <string>

#include "engine/core/color.h"

struct ImFont;

namespace reljef::app {

/// The fonts of the panels. They belong to the current ImGui context.
struct Fonts {
    ImFont* text = nullptr;
    ImFont* heading = nullptr;
    ImFont* small = nullptr;
    ImFont* figure = nullptr; ///< large numbers
    std::string note;         ///< empty, or a sentence: no font with accents was found
};

/// Colours of the panels, sRGB.
namespace palette {
inline constexpr Rgba8 surface{31, 36, 42, 255}; ///< behind text; opaque, see KeptPicture
inline constexpr Rgba8 raised{42, 48, 56, 255};  ///< lists and tips
inline constexpr Rgba8 field{255, 255, 255, 18};
inline constexpr Rgba8 field_hovered{255, 255, 255, 34};
inline constexpr Rgba8 grab{255, 255, 255, 90}; ///< of a scroll bar
inline constexpr Rgba8 line{255, 255, 255, 26};
inline constexpr Rgba8 text{236, 239, 242, 255};
inline constexpr Rgba8 muted{166, 175, 185, 255};
inline constexpr Rgba8 accent{236, 174, 92, 255}; ///< ochre: what is chosen, and what one drags
inline constexpr Rgba8 accent_soft{236, 174, 92, 56};
inline constexpr Rgba8 warning{255, 138, 110, 255};
} // namespace palette

/// Sets sizes and colours of the current ImGui context and loads its fonts. `scale`: pixels per
/// unit of text.
Fonts apply_theme(float scale);

} // namespace reljef::app

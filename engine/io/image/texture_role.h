#pragma once

#include <optional>
#include <string_view>

namespace reljef::io {

/// Which map of a texture set a file is.
enum class TextureRole { color, heights, normals, layers, back_heights, mask };

/// "colours"
std::string_view to_string(TextureRole role);

/// By the whole words of a file's name, less its extension: words end at what is no letter and
/// where small letters are followed by a capital. The first of these that is among them: layers;
/// mask, alpha, opacity; back, at the name's end or beside height; normal(s), norm, nor, nrm;
/// height(s), disp(lacement); col(our), clr, diff(use), albedo. Nothing where none is.
std::optional<TextureRole> texture_role(std::string_view stem);

} // namespace reljef::io

#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "engine/core/result.h"
#include "engine/material/relief_material.h"

namespace reljef::io {

/// Which map of a texture set a file is.
enum class TextureRole { color, heights, normals, layers, back_heights, mask };

/// Plural noun for messages: "colours".
std::string_view to_string(TextureRole role);

/// The role that a file's name (without extension) states; absent if none. The first match among
/// whole words: layers; mask, alpha, opacity; back (last, or beside a word for height); normal(s),
/// norm, nor, nrm; height(s), disp(lacement); col(our), clr, diff(use), albedo. Words end at
/// non-letters and before a capital after a small letter.
std::optional<TextureRole> texture_role(std::string_view stem);

/// The files of one detail texture. Empty paths are absent.
struct TextureFiles {
    std::filesystem::path color;
    std::filesystem::path heights;     ///< first channel; empty: the alpha channel of `normals`
    std::filesystem::path normals;     ///< r, g, b for x, y, z; empty: derived from the heights
    std::filesystem::path layers = {}; ///< r, g, b, a: increasing depths of four layers
    std::filesystem::path back_heights = {}; ///< back of a sheet, first channel
    std::filesystem::path mask = {};         ///< first channel; below 0.5 a hole of height 0
};

struct TextureOptions {
    float scale = 0.05F; ///< maximum height in tile widths; > 0
    double width = 1.0;  ///< tile width in metres, for the notes; > 0
    material::WrapMode border = material::WrapMode::wrap;
};

/// Finds the pictures of a folder by their roles. A single picture without a role is the colour.
/// Fails if colours or heights are missing or a role is ambiguous.
Result<TextureFiles> find_texture_files(const std::filesystem::path& folder);

/// Reads a texture set. Heights are in [0,1]; 8-bit heights add a note on their resolution. Flips
/// normals whose y contradicts the heights. Layers without heights use the top layer's. Fails as
/// material::completed and material::LayerMap::create, and for a file that is unreadable, lacks a
/// channel, or has a height outside [0,1] or a colour or mask that is not finite.
Result<material::ReliefMaterial> read_texture_set(const TextureFiles& files,
                                                  const TextureOptions& options = {});

} // namespace reljef::io

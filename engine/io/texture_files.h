#pragma once

#include <filesystem>

#include "engine/core/result.h"
#include "engine/terrain/texture_set.h"

namespace reljef::io {

/// The files of one tile of surface detail. Any picture OpenImageIO opens.
struct TextureFiles {
    std::filesystem::path color;
    std::filesystem::path heights; ///< first channel; empty: the alpha channel of `normals`
    std::filesystem::path normals; ///< r, g, b for x, y, z; empty: made from the heights
};

struct TextureOptions {
    float scale = 0.05F; ///< a height of 1 lifts a point so many tile widths; > 0
    double width = 1.0;  ///< metres that the tile covers, for the notes; > 0
    terrain::TileBorder border = terrain::TileBorder::wrap;
};

/// The files in a folder by what their names say: normal, height, disp(lacement); col(our), clr,
/// diff(use), albedo, or, beside another map, the one that is left. Fails where no colour or no
/// heights are found.
Result<TextureFiles> find_texture_files(const std::filesystem::path& folder);

/// Heights in [0,1] of the values the file can hold; those of 8 bits get a note that tells their
/// quantum in metres. Normals whose green points against the rows are turned, when the heights say
/// so. Fails as terrain::completed, and where a file cannot be read or lacks a channel.
Result<terrain::TextureSet> read_texture_set(const TextureFiles& files,
                                             const TextureOptions& options = {});

} // namespace reljef::io

#pragma once

#include <filesystem>

#include "engine/core/result.h"
#include "engine/material/relief_material.h"

namespace reljef::io {

/// The files of one tile of surface detail. Any picture OpenImageIO opens.
struct TextureFiles {
    std::filesystem::path color;
    std::filesystem::path heights; ///< first channel; empty: the alpha channel of `normals`
    std::filesystem::path normals; ///< r, g, b for x, y, z; empty: made from the heights
    /// r, g, b, a: how deep below the highest the four layers lie, each no less than the one
    /// before; empty: none.
    std::filesystem::path layers = {};
    std::filesystem::path back_heights =
        {};                          ///< off the back of a sheet, first channel; empty: none
    std::filesystem::path mask = {}; ///< first channel; where it is below a half there is a hole:
                                     ///< height 0; empty: none
};

struct TextureOptions {
    float scale = 0.05F; ///< height of 1, in tile widths; > 0
    double width = 1.0;  ///< metres that the tile covers, for the notes; > 0
    material::WrapMode border = material::WrapMode::wrap;
};

/// The pictures in a folder by what their names say (texture_role.h); of colours, where no name
/// says it, the one that is left. Fails where no colour or no heights are found, and where two
/// files are the same map.
Result<TextureFiles> find_texture_files(const std::filesystem::path& folder);

/// Heights in [0,1] of the values the file can hold; those of 8 bits get one note that tells their
/// quantum in metres. Normals whose green points against the rows are turned, when the heights say
/// so. Layers without heights are seen from above. Fails as terrain::completed and
/// terrain::LayerMap::create, and where a file cannot be read, lacks a channel, or holds a height
/// outside [0,1] or a colour or mask that is not finite, with the first such place.
Result<material::ReliefMaterial> read_texture_set(const TextureFiles& files,
                                                  const TextureOptions& options = {});

} // namespace reljef::io

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/io/image/channels.h"
#include "engine/material/color_relief.h"
#include "engine/material/relief_material.h"

namespace reljef::io {

enum class MapKind { heights, normals, combined, cones, relaxed_cones, layers };
enum class MapInput { heights, normals, colors };

struct SurfaceMapOptions {
    MapInput input = MapInput::heights;
    material::WrapMode border = material::WrapMode::wrap;
    double scale = 0.05;       ///< maximum height in widths; > 0
    bool green_up = false;     ///< y of stored normals grows upwards
    bool sobel = false;        ///< Sobel filter for normals
    bool dark_is_high = false; ///< colours only
    int octaves = material::ColorReliefOptions{}.octaves;
    ParallelOptions parallel; ///< progress of cones only
};

struct PictureHeights {
    Grid<float> heights; ///< [0,1]
    std::vector<std::string> notes;
};

/// Reads the heights of a picture, or derives them from its normals or colours. Fails for an
/// unreadable or unsuitable picture and if stopped.
Result<PictureHeights> heights_of_picture(const std::filesystem::path& picture,
                                          const SurfaceMapOptions& options);

/// A map as stored in its file. `back`: heights of a sheet's back for layers; empty: symmetric.
/// `as_floats`: cones as ratios, else as sqrt(ratio / widest cone). Fails if stopped.
Result<Channels> make_map(const Grid<float>& heights, MapKind kind, const Grid<float>& back,
                          bool as_floats, const SurfaceMapOptions& options);

} // namespace reljef::io

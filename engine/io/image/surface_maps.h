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

/// What a map holds.
enum class MapKind { heights, normals, combined, cones, relaxed_cones, layers };
/// What a picture shows that maps are made from.
enum class MapInput { heights, normals, colors };

/// How maps of surface detail are made.
struct SurfaceMapOptions {
    MapInput input = MapInput::heights;
    material::WrapMode border = material::WrapMode::wrap;
    double scale = 0.05;       ///< height of 1, in widths; > 0
    bool green_up = false;     ///< y of stored normals grows against the rows
    bool sobel = false;        ///< normals by Sobel's filter
    bool dark_is_high = false; ///< of colours
    int octaves = material::ColorReliefOptions{}.octaves;
    ParallelOptions parallel; ///< progress: of cones
};

struct PictureHeights {
    Grid<float> heights; ///< [0,1]
    std::vector<std::string> notes;
};

/// The heights of a picture: its own, or made from its normals or colours. Notes say what is odd
/// about them. Fails where the picture cannot be read or is not what it should be, and when it is
/// stopped.
Result<PictureHeights> heights_of_picture(const std::filesystem::path& picture,
                                          const SurfaceMapOptions& options);

/// A map of these heights as its file holds it. `back`: heights off the back of a sheet, of the
/// same size, for layers; empty: symmetric. `as_floats`: cones are ratios; else the root of their
/// share of the widest. Fails when it is stopped.
Result<Channels> make_map(const Grid<float>& heights, MapKind kind, const Grid<float>& back,
                          bool as_floats, const SurfaceMapOptions& options);

} // namespace reljef::io

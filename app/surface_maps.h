#pragma once

#include <array>
#include <stop_token>
#include <string>

#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/io/image/channels.h"
#include "engine/material/color_relief.h"
#include "engine/material/texture_set.h"

namespace reljef::app {

/// What a map says of a surface.
enum class MapKind { heights, normals, combined, cones, relaxed_cones, layers };
/// What the picture shows that maps are made from.
enum class MapInput { heights, normals, colors };

struct MapOutput {
    MapKind kind;
    std::string option;
    std::string file; ///< empty: not asked for
};

/// How maps of surface detail are made from a picture, as asked for.
struct MapChoice {
    std::string picture;
    std::string back; ///< heights of it; empty: none
    MapInput input = MapInput::heights;
    material::TileBorder border = material::TileBorder::wrap;
    double scale = 0.05;   ///< a height of 1 lifts a point so many widths
    bool green_up = false; ///< y of stored normals
    bool sobel = false;
    bool dark_is_high = false;
    int octaves = material::ColorReliefOptions{}.octaves;
    int threads = 0;
    bool quiet = false;
    std::array<MapOutput, 6> outputs{{{MapKind::heights, "--heights", {}},
                                      {MapKind::normals, "--normals", {}},
                                      {MapKind::combined, "--combined", {}},
                                      {MapKind::cones, "--cones", {}},
                                      {MapKind::relaxed_cones, "--relaxed-cones", {}},
                                      {MapKind::layers, "--layers", {}}}};
};

/// The heights of the picture in [0,1]: its own, or made from its normals or colours. Notes on
/// stderr what is odd about them. Fails where the picture cannot be read or is not what it should
/// be, and when it is stopped.
Result<Grid<float>> heights_of_picture(const MapChoice& choice, const std::stop_token& stop);

/// A map of these heights, as its file holds it. Fails when it is stopped, and on a back that is
/// no back of them.
Result<io::Channels> make_map(const MapChoice& choice, const Grid<float>& heights,
                              const MapOutput& output, const std::stop_token& stop);

} // namespace reljef::app

#pragma once

#include <string_view>

/// The lines that reljef-bench sends to a program that draws with another library. Each is answered
/// by a line that begins with "ok", or with "failed" and a sentence.
///
///   view EX EY EZ LX LY LZ NEAR FAR sets eye and target (east, north, up; metres)
///   draw                            draws a frame: "ok MILLISECONDS TRIANGLES"
///   depth FILE                      draws a frame and writes its depths: floats from 0 at NEAR to
///                                   1 at FAR, linear in 1 / depth; the bottom row first
///   quit
///
/// Irrlicht's program also knows:
///
///   lods N                          builds the terrain with at most N levels
///   relief                          builds a flat square with the parallax material instead
///   samples AXIS FILE               draws the relief and writes the sample that each pixel shows,
///                                   along AXIS (0: columns, 1: rows), as floats to 1/4096 of the
///                                   terrain; -1: none; the bottom row first
///
/// Arguments: WIDTH HEIGHT FOV (degrees, vertical) SIDE (samples, 2^n+1) EASTWARD NORTHWARD (metres
/// between samples) HEIGHTS (a file of floats; columns from the west, each from the south) COLORS
/// (a file of bytes r g b by rows, SIDE × SIDE).
namespace reljef::bench::baseline {

inline constexpr std::string_view irrlicht_program = "reljef-bench-irrlicht";
inline constexpr std::string_view openscenegraph_program = "reljef-bench-openscenegraph";

} // namespace reljef::bench::baseline

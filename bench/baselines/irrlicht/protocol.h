#pragma once

#include <string_view>

/// What reljef-bench says to the program that draws with Irrlicht, a line each, and what it
/// answers: a line that begins with "ok", or "failed" and a sentence.
///
///   lods N                          builds the terrain with at most N levels
///   view EX EY EZ LX LY LZ NEAR FAR places the eye (east, north, up; metres) and what it looks at
///   draw                            draws a frame: "ok MILLISECONDS TRIANGLES"
///   depth FILE                      draws one and writes its depths, floats from 0 at NEAR to
///                                   1 at FAR, 1 / depth even between; row 0 at the bottom
///   quit
///
/// Its arguments: WIDTH HEIGHT FOV (degrees, vertical) SIDE (samples, 2^n+1) EASTWARD
/// NORTHWARD (metres between samples) HEIGHTS (a file of floats, column by column from the west,
/// each from the south) COLORS (a file of bytes r g b, row by row, SIDE × SIDE).
namespace reljef::bench::baseline {

inline constexpr std::string_view program_name = "reljef-bench-irrlicht";

} // namespace reljef::bench::baseline

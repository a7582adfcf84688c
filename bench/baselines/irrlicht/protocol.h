#pragma once

#include <string_view>

/// The lines that reljef-bench sends to the program that draws with Irrlicht. Each is answered by a
/// line that begins with "ok", or with "failed" and a sentence.
///
///   lods N                          builds the terrain with at most N levels
///   view EX EY EZ LX LY LZ NEAR FAR sets eye and target (east, north, up; metres)
///   draw                            draws a frame: "ok MILLISECONDS TRIANGLES"
///   depth FILE                      draws a frame and writes its depths: floats from 0 at NEAR to
///                                   1 at FAR, linear in 1 / depth; the bottom row first
///   quit
///
/// Arguments: WIDTH HEIGHT FOV (degrees, vertical) SIDE (samples, 2^n+1) EASTWARD NORTHWARD (metres
/// between samples) HEIGHTS (a file of floats; columns from the west, each from the south) COLORS
/// (a file of bytes r g b by rows, SIDE × SIDE).
namespace reljef::bench::baseline {

inline constexpr std::string_view program_name = "reljef-bench-irrlicht";

} // namespace reljef::bench::baseline

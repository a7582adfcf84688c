#pragma once

namespace reljef::render {

/// What the driver skips; all of it by default. Nothing of it changes the picture, but beams move
/// hits by what floats round: to measure what each saves.
struct Skips {
    bool beams = true;    ///< the way on which the beam of a block of pixels meets nothing
    bool blocks = true;   ///< blocks of the maximum mipmap that are below the ray
    bool uploads = true;  ///< content that is in GPU memory already
    bool cuts = true;     ///< new triangles for tiles that keep theirs
    bool features = true; ///< shader code for a sun or air that the scene lacks
    bool certain = true;  ///< sun rays from where it is certain whether the sun is seen
};

} // namespace reljef::render

#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include <glm/vec2.hpp>

#include "engine/core/atomic_file.h"
#include "engine/core/color.h"
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/session/frame_maker.h"
#include "engine/session/scene_setup.h"

namespace reljef::session {

/// Of a frame, pixels: every OpenGL 4.5 has textures of this size.
inline constexpr int max_frame_side = 16384;

/// Whether a picture is too large for one frame: over 16,384 pixels a side, or over 4096² pixels.
bool needs_parts(glm::ivec2 size);

/// A picture that is drawn in parts: rows of parts from the top, one after the other. Each is the
/// middle of a frame: which pixels have several samples depends on those around them.
struct PictureParts {
    static constexpr int margin = 32; ///< pixels on each side

    glm::ivec2 picture{0}; ///< size, pixels
    glm::ivec2 part{0}; ///< size of each, a multiple of 64; the last ones reach beyond the picture

    [[nodiscard]] glm::ivec2 frame() const { return part + 2 * margin; }
};

/// Parts whose rows, and frames, take at most a quarter of the memory, or parts of 64 rows.
PictureParts parts_of(glm::ivec2 picture, int memory_megabytes);

struct LargePicture {
    std::filesystem::path file; ///< .png, .tif
    PictureParts parts;
    /// Draws over finished rows of the picture; absent: nothing. `first`: the pixel at rows(0, 0).
    std::function<void(GridView<Rgba8> rows, glm::ivec2 first)> paint_over = {};
};

/// Draws the camera's view in parts, and writes each row of parts before the next one is drawn; the
/// file is ready for commit(). `maker` draws frames of PictureParts::frame(). The pixels are those
/// of one frame: by rays on a plane the same bits, otherwise up to the rounding of floats. Fails as
/// io::PictureWriter, if a frame cannot be drawn, and with "interrupted" after a stop.
Result<AtomicFile> draw_large_picture(const LargePicture& picture, TerrainScene& scene,
                                      FrameMaker& maker, const ParallelOptions& parallel);

} // namespace reljef::session

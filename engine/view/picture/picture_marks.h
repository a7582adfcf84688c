#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/scene/graph/camera.h"

namespace reljef::view {

struct LegendStop {
    double height = 0.0; ///< true metres
    Rgba8 color;
};

/// What explains a finished picture, to be drawn over it.
struct PictureMarks {
    /// Of lengths across the picture.
    struct Scale {
        double metres_per_pixel = 0.0;
        bool is_everywhere = true; ///< false: at the picture's middle alone, where a mark is drawn
    };

    std::vector<LegendStop> legend; ///< upwards, at least two heights; empty: none
    std::optional<Scale> scale;
    std::optional<double> north; ///< degrees clockwise from up in the picture

    [[nodiscard]] bool empty() const { return legend.empty() && !scale && !north; }
};

/// Smaller pictures have no room for marks, pixels.
inline constexpr glm::ivec2 min_marked_picture{160, 120};

/// The height of digits in the marks of a picture of `size` pixels, pixels.
double mark_digit_height(glm::ivec2 size);

/// The left end of the scale bar; the other one is ScaleBar::pixels to the right.
glm::dvec2 begin_of_scale_bar(glm::ivec2 size);
double max_scale_bar(glm::ivec2 size); ///< ScaleBar::pixels at most

/// The half-transparent plates below the marks of a picture of `size` pixels.
std::vector<scene::PicturePart> mark_plates(const PictureMarks& marks, glm::ivec2 size);

/// Draws the legend at the lower right, the scale bar at the lower left, and the north arrow at the
/// upper right of a picture of `size` pixels. `first`: its pixel at part(0, 0); the pixels do not
/// depend on the parts. Precondition: the size is at least min_marked_picture.
void draw_marks(const PictureMarks& marks, glm::ivec2 size, GridView<Rgba8> part,
                glm::ivec2 first = {0, 0});

} // namespace reljef::view

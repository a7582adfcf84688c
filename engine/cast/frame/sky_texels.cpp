#include "engine/cast/frame/sky_texels.h"

#include "engine/cast/lit_levels.h"
#include "engine/core/parallel_for.h"

namespace reljef::cast {

const SkyPaint* SkyTexels::prepare(const view::DrawList& list) {
    if (!list.sky_picture) {
        return nullptr;
    }
    const auto& [picture, picture_from_world, level] = *list.sky_picture;
    if (picture_.lock() != picture || level_ != level || texels_.empty()) {
        const auto& [side, faces] = picture->levels()[level];
        texels_.resize(faces.size());
        const auto cols = static_cast<std::size_t>(faces.cols());
        parallel_for(faces.rows(), [&, &shown = faces](int row) {
            const auto from = shown.row(row);
            for (std::size_t col = 0; col < cols; ++col) {
                texels_[static_cast<std::size_t>(row) * cols + col] =
                    packed_roots(linear_from_rgba8(from[col]));
            }
        });
        picture_ = picture;
        level_ = level;
        paint_.texels = texels_.data();
        paint_.side = side;
    }
    paint_.picture_from_world = glm::mat3(picture_from_world);
    return &paint_;
}

} // namespace reljef::cast

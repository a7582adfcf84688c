#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/cast/packet/block_kernel.h"
#include "engine/view/draw_list.h"

namespace reljef::cast {

/// The level of a sky's picture that a view shows, for rays. Made anew for another level.
class SkyTexels {
public:
    /// Null: the sky is no picture. Valid as long as this object, until the next call.
    const SkyPaint* prepare(const view::DrawList& list);

private:
    std::weak_ptr<const material::SkyPicture> picture_;
    std::size_t level_ = 0;
    std::vector<std::uint32_t> texels_;
    SkyPaint paint_;
};

} // namespace reljef::cast

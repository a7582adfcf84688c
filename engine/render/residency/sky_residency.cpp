#include "engine/render/residency/sky_residency.h"

#include <utility>

#include "engine/render/residency/uploads.h"
#include "engine/render/shaders/bindings.h"

namespace reljef::render {

Result<void> SkyResidency::prepare(const view::DrawList& list, view::FrameStats& stats) {
    if (!list.sky_picture) {
        faces_.reset();
        return {};
    }
    const auto& picture = list.sky_picture->picture;
    const std::size_t level = list.sky_picture->level;
    if (faces_ && picture_.lock() == picture && level_ == level) {
        return {};
    }
    const material::SkyPicture::Level& shown = picture->levels()[level];
    auto faces = upload_grid(shown.faces, {.format = gl::Format::rgba8_srgb}, stats);
    if (!faces) {
        return faces.error();
    }
    faces_ = std::move(*faces);
    picture_ = picture;
    level_ = level;
    side_ = shown.side;
    return {};
}

void SkyResidency::bind() const {
    if (faces_) {
        faces_->bind(bindings::sky_faces_unit);
    }
}

} // namespace reljef::render

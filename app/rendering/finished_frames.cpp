#include "app/rendering/finished_frames.h"

#include <cstddef>
#include <system_error>
#include <utility>

#include "engine/io/image/image.h"

namespace reljef::app {

std::optional<Image> finished_picture(const std::filesystem::path& file, glm::ivec2 size) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) {
        return std::nullopt;
    }
    auto picture = io::read_undamaged_image(file);
    return picture && picture->cols() == size.x && picture->rows() == size.y
               ? std::optional(std::move(*picture))
               : std::nullopt;
}

std::vector<int> frames_of(const Shard& shard, int frames) {
    std::vector<int> own;
    for (int frame = 0; frame < frames; ++frame) {
        if (shard.has(static_cast<std::size_t>(frame))) {
            own.push_back(frame);
        }
    }
    return own;
}

} // namespace reljef::app

#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/parallel_for.h"

namespace reljef::app {

/// The picture of an earlier run; absent if there is none, or it is damaged or of another size.
std::optional<Image> finished_picture(const std::filesystem::path& file, glm::ivec2 size);

/// The frames of a shard, of `frames` in all.
std::vector<int> frames_of(const Shard& shard, int frames);

} // namespace reljef::app

#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/io/formats/scene_file.h"
#include "engine/session/scene_setup.h"
#include "engine/view/picture/picture_marks.h"

namespace reljef::session {

/// The colours of level ground by height, over the terrain's range. Empty if the ramp colours
/// nothing: of models, of images that show no ramp, and of ground at one height.
std::vector<view::LegendStop> legend_of(const TerrainScene& scene);

struct SceneMarks {
    view::PictureMarks marks;
    std::vector<std::string> notes; ///< what is not drawn, and why
};

/// Marks for a picture of `size` pixels from the scene's camera. The scale is right everywhere
/// without perspective, else for lengths across the view on the ground in the picture's middle.
/// North is that of the camera's place: up in the picture is ahead, as on a compass held level.
SceneMarks marks_of(const TerrainScene& scene, const io::MarksDescription& chosen, glm::ivec2 size);

} // namespace reljef::session

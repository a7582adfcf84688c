#pragma once

#include <string_view>

#include "engine/scene/graph/mesh.h"

namespace reljef::scene {

/// Text as squares of a font of 5 by 7 dots, to be read from −y: x goes along the lines, z up.
/// Lines are centred on x = 0; the last one stands on z = 0. `height`: of a capital letter, metres.
/// Has the characters of ASCII and line breaks; each other character is a question mark. Its
/// normals point up: as a label, it has the light of level ground, from wherever it is seen.
Mesh text_mesh(std::string_view text, float height);

} // namespace reljef::scene

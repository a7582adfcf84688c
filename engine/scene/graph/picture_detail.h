#pragma once

#include <memory>
#include <string>

#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/scene/graph/surface_detail.h"

namespace reljef::scene {

// A picture on a mesh is a detail tile without relief, drawn with the technique `texture`.

/// The material of a picture on a mesh, which neither shines nor has relief. Fails without texels.
Result<std::shared_ptr<const material::ReliefMaterial>> picture_material(Image picture,
                                                                         std::string name);

/// Whether the detail is a picture on the mesh itself. Hits of such a mesh are those of a mesh
/// without detail.
bool is_picture(const SurfaceDetail& detail);

} // namespace reljef::scene

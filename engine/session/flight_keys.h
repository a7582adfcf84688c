#pragma once

#include <string>
#include <vector>

#include "engine/io/formats/flight_file.h"
#include "engine/scene/graph/terrain_node.h"
#include "engine/scene/motion/camera_path.h"

namespace reljef::session {

/// The keyframes of a flight on Earth, along the geodesics from key to key. Adds keyframes between
/// distant keys, so that the path stays within a metre of the geodesics (less exactly in a flight
/// of a million kilometres). The last of several keys at one time counts. Keys without a height are
/// 300 m above the ground of the surface. A key looks along its angles, or towards the next
/// keyframe; those between interpolate. Fails for a terrain without a place on Earth, and for keys
/// beside its map; `name`: the file, for the error.
Result<std::vector<scene::Keyframe>> flight_keys(const scene::TerrainSurface& surface,
                                                 std::vector<io::GeodeticKey> keys,
                                                 const std::string& name);

/// A path as a flight to save: keys on Earth with angles, or in scene metres for a terrain without
/// a place on Earth. Fails for keys beside the terrain's map.
Result<io::Flight> flight_of(const scene::TerrainSurface& surface, const scene::CameraPath& path);

} // namespace reljef::session

#pragma once

#include <string>
#include <vector>

#include "engine/io/formats/flight_file.h"
#include "engine/scene/graph/terrain_node.h"
#include "engine/scene/motion/camera_path.h"

namespace reljef::session {

/// A flight on Earth as keys in the scene, along the geodesics from key to key: between keys that
/// are far apart there are more, so that the path is within a metre of the way (in a flight of a
/// million kilometres less exactly). Of keys at one time the last counts. Keys without a height
/// stand 300 m above the ground of the surface; no other is moved. The file's keys look along their
/// angles, else to the next of all keys, as a rule at most 3 km on; those between turn from one
/// look to the next. Fails for a terrain without a place on Earth, and for keys beside its map;
/// `name` is the file's, for the error.
Result<std::vector<scene::Keyframe>> flight_keys(const scene::TerrainSurface& surface,
                                                 std::vector<io::GeodeticKey> keys,
                                                 const std::string& name);

} // namespace reljef::session

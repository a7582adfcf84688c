#pragma once

#include <string>
#include <vector>

#include "engine/io/formats/flight_file.h"
#include "engine/scene/graph/terrain_node.h"
#include "engine/scene/motion/camera_path.h"
#include "engine/session/log.h"
#include "engine/session/scene_setup.h"

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

/// The camera path `name`: "orbit", "flyover" or a path file, whose notes are logged.
Result<scene::CameraPath> open_path(const TerrainScene& scene, const std::string& name, Log& log);

/// Whether `name` is a path file, not a built-in path or a measured track (GPX, KML, GeoJSON).
bool is_path_file(const std::string& name);

/// Moves the camera to frame `index` of `frames` evenly spread along a path, even under the ground
/// (see fly_above_ground in frame_maker.h).
void fly_to(TerrainScene& scene, const scene::CameraPath& path, int index, int frames);

} // namespace reljef::session

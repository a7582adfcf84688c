#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/result.h"
#include "engine/session/terrain_source.h"
#include "engine/terrain/measure/profile.h"

namespace reljef::session {

struct ProfileRequest {
    glm::dvec2 from{0.0};       ///< latitude and longitude, degrees
    glm::dvec2 to{0.0};         ///< latitude and longitude, degrees
    std::optional<double> step; ///< metres at most; absent: half of the finest file's spacing
};

/// Heights along a geodesic, at full resolution.
struct TerrainProfile {
    std::vector<glm::dvec2> places; ///< latitude and longitude, degrees
    std::vector<terrain::ProfilePoint> points;
    std::vector<FileError> errors; ///< of files that could not be read
};

/// Reads the profile from the source files, whatever the size of the terrain. Fails if no place of
/// it lies on the terrain, for too many points, and when stopped.
Result<TerrainProfile> profile_of(const HeightSource& source, const ProfileRequest& request,
                                  const std::string& name, const std::stop_token& stop = {});

/// "distance,latitude,longitude,height" and a line for each point; heights may be nan.
std::string profile_csv(const TerrainProfile& profile);

} // namespace reljef::session

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/io/formats/scene_file.h"
#include "engine/scene/streaming/light.h"
#include "engine/session/options.h"
#include "engine/session/scene_setup.h"

namespace reljef::session {

/// True north at the terrain's middle, degrees clockwise from the scene's north (+y): on a plane,
/// the convergence of its grid. Empty without a place on Earth.
std::optional<double> true_north(const TerrainScene& scene);

/// What a picture of the whole terrain is filled with, scene metres: of an island the land with
/// some sea around it, else all of the terrain. Of one that is over max_spire times as high as
/// wide, by spikes or a large exaggeration, the heights around the median: all of it is a line.
Box whole_bounds(const TerrainScene& scene);

/// Notes on heights that a picture of the whole terrain cannot show: a spire, or so few samples
/// that no ground lies between them.
std::vector<std::string> shape_notes(const terrain::Terrain& terrain, double exaggeration);
inline constexpr double max_spire = 10.0;

/// Adds the sun, the sky, the air, and lights besides the sun, as the options name them, else the
/// scene file. Reads a picture of the sky. Notes a base that the terrain cannot have. Usage errors
/// with a time: a terrain without a place on Earth, a sun below the horizon of its middle.
Result<void> add_daylight(TerrainScene& scene, const io::SceneDescription& description,
                          const SceneOptions& view, Log& log);

/// Shines a sun: sets the light with the colours of its altitude, sky, air, and what lies below the
/// terrain's edge. Precondition: `bounds` are those of the terrain as it is.
void set_daylight(TerrainScene& scene, scene::Light sun);

/// Gives the terrain its usual grain, unless the user named another: none with a ramp of one
/// colour, which would look like gravel, and no images.
void follow_ramp(TerrainScene& scene);

/// Gives the terrain its grain and contours. The floor of the gallery has none.
void set_overlay(TerrainScene& scene, const io::SceneDescription& description,
                 const SceneOptions& view);

} // namespace reljef::session

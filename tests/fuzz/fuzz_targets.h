#pragma once

#include <span>
#include <string_view>

namespace reljef::fuzz {

// Each reads an input as one reader's file. A property that does not hold is a Finding.

void bookmarks_target(std::string_view input);
void cache_target(std::string_view input);
void error_index_target(std::string_view input);
void flight_target(std::string_view input);
void footprints_target(std::string_view input);
void geoid_target(std::string_view input);
void hits_target(std::string_view input);
void imagery_target(std::string_view input);
void mesh_target(std::string_view input);
void picture_target(std::string_view input);
void place_target(std::string_view input);
void ramp_target(std::string_view input);
void raster_target(std::string_view input);
void results_target(std::string_view input);
void scene_target(std::string_view input);
void texture_target(std::string_view input);
void tile_index_target(std::string_view input);
void web_tile_target(std::string_view input);

} // namespace reljef::fuzz

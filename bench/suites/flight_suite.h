#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>

#include "app/cli/options.h"
#include "app/cli/raised_frames.h"
#include "bench/report/environment.h"
#include "engine/scene/tile_stream.h"
#include "engine/session/frame_maker.h"

namespace reljef::bench {

struct FlightOptions {
    cli::TerrainChoice terrain;
    cli::ViewChoice view; ///< with the path and how many frames
};

/// A flight along a path over a terrain that is read as the view needs it, each frame drawn once
/// all its tiles are there.
struct FlightResults {
    FlightOptions options;
    Environment environment;
    double seconds_to_first_frame = 0.0; ///< from opening the terrain
    double seconds = 0.0;                ///< all in all
    session::FrameTimes times;
    cli::RaisedFrames raised;
    std::optional<scene::TileStreamStats> stream; ///< absent where all fits the memory
    std::size_t failed_files = 0;
    std::size_t max_memory = 0;   ///< of the process, bytes
    std::optional<Error> stopped; ///< why there are fewer frames than asked for
};

/// Fails where there is no terrain, path or context.
Result<FlightResults> run_flight(const FlightOptions& options, const std::stop_token& stop);

/// Memory beyond that of the process before the terrain was read, as a share of what was allowed.
double memory_share(const FlightResults& results);

/// As JSON of the schema "reljef-bench-flight/1": times milliseconds, memory bytes.
std::string flight_json(const FlightResults& results);

/// Writes the file (an empty path: none) and prints the figures. Fails with FlightResults::stopped
/// too.
Result<void> report(const FlightResults& results, const std::filesystem::path& json);

} // namespace reljef::bench

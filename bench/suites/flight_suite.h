#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/cli/lifted_frames.h"
#include "app/cli/options.h"
#include "bench/report/figure_table.h"
#include "engine/scene/streaming/tile_stream.h"
#include "engine/session/frame_maker.h"

namespace reljef::bench {

struct FlightOptions {
    cli::TerrainChoice terrain;
    cli::ViewChoice view; ///< with a path and the number of frames
    /// Each frame is drawn when all its tiles are loaded; false: with those that are there.
    bool waits_for_tiles = true;
};

/// A flight over a streamed terrain.
struct FlightResults {
    FlightOptions options;
    Environment environment;
    double seconds_to_first_frame = 0.0; ///< from opening the terrain
    double seconds = 0.0;                ///< in total
    session::FrameTimes times;
    cli::LiftedFrames lifted;
    std::optional<scene::TileStreamStats> stream; ///< absent if not streamed
    std::string index = "none";                   ///< of the stream: none, partial or whole
    std::size_t failed_files = 0;
    std::size_t max_memory = 0;      ///< of the process, bytes
    std::vector<double> kept_errors; ///< of each frame, pixels; empty without an error bound
    int max_tiles_unproven = 0;      ///< of a frame
    RunEnd end;
};

/// Fails without a terrain, path or context.
Result<FlightResults> run_flight(const FlightOptions& options, const std::stop_token& stop);

/// Fails if files of the terrain were skipped.
Result<void> check_files(const FlightResults& results);

/// Without a row if there is no frame.
FigureTable figure_table(const FlightResults& results);

} // namespace reljef::bench

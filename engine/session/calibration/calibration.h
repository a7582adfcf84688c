#pragma once

#include <filesystem>
#include <string>

#include "engine/core/result.h"
#include "engine/platform/context.h"
#include "engine/session/scene_renderer.h"

namespace reljef::session {

/// Where costs were measured. They hold for no other place.
struct CalibrationPlace {
    std::string machine; ///< the processor
    std::string version; ///< of reljef
    std::string context; ///< as on the command line
    std::string renderer;

    friend bool operator==(const CalibrationPlace&, const CalibrationPlace&) = default;
};
CalibrationPlace place_of(const platform::RendererInfo& info, std::string version);

struct Calibration {
    CalibrationPlace place;
    Costs costs;

    friend bool operator==(const Calibration&, const Calibration&) = default;
};

/// "built-in", or else "frame 7.2 ms, triangle 110 ns, …", to four digits.
std::string costs_text(const Costs& costs);

/// A calibration file: JSON.
std::string to_text(const Calibration& calibration);
/// Fails on texts that are no calibration, and on costs that are negative or not finite; `file` is
/// named in the error.
Result<Calibration> parse_calibration(const std::string& text, const std::string& file);

/// A calibration in a file. Fails if it cannot be read, and as parse_calibration().
Result<Calibration> read_calibration(const std::filesystem::path& file);
/// The costs in a file. Fails if it cannot be read, or was measured in another place.
Result<Costs> read_costs(const std::filesystem::path& file, const CalibrationPlace& here);

} // namespace reljef::session

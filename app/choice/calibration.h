#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/cli/options.h"
#include "engine/core/result.h"
#include "engine/platform/context.h"
#include "engine/session/scene_renderer.h"

namespace reljef::app {

/// Where costs were measured. They hold for no other place.
struct CalibrationPlace {
    std::string machine; ///< the processor
    std::string version; ///< of reljef
    std::string context; ///< as on the command line
    std::string renderer;

    friend bool operator==(const CalibrationPlace&, const CalibrationPlace&) = default;
};
CalibrationPlace place_of(const platform::RendererInfo& info);

struct Calibration {
    CalibrationPlace place;
    session::Costs costs;

    friend bool operator==(const Calibration&, const Calibration&) = default;
};

/// A calibration file: JSON.
std::string to_text(const Calibration& calibration);
/// Fails on texts that are no calibration, and on costs that are negative or not finite; `file` is
/// named in the error.
Result<Calibration> parse_calibration(const std::string& text, const std::string& file);

/// The costs in a file. Fails if it cannot be read, or was measured in another place.
Result<session::Costs> read_costs(const std::filesystem::path& file, const CalibrationPlace& here);

/// The context of the options; if none is named, that of --calibration, whose costs hold there.
/// Fails if its file cannot be read.
Result<std::optional<session::BackendKind>> context_to_use(const cli::ViewChoice& view);

/// Lets a renderer use the costs of --calibration; does nothing without it. Fails as read_costs();
/// usage errors: a technique or a renderer that chooses nothing.
Result<void> use_calibration(const cli::ViewChoice& view, const platform::RendererInfo& info,
                             session::SceneRenderer& renderer);

} // namespace reljef::app

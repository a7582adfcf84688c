#pragma once

#include <optional>

#include "app/cli/options.h"
#include "engine/core/result.h"
#include "engine/platform/context.h"
#include "engine/session/scene_renderer.h"

namespace reljef::app {

/// The context of the options; if none is named, that of --calibration, whose costs hold there.
/// Fails if its file cannot be read.
Result<std::optional<session::BackendKind>> context_to_use(const cli::ViewChoice& view);

/// Lets a renderer use the costs of --calibration; does nothing without it. Fails as read_costs();
/// usage errors: a technique or a renderer that chooses nothing.
Result<void> use_calibration(const cli::ViewChoice& view, const platform::RendererInfo& info,
                             session::SceneRenderer& renderer);

} // namespace reljef::app

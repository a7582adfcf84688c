#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>

#include "engine/core/result.h"
#include "engine/session/options.h"
#include "engine/session/scene_setup.h"

namespace reljef::app {

/// What the viewer was started with.
struct StartOptions {
    session::SourceOptions source;
    session::SceneOptions scene;
    std::optional<session::BackendKind> context; ///< absent: auto
    std::string simd;
    bool allow_underground = false;
};

/// What the user changed since.
struct ShownState {
    scene::Technique technique;      ///< requested, of the terrain or of all models
    scene::Light light;              ///< requested
    double exaggeration = 1.0;       ///< requested
    glm::ivec2 size{0};              ///< of the window, pixels
    std::optional<int> samples = {}; ///< absent: automatic
    bool keeps_techniques = false;   ///< models have those of the start
    std::string ramp = {};           ///< a built-in one; empty: that of the start
    std::string compare = {};        ///< as --compare; empty: nothing is compared
    double wipe = 0.5;               ///< as --wipe
    bool shows_viewshed = false;     ///< over the ground
};

/// The text as one word of a POSIX shell.
std::string shell_word(std::string_view text);

/// "reljef render TERRAIN … -o view.png": draws what the window shows. Fails if no command does:
/// models with several techniques that the user chose.
Result<std::string> render_command(const StartOptions& start, const session::TerrainScene& scene,
                                   const ShownState& shown);

/// The line "copied: …" on a command that is in the clipboard, with what it does not draw.
std::string copied_text(const std::string& command, const ShownState& shown);

} // namespace reljef::app

#pragma once

#include <memory>
#include <optional>
#include <utility>

#include <glm/vec2.hpp>

#include "app/viewer/appearance/background.h"
#include "engine/session/log.h"
#include "engine/session/prepared_maps.h"
#include "engine/session/proven_tiles.h"
#include "engine/session/scene_setup.h"
#include "engine/session/streaming.h"

namespace reljef::app {

/// Proves the errors of a streamed terrain in the background. Then loads the view into a stream
/// with proofs, and shows it; the scene's source has the proofs from then on. The destructor stops;
/// finished parts of the index are kept.
class ProofSwitch {
public:
    /// The scene outlives this. Nothing to do if it is not streamed or already proven.
    explicit ProofSwitch(session::TerrainScene& scene);

    /// The next step, for a picture of `size` pixels. Returns whether the scene changed.
    bool update(glm::ivec2 size);
    /// The current task; its label is empty if there is none.
    [[nodiscard]] session::RelayedLog::TaskProgress progress() const { return log_.progress(); }
    /// Passes on messages since the last call.
    void relay_to(session::Log& log) { log_.relay_to(log); }
    /// The new stream's light for SceneRenderer::add_light(), once, else null.
    std::shared_ptr<const view::PreparedLight> take_light() {
        return std::exchange(light_, nullptr);
    }

private:
    using Proofs = std::shared_ptr<const session::ProvenTiles>;
    using Light = std::shared_ptr<const view::PreparedLight>;
    void prepare();
    void show();

    session::TerrainScene& scene_;
    session::RelayedLog log_;
    std::shared_ptr<const session::TerrainSource> proven_; // null: not yet
    session::StreamedSurface next_;                        // with proofs; null: not yet
    Light light_;
    std::optional<Background<Light>> lighting_;
    std::optional<Background<Proofs>> proving_; // uses the log
};

} // namespace reljef::app

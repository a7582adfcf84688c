#include "app/viewer/appearance/proof_switch.h"

#include "engine/session/terrain_index.h"

namespace reljef::app {
namespace {

constexpr unsigned proving_threads = 1; // drawing has the others

bool is_proven(const session::TerrainSource& source) {
    return source.proofs != nullptr && source.proofs->is_complete();
}

} // namespace

ProofSwitch::ProofSwitch(session::TerrainScene& scene) : scene_(scene) {
    if (scene.source != nullptr && !is_proven(*scene.source)) {
        proving_.emplace([source = scene.source, this](const std::stop_token& stop) {
            return session::make_proofs(*source, proving_threads, log_, stop);
        });
    }
}

bool ProofSwitch::update(glm::ivec2 size) {
    if (proving_ && proving_->is_done()) {
        auto proofs = proving_->take();
        proving_.reset();
        if (proofs) {
            session::TerrainSource source = *scene_.source;
            source.proofs = std::move(*proofs);
            proven_ = std::make_shared<const session::TerrainSource>(std::move(source));
            prepare();
        } else {
            log_.note(session::unproven_note(proofs.error()));
        }
    }
    if (next_.stream == nullptr || size.x == 0 || size.y == 0) { // minimized
        return false;
    }
    auto& terrain = *scene_.terrain->get<scene::TerrainNode>();
    if (next_.surface != terrain.surface) { // which has changed meanwhile
        prepare();
    }
    const bool is_loaded = session::load_view(scene_.scene, terrain, next_, size);
    if (!is_loaded || (lighting_ && !lighting_->is_done())) {
        return false;
    }
    show();
    return true;
}

void ProofSwitch::prepare() {
    const auto& terrain = *scene_.terrain->get<scene::TerrainNode>();
    next_ = {terrain.surface, session::make_stream(*proven_, terrain.surface)};
    auto request =
        session::light_request(scene_, *scene_.light->get<scene::Light>(),
                               terrain.material.technique, 0); // of a stream: no maps, no limit
    if (request) {
        request->stream = next_.stream;
        lighting_.emplace([request = std::move(*request)](const std::stop_token&) {
            return std::make_shared<const view::PreparedLight>(view::prepare_light(request));
        });
    }
}

void ProofSwitch::show() {
    if (auto light = lighting_ ? lighting_->take() : Light()) {
        light_ = std::move(*light);
    }
    lighting_.reset();
    scene_.terrain->get<scene::TerrainNode>()->stream = next_.stream;
    scene_.source = std::move(proven_);
    next_ = {};
}

} // namespace reljef::app

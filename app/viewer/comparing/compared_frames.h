#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "app/viewer/comparing/comparison.h"
#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/session/scene_renderer.h"
#include "engine/session/scene_setup.h"

namespace reljef::app {

/// Draws what a comparison shows on the right, and the picture of both. The technique on the right
/// has a renderer of its own, so that neither throws away what the other one needs.
class ComparedFrames {
public:
    using MakeRenderer = std::function<Result<session::SceneRenderer>()>;

    /// `left` has drawn the scene's frame. All outlive this. Destroy it while the OpenGL context is
    /// current.
    ComparedFrames(session::TerrainScene& scene, session::SceneRenderer& left, Comparison& chosen,
                   MakeRenderer make_renderer)
        : scene_(scene), left_(left), comparison_(chosen),
          make_renderer_(std::move(make_renderer)) {}

    /// Selects the frame of the technique on the right, and returns the tiles that it lacks.
    std::vector<view::TileRequests> select(int samples);
    /// Takes the frame that `left` has drawn, and draws that of the technique on the right.
    Result<void> draw();
    /// Begins to find the errors of the last frame. Precondition: it is that of the scene.
    Result<void> find_errors();
    /// Copies the picture of both to the window's back buffer.
    Result<void> show(glm::ivec2 window_size);
    /// What the window shows.
    [[nodiscard]] Image picture() const;

    void add_light(const std::shared_ptr<const view::PreparedLight>& light);
    /// Of the last frame on the right, if there is one.
    [[nodiscard]] std::optional<double> right_ms() const { return right_ms_; }

private:
    Result<void> prepare_right(int samples);
    Result<void> draw_right();
    [[nodiscard]] const Image* right_picture() const;

    session::TerrainScene& scene_;
    session::SceneRenderer& left_;
    Comparison& comparison_;
    MakeRenderer make_renderer_;
    std::optional<session::SceneRenderer> right_;
    bool is_selected_ = false; // the frame on the right
    std::optional<double> right_ms_;
    Image left_picture_;                               // empty: nothing is compared
    Image right_drawn_;                                // by the technique on the right
    std::shared_ptr<const view::PreparedLight> light_; // for the next renderer on the right
};

} // namespace reljef::app

#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/scene/graph/scene.h"
#include "engine/scene/streaming/tile_stream.h"
#include "engine/view/draw_list.h"
#include "engine/view/scene_view.h"

namespace reljef::view {

struct TileRequests {
    std::shared_ptr<scene::TileStream> stream;
    std::vector<terrain::TreeTile> missing; ///< to load, the most urgent first
    std::vector<terrain::TreeTile> used;    ///< in memory: to keep
    bool with_cones = false;                ///< as TileStream::request()
};

/// One frame: what is drawn and how, what should be loaded, and what was skipped and why
/// (DrawList::stats). Valid as long as the scene is unchanged.
struct FrameView {
    DrawList list;
    std::vector<TileRequests> requests; ///< one for each visible stream
};

struct SelectOptions {
    /// Drops tiles behind nearer ground. Without it they are requested and listed, too
    /// (TileDraw::is_hidden): to measure the effect on the picture.
    bool occlusion = true;
    /// Changes each selected list; equal lists must get equal results. Tiles that nearer ground
    /// hides are still in it: `drop_hidden` removes them. Empty: they are removed.
    std::function<void(DrawList&, const std::function<void()>& drop_hidden)> refine = {};
    /// Drops what is outside the frustum. Without it, meshes and terrains in memory are listed
    /// whole. Streams have no tiles there.
    bool frustum = true;
    /// Nearer tiles come first, so that they hide the pixels of farther ones before these are
    /// shaded. Without it, the order is that of the scene and its tiles.
    bool front_to_back = true;
};

/// Drops what is hidden or outside the frustum and orders the rest front to back. Fits the depth
/// range of an orthographic camera to the scene. Reads the view and the loaded tiles of its
/// streams, and changes nothing: the same view gives the same frame.
FrameView select(const SceneView& view, const SelectOptions& options = {});
FrameView select(const scene::Scene& scene, glm::ivec2 size, const SelectOptions& options = {});

/// The tiles that the view of another camera needs, to load them ahead.
std::vector<TileRequests> tile_requests(const scene::Scene& scene, const scene::Camera& camera,
                                        glm::ivec2 size);

/// Selects a scene's frames one after the other: a view that has not changed keeps its frame. Holds
/// on to the content of the last view until it selects another one or forget() is called.
class FrameSelector {
public:
    /// `selects_always`: selects unchanged views again, to measure it.
    explicit FrameSelector(const SelectOptions& options = {}, bool selects_always = false)
        : options_(options), selects_always_(selects_always) {}

    /// What the scene's camera sees, in a picture of `size` pixels. Valid until the next call.
    const FrameView& select(const scene::Scene& scene, glm::ivec2 size);
    /// The frame selected last. Precondition: there is one.
    [[nodiscard]] const FrameView& selected() const;

    void forget();

    [[nodiscard]] int count() const { return count_; }
    [[nodiscard]] double milliseconds() const { return milliseconds_; }

private:
    SelectOptions options_;
    bool selects_always_;
    SceneView view_;
    std::optional<FrameView> frame_;
    int count_ = 0;
    double milliseconds_ = 0.0;
};

} // namespace reljef::view

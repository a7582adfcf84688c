#pragma once

#include <memory>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/scene/graph/scene.h"
#include "engine/scene/tile_stream.h"
#include "engine/terrain/tree/tile_tree.h"
#include "engine/view/draw_list.h"
#include "engine/view/scene_view.h"

namespace reljef::view {

/// What a view needs of a stream of tiles.
struct TileRequests {
    std::shared_ptr<scene::TileStream> stream;
    std::vector<terrain::TreeTile> missing; ///< to load, the most urgent first
    std::vector<terrain::TreeTile> used;    ///< in memory: to keep
};

/// One frame: what is drawn and how, what should be loaded, and what was skipped and why
/// (DrawList::stats). Valid as long as the scene is unchanged.
struct FrameView {
    DrawList list;
    std::vector<TileRequests> requests; ///< one for each stream that the view shows
};

struct SelectOptions {
    /// Leaves out what nearer ground hides. Without it hidden tiles are requested and listed, too
    /// (StreamedDraw::is_hidden): to see what leaving them out takes from the picture.
    bool occlusion = true;
};

/// Leaves out what is hidden or outside the frustum and orders the rest front to back. An
/// orthographic camera's depth range is fitted to the scene. Reads the view, and the tiles in
/// memory of its streams, whose revisions the view has; changes nothing. The same view gives the
/// same frame.
FrameView select(const SceneView& view, const SelectOptions& options = {});
/// Looks at the scene through its camera.
FrameView select(const scene::Scene& scene, glm::ivec2 size, const SelectOptions& options = {});

/// What the view of another camera needs of the scene's streams, for reading ahead.
std::vector<TileRequests> tile_requests(const scene::Scene& scene, const scene::Camera& camera,
                                        glm::ivec2 size);

} // namespace reljef::view

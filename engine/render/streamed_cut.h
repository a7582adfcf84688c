#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/render/draw_list.h"
#include "engine/scene/streamed_tile.h"
#include "engine/terrain/bisection_mesh.h"

namespace reljef::render {

/// A streamed tile as heights over the plane that touches it, with their bisection: what fewer
/// triangles of its vertices may be off, the curvature of the Earth included.
class StreamedShape {
public:
    explicit StreamedShape(const scene::StreamedTile& tile);
    ~StreamedShape();
    StreamedShape(StreamedShape&&) noexcept;
    StreamedShape& operator=(StreamedShape&&) noexcept;

    /// Triangles over the tile's vertices, row after row, as few as the view allows where its whole
    /// border is kept: so tiles meet as they do with all of their vertices.
    [[nodiscard]] std::vector<std::uint16_t> triangles(const terrain::ErrorView& view) const;
    /// Local metres from those of the plane.
    [[nodiscard]] const glm::dmat4& local_from_plane() const { return local_from_plane_; }

private:
    struct Data;
    glm::dmat4 local_from_plane_{1.0};
    std::unique_ptr<const Data> data_;
};

/// Whether a tile is drawn with fewer triangles than its vertices have.
bool is_cut(const StreamedDraw& draw);

/// How a view shows what the triangles of such a tile are off. Half of the error that is asked for
/// is theirs: the other half is the tile's, whose vertices are averages.
terrain::ErrorView cut_view(const DrawList& list, const StreamedDraw& draw,
                            const StreamedShape& shape);

} // namespace reljef::render

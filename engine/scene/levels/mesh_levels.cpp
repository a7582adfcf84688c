#include "engine/scene/levels/mesh_levels.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "engine/scene/levels/mesh_distance.h"
#include "engine/scene/levels/simplified_mesh.h"

namespace reljef::scene {
namespace {

constexpr std::size_t share_of_level = 4; // of the triangles before
constexpr std::size_t min_triangles = 64;

std::size_t triangles_of(const Mesh& mesh) {
    return mesh.indices.size() / 3;
}

// A level takes time in proportion to the triangles of the level before.
ParallelOptions without_progress(const ParallelOptions& options) {
    return {options.threads, options.stop, {}};
}

} // namespace

std::optional<MeshLevels> mesh_levels(const Mesh& mesh, const ParallelOptions& options) {
    MeshLevels levels;
    if (triangles_of(mesh) < min_triangles_with_levels) {
        return levels;
    }
    const Mesh* last = &mesh;
    double error = 0.0;
    double shaded_width = 0.0;
    while (triangles_of(*last) >= share_of_level * min_triangles) {
        if (options.stop.stop_requested()) {
            return std::nullopt;
        }
        Mesh coarser = simplified_mesh(*last, triangles_of(*last) / share_of_level);
        if (coarser.indices.empty() || 2 * triangles_of(coarser) > triangles_of(*last)) {
            break; // borders and seams
        }
        const auto distance = max_distance_between(*last, coarser, without_progress(options));
        const auto width = width_of_other_normals(*last, coarser, without_progress(options));
        if (!distance || !width) {
            return std::nullopt;
        }
        error += *distance;
        shaded_width = std::max(shaded_width, *width);
        levels.push_back({std::make_shared<const Mesh>(std::move(coarser)), error, shaded_width});
        last = levels.back().mesh.get();
        if (options.progress) {
            options.progress(1.0 - static_cast<double>(triangles_of(*last)) /
                                       static_cast<double>(triangles_of(mesh)));
        }
    }
    return levels;
}

} // namespace reljef::scene

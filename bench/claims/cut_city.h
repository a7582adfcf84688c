#pragma once

#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/hit.h"
#include "engine/core/result.h"
#include "engine/scene/graph/scene.h"

namespace reljef::bench {

/// A part of a terrain, drawn by its own node.
struct CityPiece {
    std::shared_ptr<const scene::TerrainSurface> surface; ///< pieces may share one
    glm::ivec2 begin{0};       ///< sample of the whole terrain at the piece's first sample
    bool has_buildings = true; ///< otherwise it has one height
};

/// A terrain on a plane, whole and in pieces side by side, which share the samples of their border.
struct CutCity {
    std::string name;
    CityPiece whole;
    std::vector<CityPiece> pieces;
};

/// `copies` × `copies` copies of one tile of `urban`, `tile` cells a side. All pieces share one
/// surface. Fails as terrains::generate_urban and if there is no copy.
Result<CutCity> repeated_city(int tile, int copies, unsigned threads);

struct LoneCityOptions {
    int piece = 128; ///< cells a side
    int city = 4;    ///< pieces a side with buildings
    int pieces = 8;  ///< a side of the whole
    unsigned threads = 0;
};
/// `urban` over the middle of level ground at the height of its streets, which is also that of its
/// border. The pieces without buildings share one surface. Fails as terrains::generate_urban and if
/// no ground lies around the city.
Result<CutCity> lone_city(const LoneCityOptions& options);

struct PieceTechniques {
    scene::Technique buildings; ///< of pieces with buildings
    scene::Technique level;     ///< of the others
};
/// A scene of the pieces, side by side as in the whole, with a sun.
scene::Scene scene_of_pieces(const CutCity& city, const std::vector<CityPiece>& pieces,
                             const PieceTechniques& techniques, const scene::Camera& camera);

/// Hits on pieces as hits on the whole terrain. A hit does not name its node: it belongs to the
/// piece that puts it nearest to its place by its depth.
HitBuffer hits_on_whole(const CutCity& city, const std::vector<CityPiece>& pieces,
                        const scene::Camera& camera, const HitBuffer& hits);

} // namespace reljef::bench

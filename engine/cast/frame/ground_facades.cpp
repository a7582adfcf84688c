#include "engine/cast/frame/ground_facades.h"

#include "engine/view/grain_view.h"

namespace reljef::cast {

static_assert(sizeof(view::FacadeTexels) == FacadePaint::wall_values * sizeof(float));

const FacadePaint* GroundFacades::prepare(const view::DrawList& list, const SeenTerrain& seen) {
    // Their samples are those of one tile, a globe in memory is cast at in pieces.
    if (seen.has_tiles || seen.columns_around > 0.0 || !view::shows_facades(*seen.node)) {
        return nullptr;
    }
    const auto light = view::light_on(list, seen.world_from_local);
    if (surface_.lock() != seen.node->surface || light_ != light) {
        map_ = view::facade_map(*seen.node->surface, seen.world_from_local, light);
        surface_ = seen.node->surface;
        light_ = light;
    }
    paint_ = {.samples = &map_.samples.samples().front().x,
              .stride = map_.samples.cols(),
              .walls = &map_.walls.front().along.x,
              .sun = map_.sun,
              .sky = map_.sky,
              .exaggeration = static_cast<float>(seen.node->surface->placement().exaggeration()),
              .turn = view::GrainView::turn,
              .metres_a_pixel = scene::metres_a_pixel(list.camera, list.size)};
    return &paint_;
}

} // namespace reljef::cast

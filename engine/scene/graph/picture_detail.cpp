#include "engine/scene/graph/picture_detail.h"

#include <utility>

namespace reljef::scene {

Result<std::shared_ptr<const material::ReliefMaterial>> picture_material(Image picture,
                                                                         std::string name) {
    material::ReliefMaterial flat;
    flat.name = std::move(name);
    flat.color = std::move(picture);
    flat.heights = Grid<float>(1, 1, 1.0F);
    flat.specular = 0.0F;
    auto made = material::completed(std::move(flat), material::WrapMode::wrap);
    if (!made) {
        return made.error();
    }
    return std::make_shared<const material::ReliefMaterial>(std::move(*made));
}

bool is_picture(const SurfaceDetail& detail) {
    return detail.set != nullptr && detail.set->heights.size() == 1 &&
           detail.set->heights(0, 0) == 1.0F && detail.set->specular == 0.0F &&
           detail.offset == -1.0F;
}

} // namespace reljef::scene

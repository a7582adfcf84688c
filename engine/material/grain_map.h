#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace reljef::material {

/// Fine structure of ground, which elevation data do not have: square patterns that repeat, one for
/// each kind of ground, as mip levels. Each is noise of four octaves with waves of 1/5 to 1/47 of
/// the side, whose heights have the same slopes in each octave, but those of snow smaller ones in
/// finer octaves.
///
/// A texel is three times 10 bits: the slopes of heights along x and y, and a change of the
/// brightness, each 2 · bits / 1023 - 1, with the mean 0 and the standard deviations of
/// deviation().
class GrainMap {
public:
    static constexpr int side = 256;
    static constexpr int level_count = 8; ///< to 2 by 2 texels
    /// Each lies on those before it.
    enum Layer { soil, scree, grass, rock, snow, layer_count };

    /// That of the slopes, and that of the brightness.
    static constexpr glm::vec2 deviation(Layer layer) {
        return layer == snow ? glm::vec2(0.07F, 0.03F) : glm::vec2(0.25F);
    }

    GrainMap();

    /// Row after row.
    [[nodiscard]] std::span<const std::uint32_t> level(Layer layer, int level) const;
    /// All levels of all layers; level l of a layer begins at layer · layer_texels + begin(l).
    [[nodiscard]] std::span<const std::uint32_t> texels() const { return texels_; }

    static constexpr std::size_t begin(int level) {
        std::size_t texels = 0;
        for (int finer = 0; finer < level; ++finer) {
            texels += texels_of(finer);
        }
        return texels;
    }
    static constexpr std::size_t texels_of(int level) {
        const auto width = static_cast<std::size_t>(side >> level);
        return width * width;
    }

private:
    std::vector<std::uint32_t> texels_;
};

inline constexpr std::size_t grain_layer_texels = GrainMap::begin(GrainMap::level_count);

/// A texel's slopes along x and y, and its change of the brightness.
glm::vec3 grain_of(std::uint32_t texel);

} // namespace reljef::material

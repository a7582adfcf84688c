#pragma once

#include <cstdint>
#include <optional>

#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"

namespace reljef::material {

/// A cone stands on the surface with its tip and opens upwards.
enum class ConeKind {
    plain,  ///< contains no part of the surface (Dummer 2006)
    relaxed ///< no falling ray that starts on its axis above the surface meets the surface twice
            ///< inside (Policarpo and Oliveira, GPU Gems 3, 2007, ch. 18)
};

/// Maximum cone ratio, samples per unit of heights in [0,1]. A wider cone saves little: a ray that
/// falls so slowly has left most maps.
inline constexpr float max_cone_ratio = 1024.0F;

/// The cone ratios (radius over height) of a bilinear height surface, in samples per unit of the
/// heights, at most max_cone_ratio. Cell (col, row) lies between the samples (col, row) and
/// (col + 1, row + 1); its ratio is valid for a cone on any point of its bilinear patch. Scaling
/// the surface keeps the ratios: the cones become ellipses.
///
/// A plain cone's ratio is at most distance / rise to any higher point. For a relaxed cone only
/// points count where the surface falls along the way from the tip: only there a ray leaves the
/// surface again. Computed from bounds over pairs of cells, pruned by a pyramid, and rounded down.
///
/// Empty when stopped. Precondition: at least 2×2 finite samples.
std::optional<Grid<float>> cone_map(GridView<const float> heights, ConeKind kind,
                                    const ParallelOptions& parallel = {});

/// The minimum of the cells around each sample, for bilinear interpolation. Precondition: not
/// empty.
Grid<float> cones_at_samples(const Grid<float>& cells);

/// Ratios as integers up to `highest` (255, 65535), rounded down: ratio = widest · (code /
/// highest)². Bilinear interpolation stays below the widest of the four. Precondition:
/// 0 < highest <= 65535, widest > 0.
Grid<std::uint16_t> cone_codes(const Grid<float>& ratios, float widest, int highest);
float cone_of_code(float code, float widest, int highest);

/// Both kinds, by cell.
struct ConeMaps {
    Grid<float> plain;
    Grid<float> relaxed;
};
/// See cone_map().
std::optional<ConeMaps> cone_maps(GridView<const float> heights,
                                  const ParallelOptions& parallel = {});

/// Whether all ratios are in range, and those of some cells, spread over the map, are what
/// cone_maps() finds, up to rounding: what was read from a file may be nonsense. Precondition: the
/// maps have one cell fewer than the heights along each side.
bool are_cones_of(const ConeMaps& cones, GridView<const float> heights);

} // namespace reljef::material

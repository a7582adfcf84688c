#pragma once

#include <cstdint>
#include <optional>

#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"

namespace reljef::material {

/// What a cone that stands on the surface with its tip, open upwards, may hold.
enum class ConeKind {
    plain,  ///< nothing of the surface: any ray inside is above it (Dummer 2006)
    relaxed ///< what no ray that starts on its axis above the surface, and does not rise, meets
            ///< more than once (Policarpo and Oliveira, GPU Gems 3, 2007, ch. 18)
};

/// No cone is wider: samples per unit of height of heights in [0,1]. A wider one saves little, as a
/// ray that falls so slowly has left most maps.
inline constexpr float widest_cone = 1024.0F;

struct ConeOptions {
    float widest = widest_cone; ///< samples per unit of height, > 0
    ParallelOptions parallel;
};

/// How wide the cones over a bilinear height surface are: radius over height, in samples per unit
/// of the heights. Cell (col, row) lies between the samples (col, row) and (col + 1, row + 1); its
/// ratio holds for a cone on any point of its bilinear patch, not only on its corners. A surface
/// that is scaled keeps its cones: they are ellipses then.
///
/// A plain cone's ratio is at most distance / rise to any higher point. A relaxed one's is at most
/// that to any point where the surface falls along the way from the tip: there, and only there, a
/// ray comes out of the surface again. Found by bounds over pairs of cells, pruned by a pyramid;
/// what is rounded is rounded down.
///
/// Absent when it was stopped. Precondition: at least 2×2 samples, all finite.
std::optional<Grid<float>> cone_map(GridView<const float> heights, ConeKind kind,
                                    const ConeOptions& options = {});

/// The least of the cells around each sample: what may be interpolated bilinearly between samples.
/// Precondition: not empty.
Grid<float> cones_at_samples(const Grid<float>& cells);

/// Ratios as whole numbers up to `highest` (255, 65535), rounded down: ratio = widest · (code /
/// highest)². Interpolated bilinearly they are still no wider than the widest of the four.
/// Precondition: 0 < highest <= 65535, widest > 0.
Grid<std::uint16_t> cone_codes(const Grid<float>& ratios, float widest, int highest);
float cone_of_code(float code, float widest, int highest);

/// Both kinds of one surface, by cell.
struct ConeMaps {
    Grid<float> plain;
    Grid<float> relaxed;
};
/// As cone_map, of both.
std::optional<ConeMaps> cone_maps(GridView<const float> heights, const ConeOptions& options = {});

} // namespace reljef::material

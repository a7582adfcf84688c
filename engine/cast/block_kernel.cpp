#include "engine/cast/block_kernel.h"

#include <limits>

// Instruction sets between those of simd_target.cpp are no faster. Vectors whose length the
// compiler does not know (SVE) cannot be members.
#define HWY_DISABLED_TARGETS                                                                       \
    (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/cast/block_kernel.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "engine/cast/packet_beams-inl.h"
#include "engine/cast/packet_paint-inl.h"
#include "engine/cast/packet_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

constexpr float nowhere = std::numeric_limits<float>::infinity();

// Stores the lanes of a packet whose first pixel is (col, row).
template <class Tag, class U>
HWY_INLINE void store(Tag tag, hn::Vec<Tag> lanes, int col, int row, U* to) {
    alignas(64) hn::TFromD<Tag> values[static_cast<std::size_t>(lane_count)];
    hn::Store(lanes, tag, values);
    for (int lane = 0; lane < lane_count; ++lane) {
        const int pixel = (row + lane / packet_cols) * block_side + col + lane % packet_cols;
        to[pixel] = static_cast<U>(values[lane]);
    }
}

HWY_INLINE void store_hits(const PacketHits& found, int col, int row, BlockHits& hits) {
    store(floats, hn::IfThenElse(found.found, found.t, all(nowhere)), col, row, hits.t.data());
    store(ints, found.col, col, row, hits.col.data());
    store(ints, found.row, col, row, hits.row.data());
    store(floats, found.col_part, col, row, hits.col_part.data());
    store(floats, found.row_part, col, row, hits.row_part.data());
    store(floats, found.height, col, row, hits.height.data());
}

void cast_all(const BlockJob& job, BlockHits& hits) {
    BeamStarts starts;
    find_starts(job, starts);
    for (int row = 0; row < block_side; row += packet_rows) {
        for (int col = 0; col < block_side; col += packet_cols) {
            const Rays rays = rays_of(job, col, row);
            store_hits(hits_of(rays, job, starts.at(col, row)), col, row, hits);
        }
    }
}

HWY_INLINE void paint_packet(const BlockJob& job, const BlockPaint& paint, int col, int row,
                             float start, BlockPixels& pixels) {
    const PixelOffsets offsets = offsets_of(col, row);
    const ViewRays view = view_rays(paint, offsets);
    if (!(start < nowhere)) {
        store(ints, bytes_of(sky_color(paint, view)), col, row, pixels.rgba.data());
        return;
    }
    const Rays rays = rays_of(job, col, row);
    const PacketHits hits = hits_of(rays, job, start);
    Color color = ground_color(job, paint, rays, view, hits);
    if (!hn::AllTrue(floats, hits.found)) {
        color = chosen(hits.found, color, sky_color(paint, view));
    }
    store(ints, bytes_of(color), col, row, pixels.rgba.data());
}

void paint_all(const BlockJob& job, const BlockPaint& paint, BlockPixels& pixels) {
    BeamStarts starts;
    find_starts(job, starts);
    for (int row = 0; row < block_side; row += packet_rows) {
        for (int col = 0; col < block_side; col += packet_cols) {
            paint_packet(job, paint, col, row, starts.at(col, row), pixels);
        }
    }
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace reljef::cast {

HWY_EXPORT(cast_all);
HWY_EXPORT(paint_all);

BlockKernel block_kernel(std::int64_t targets) {
    hwy::ChosenTarget chosen;
    chosen.Update(targets != 0 ? targets : hwy::SupportedTargets());
    const std::size_t index = chosen.GetIndex();
    return {HWY_DISPATCH_TABLE(cast_all)[index], HWY_DISPATCH_TABLE(paint_all)[index]};
}

std::int64_t compiled_targets() {
    return HWY_TARGETS;
}

} // namespace reljef::cast
#endif

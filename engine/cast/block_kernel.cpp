#include "engine/cast/block_kernel.h"

#include <cstring>
#include <limits>

// Instruction sets between those of simd_target.cpp are no faster. Vectors whose length the
// compiler does not know (SVE) cannot be members.
#define HWY_DISABLED_TARGETS                                                                       \
    (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/cast/block_kernel.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "engine/cast/packet_paint-inl.h"
#include "engine/cast/packet_rays-inl.h"
#include "engine/cast/packet_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

constexpr float nowhere = std::numeric_limits<float>::infinity();

// Stores the lanes of a packet whose first pixel is (col, row).
template <class Tag, class U>
HWY_INLINE void store(Tag tag, hn::Vec<Tag> lanes, int col, int row, U* to) {
    static_assert(sizeof(U) == sizeof(hn::TFromD<Tag>));
    alignas(64) hn::TFromD<Tag> values[static_cast<std::size_t>(lane_count)];
    hn::Store(lanes, tag, values);
    for (int i = 0; i < packet_rows; ++i) {
        std::memcpy(to + (row + i) * block_side + col, values + i * packet_cols,
                    sizeof(U) * packet_cols);
    }
}

// The hits of all tiles together.
struct MergedHits {
    PacketHits hits;
    Ints job;
};

HWY_INLINE void merge(const PacketHits& found, int job, MergedHits& merged) {
    const IntLanes lanes = hn::RebindMask(ints, found.found);
    const auto take = [&](Floats from, Floats& to)
                          HWY_ATTR { to = hn::IfThenElse(found.found, from, to); };
    PacketHits& hits = merged.hits;
    hits.col = hn::IfThenElse(lanes, found.col, hits.col);
    hits.row = hn::IfThenElse(lanes, found.row, hits.row);
    merged.job = hn::IfThenElse(lanes, all(job), merged.job);
    take(found.t, hits.t);
    take(found.col_part, hits.col_part);
    take(found.row_part, hits.row_part);
    take(found.height, hits.height);
}

template <bool has_walls>
HWY_INLINE MergedHits merged_hits(const BlockJobs& jobs, int col, int row) {
    const PixelOffsets pixels = offsets_of(col, row);
    const Floats zero = hn::Zero(floats);
    const Ints none = hn::Zero(ints);
    MergedHits merged{{no_lanes(), none, none, all(nowhere), zero, zero, zero, {}}, none};
    Met met = Met::nothing();
    for (std::size_t i = 0; i < jobs.tiles.size(); ++i) {
        const BlockJob& job = jobs.tiles[i];
        const float start = job.starts[beam_at(col, row)];
        if (start < nowhere) {
            merge(hits_of<has_walls>(rays_of(job, pixels), job, all(start), met),
                  static_cast<int>(i), merged);
        }
    }
    return merged;
}

HWY_INLINE void store_hits(const MergedHits& found, int col, int row, BlockHits& hits) {
    store(ints, found.job, col, row, hits.job.data());
    store(floats, found.hits.t, col, row, hits.t.data());
    store(ints, found.hits.col, col, row, hits.col.data());
    store(ints, found.hits.row, col, row, hits.row.data());
    store(floats, found.hits.col_part, col, row, hits.col_part.data());
    store(floats, found.hits.row_part, col, row, hits.row_part.data());
    store(floats, found.hits.height, col, row, hits.height.data());
}

template <class Body> HWY_INLINE void for_each_packet(const Body& body) {
    for (int row = 0; row < block_side; row += packet_rows) {
        for (int col = 0; col < block_side; col += packet_cols) {
            body(col, row);
        }
    }
}

HWY_INLINE void find_all_starts(const BlockJobs& jobs) {
    for (BlockJob& job : jobs.tiles) {
        find_starts(job);
    }
}

void cast_all(const BlockJobs& jobs, BlockHits& hits) {
    find_all_starts(jobs);
    for_each_packet([&](int col, int row) HWY_ATTR {
        store_hits(jobs.has_walls ? merged_hits<true>(jobs, col, row)
                                  : merged_hits<false>(jobs, col, row),
                   col, row, hits);
    });
}

template <bool has_walls>
HWY_INLINE void paint_packets(const BlockJobs& jobs, const BlockPaint& paint, BlockPixels& pixels) {
    for_each_packet([&](int col, int row) HWY_ATTR {
        const auto start_of = [&](const BlockJob& job)
                                  HWY_ATTR { return all(job.starts[beam_at(col, row)]); };
        const Look look = look_of<has_walls>(jobs, paint, offsets_of(col, row), start_of);
        store(ints, bytes_of(look.color), col, row, pixels.rgba.data());
        store(floats, look.t, col, row, pixels.t.data());
    });
}

void paint_all(const BlockJobs& jobs, const BlockPaint& paint, BlockPixels& pixels) {
    find_all_starts(jobs);
    if (jobs.has_walls) {
        paint_packets<true>(jobs, paint, pixels);
    } else {
        paint_packets<false>(jobs, paint, pixels);
    }
}

using LaneFloats = std::array<float, static_cast<std::size_t>(lane_count)>;

// Sums of the colours of sampled pixels, in their order.
struct ColorSums {
    alignas(64) std::array<float, block_pixels> r;
    alignas(64) std::array<float, block_pixels> g;
    alignas(64) std::array<float, block_pixels> b;
};

// A packet of samples, counted over all sampled pixels.
struct SamplePacket {
    alignas(64) LaneFloats right;
    alignas(64) LaneFloats down;
    std::array<std::size_t, static_cast<std::size_t>(lane_count)> beam;

    SamplePacket(const SampledPixels& sampled, int first) {
        constexpr float middle = 0.5F - 0.5F * static_cast<float>(block_side);
        const int last = sampled.count * sampled.samples - 1;
        for (int lane = 0; lane < lane_count; ++lane) {
            const int index = first + lane < last ? first + lane : last;
            const int pixel = sampled.pixels[static_cast<std::size_t>(index / sampled.samples)];
            const glm::vec2 place =
                sampled.places[static_cast<std::size_t>(index % sampled.samples)];
            const int col = pixel % block_side;
            const int row = pixel / block_side;
            const auto at = static_cast<std::size_t>(lane);
            right[at] = static_cast<float>(col) + middle + place.x;
            down[at] = static_cast<float>(row) + middle + place.y;
            beam[at] = beam_at(col, row);
        }
    }
};

HWY_INLINE void add_samples(const Color& color, const SampledPixels& sampled, int first,
                            ColorSums& sums) {
    const int count = sampled.count * sampled.samples;
    const auto add = [&](Floats channel, float* to) HWY_ATTR {
        alignas(64) LaneFloats values;
        hn::Store(channel, floats, values.data());
        for (int lane = 0; lane < lane_count && first + lane < count; ++lane) {
            to[(first + lane) / sampled.samples] += values[static_cast<std::size_t>(lane)];
        }
    };
    add(color.r, sums.r.data());
    add(color.g, sums.g.data());
    add(color.b, sums.b.data());
}

HWY_INLINE void store_means(const ColorSums& sums, const SampledPixels& sampled,
                            BlockPixels& pixels) {
    const Floats share = all(1.0F / static_cast<float>(sampled.samples));
    for (int first = 0; first < sampled.count; first += lane_count) {
        const Color mean = scaled({hn::Load(floats, sums.r.data() + first),
                                   hn::Load(floats, sums.g.data() + first),
                                   hn::Load(floats, sums.b.data() + first)},
                                  share);
        alignas(64) std::array<std::int32_t, static_cast<std::size_t>(lane_count)> bytes;
        hn::Store(bytes_of(mean), ints, bytes.data());
        for (int lane = 0; lane < lane_count && first + lane < sampled.count; ++lane) {
            pixels.rgba[sampled.pixels[static_cast<std::size_t>(first + lane)]] =
                static_cast<std::uint32_t>(bytes[static_cast<std::size_t>(lane)]);
        }
    }
}

template <bool has_walls>
HWY_INLINE void sample_packets(const BlockJobs& jobs, const BlockPaint& paint,
                               const SampledPixels& sampled, ColorSums& sums) {
    for (int first = 0; first < sampled.count * sampled.samples; first += lane_count) {
        const SamplePacket packet(sampled, first);
        const auto start_of = [&](const BlockJob& job) HWY_ATTR {
            alignas(64) LaneFloats starts;
            for (std::size_t lane = 0; lane < starts.size(); ++lane) {
                starts[lane] = job.starts[packet.beam[lane]];
            }
            return hn::Load(floats, starts.data());
        };
        const PixelOffsets offsets{hn::Load(floats, packet.right.data()),
                                   hn::Load(floats, packet.down.data())};
        add_samples(look_of<has_walls>(jobs, paint, offsets, start_of).color, sampled, first, sums);
    }
}

void sample_all(const BlockJobs& jobs, const BlockPaint& paint, const SampledPixels& sampled,
                BlockPixels& pixels) {
    find_all_starts(jobs);
    ColorSums sums{};
    if (jobs.has_walls) {
        sample_packets<true>(jobs, paint, sampled, sums);
    } else {
        sample_packets<false>(jobs, paint, sampled, sums);
    }
    store_means(sums, sampled, pixels);
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace reljef::cast {

HWY_EXPORT(cast_all);
HWY_EXPORT(paint_all);
HWY_EXPORT(sample_all);

BlockKernel block_kernel(std::int64_t targets) {
    hwy::ChosenTarget chosen;
    chosen.Update(targets != 0 ? targets : hwy::SupportedTargets());
    const std::size_t index = chosen.GetIndex();
    return {HWY_DISPATCH_TABLE(cast_all)[index], HWY_DISPATCH_TABLE(paint_all)[index],
            HWY_DISPATCH_TABLE(sample_all)[index]};
}

std::int64_t compiled_targets() {
    return HWY_TARGETS;
}

} // namespace reljef::cast
#endif

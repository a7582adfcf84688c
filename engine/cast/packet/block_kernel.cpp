#include "engine/cast/packet/block_kernel.h"

#include <algorithm>
#include <cstring>
#include <limits>

// Instruction sets between those of simd_target.cpp are no faster. Vectors whose length the
// compiler does not know (SVE) cannot be members.
#define RELJEF_UNUSED_TARGETS                                                                      \
    (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#ifdef __SANITIZE_ADDRESS__ // two of them show the same errors
#define HWY_DISABLED_TARGETS (RELJEF_UNUSED_TARGETS | HWY_SSE4 | HWY_AVX3)
#else
#define HWY_DISABLED_TARGETS RELJEF_UNUSED_TARGETS
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/cast/packet/block_kernel.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "engine/cast/packet/packet_light-inl.h"
#include "engine/cast/packet/packet_paint-inl.h"
#include "engine/cast/packet/packet_rays-inl.h"
#include "engine/cast/packet/packet_sun-inl.h"
#include "engine/cast/packet/packet_walk-inl.h"

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

// The values of a packet whose first pixel is (col, row).
HWY_INLINE Floats load(const float* from, int col, int row) {
    alignas(64) float values[static_cast<std::size_t>(lane_count)];
    for (int i = 0; i < packet_rows; ++i) {
        std::memcpy(values + i * packet_cols, from + (row + i) * block_side + col,
                    sizeof(float) * packet_cols);
    }
    return hn::Load(floats, values);
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

static_assert(BlockMeshes::padding >= packets_a_pair * lane_count);

static_assert(wide_beam_rows % (static_cast<int>(packets_a_pair) * packet_rows) == 0);

// Where the rays of a packet may begin: found when its first ray reaches the tile.
HWY_INLINE Floats found_starts_of(BlockJob& job, int col, int row) {
    find_starts(job, 1U << static_cast<unsigned>(row / wide_beam_rows));
    return starts_of(job, col, row);
}

// The first row of packet k of a pair. Its packets lie one above the other.
HWY_INLINE int row_of(int first_row, std::size_t k) {
    return first_row + static_cast<int>(k) * packet_rows;
}

HWY_INLINE Pair<PixelOffsets> pair_offsets(int col, int row) {
    return {offsets_of(col, row), offsets_of(col, row_of(row, 1))};
}

template <class Mode>
HWY_INLINE Pair<MergedHits> merged_hits(const BlockJobs& jobs, int col, int row) {
    const Pair<PixelOffsets> pixels = pair_offsets(col, row);
    MergedHits sky{PacketHits::nothing(), hn::Zero(ints)};
    sky.hits.t = all(nowhere);
    Pair<MergedHits> merged{sky, sky};
    Pair<Met> met{Met::nothing(), Met::nothing()};
    for (std::size_t i = 0; i < jobs.tiles.size(); ++i) {
        BlockJob& job = jobs.tiles[i];
        const Pair<Floats> starts = starts_by(
            [&](std::size_t k) HWY_ATTR { return found_starts_of(job, col, row_of(row, k)); });
        if (is_any_ray(starts)) {
            Pair<Rays> rays = rays_of(job, pixels);
            const Pair<PacketHits> hits = hits_of<Mode>(rays, job, starts, met);
            merge(hits[0], static_cast<int>(i), merged[0]);
            merge(hits[1], static_cast<int>(i), merged[1]);
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

template <class Body> HWY_INLINE void for_each_pair(const Body& body) {
    for (int row = 0; row < block_side; row += static_cast<int>(packets_a_pair) * packet_rows) {
        for (int col = 0; col < block_side; col += packet_cols) {
            body(col, row);
        }
    }
}

void cast_all(const BlockJobs& jobs, BlockHits& hits) {
    for_each_pair([&](int col, int row) HWY_ATTR {
        const Pair<MergedHits> merged = jobs.has_walls ? merged_hits<AmongTiles>(jobs, col, row)
                                                       : merged_hits<InMemory>(jobs, col, row);
        store_hits(merged[0], col, row, hits);
        store_hits(merged[1], col, row_of(row, 1), hits);
    });
}

HWY_INLINE Floats nearness_of(const BlockPaint& paint, Floats t) {
    const Floats depth = hn::Add(t, all(paint.anchor));
    const Floats min_depth = all(std::numeric_limits<float>::min()); // rounding may give 0
    const Floats sky = all(-1e30F);
    return paint.is_perspective ? hn::Div(all(1.0F), hn::Max(depth, min_depth))
                                : hn::Max(hn::Neg(depth), sky);
}

template <class Mode>
HWY_INLINE Pair<TrueLook> pair_looks(const BlockJobs& jobs, const BlockPaint& paint, int col,
                                     int row) {
    const auto start_of = [&](BlockJob& job, std::size_t k)
                              HWY_ATTR { return found_starts_of(job, col, row_of(row, k)); };
    const auto mesh_values = [&](const float* of, std::size_t k)
                                 HWY_ATTR { return load(of, col, row_of(row, k)); };
    return looks_of<Mode>(jobs, paint, pair_offsets(col, row), start_of, mesh_values);
}

template <class Mode>
HWY_INLINE void paint_packets(const BlockJobs& jobs, const BlockPaint& paint, BlockPixels& pixels) {
    for_each_pair([&](int col, int first_row) HWY_ATTR {
        const Pair<TrueLook> looks = pair_looks<Mode>(jobs, paint, col, first_row);
        for (std::size_t k = 0; k < packets_a_pair; ++k) {
            const TrueLook& shown = looks[k];
            const int row = row_of(first_row, k);
            store(ints, bytes_of(shown.look.color), col, row, pixels.rgba.data());
            if (paint.needs_nearness) {
                store(floats, nearness_of(paint, shown.look.t), col, row, pixels.nearness.data());
            }
            if (paint.needs_t) {
                const Floats of_hits = hn::IfThenElse(shown.found, all(nowhere), shown.t);
                store(floats, of_hits, col, row, pixels.t.data());
            }
        }
    });
}

void paint_all(const BlockJobs& jobs, const BlockPaint& paint, BlockPixels& pixels) {
    if (jobs.has_walls) {
        paint_packets<AmongTiles>(jobs, paint, pixels);
    } else {
        paint_packets<InMemory>(jobs, paint, pixels);
    }
}

void count_all(const BlockJobs& jobs, const BlockPaint& paint, BlockWork& work) {
    for_each_pair([&](int col, int first_row) HWY_ATTR {
        const Pair<TrueLook> looks = pair_looks<Counted>(jobs, paint, col, first_row);
        for (std::size_t k = 0; k < packets_a_pair; ++k) {
            const Work& found = looks[k].look.work;
            const int row = row_of(first_row, k);
            store(ints, found.taps, col, row, work.taps.data());
            store(ints, found.steps, col, row, work.steps.data());
            store(ints, found.rays, col, row, work.rays.data());
        }
    });
    for (const BlockJob& job : jobs.tiles) {
        work.beam_taps += job.beam_taps;
    }
}

using LaneFloats = std::array<float, static_cast<std::size_t>(lane_count)>;

// Sums of the colours of sampled pixels, in their order.
struct ColorSums {
    alignas(64) std::array<float, block_pixels> r;
    alignas(64) std::array<float, block_pixels> g;
    alignas(64) std::array<float, block_pixels> b;
};

// A sample of a sampled pixel.
struct SampleIndex {
    int pixel = 0;
    int sample = 0;

    // `number`: counted over all sampled pixels.
    SampleIndex(const SampledPixels& sampled, int number)
        : pixel(number / sampled.samples), sample(number % sampled.samples) {}

    HWY_INLINE void next(const SampledPixels& sampled) {
        ++sample;
        if (sample == sampled.samples) {
            sample = 0;
            ++pixel;
        }
    }
};

// A packet of samples.
struct SamplePacket {
    alignas(64) LaneFloats right;
    alignas(64) LaneFloats down;
    std::array<std::size_t, static_cast<std::size_t>(lane_count)> beam;
    std::array<unsigned, static_cast<std::size_t>(lane_count)> pixel_of_beam;
    std::size_t count = 0;           // lanes with samples
    unsigned wide_beams_of_rays = 0; // rows of them: bits

    SamplePacket(const SampledPixels& sampled, SampleIndex index) {
        constexpr float middle = 0.5F - 0.5F * static_cast<float>(block_side);
        for (std::size_t lane = 0; lane < right.size(); ++lane) {
            const int last = std::min(index.pixel, sampled.count() - 1);
            const int pixel = sampled.pixels[static_cast<std::size_t>(last)];
            const glm::vec2 place = sampled.places[static_cast<std::size_t>(index.sample)];
            const int col = pixel % block_side;
            const int row = pixel / block_side;
            right[lane] = static_cast<float>(col) + middle + place.x;
            down[lane] = static_cast<float>(row) + middle + place.y;
            beam[lane] = beam_at(col, row);
            pixel_of_beam[lane] = beam_pixel_at(col, row);
            wide_beams_of_rays |= 1U << static_cast<unsigned>(row / wide_beam_rows);
            count += index.pixel < sampled.count() ? 1U : 0U;
            index.next(sampled);
        }
    }

    [[nodiscard]] HWY_INLINE PixelOffsets offsets() const {
        return {hn::Load(floats, right.data()), hn::Load(floats, down.data())};
    }
    [[nodiscard]] HWY_INLINE Floats starts(BlockJob& job) const {
        find_starts(job, wide_beams_of_rays);
        alignas(64) LaneFloats begin;
        for (std::size_t lane = 0; lane < begin.size(); ++lane) {
            const unsigned pixels = job.beam_pixels;
            const bool is_ray = lane < count && (pixels >> pixel_of_beam[lane] & 1U) != 0;
            begin[lane] = is_ray ? job.starts[beam[lane]] : nowhere;
        }
        return hn::Load(floats, begin.data());
    }
};

HWY_INLINE void add_samples(const Color& color, const SampledPixels& sampled, SampleIndex index,
                            ColorSums& sums) {
    alignas(64) std::array<LaneFloats, 3> values;
    hn::Store(color.r, floats, values[0].data());
    hn::Store(color.g, floats, values[1].data());
    hn::Store(color.b, floats, values[2].data());
    for (std::size_t lane = 0; lane < values[0].size() && index.pixel < sampled.count(); ++lane) {
        const auto pixel = static_cast<std::size_t>(index.pixel);
        sums.r[pixel] += values[0][lane];
        sums.g[pixel] += values[1][lane];
        sums.b[pixel] += values[2][lane];
        index.next(sampled);
    }
}

HWY_INLINE void store_means(const ColorSums& sums, const SampledPixels& sampled,
                            BlockPixels& pixels) {
    const Floats share = all(1.0F / static_cast<float>(sampled.samples));
    for (int first = 0; first < sampled.count(); first += lane_count) {
        const Color mean = scaled({hn::Load(floats, sums.r.data() + first),
                                   hn::Load(floats, sums.g.data() + first),
                                   hn::Load(floats, sums.b.data() + first)},
                                  share);
        alignas(64) std::array<std::int32_t, static_cast<std::size_t>(lane_count)> bytes;
        hn::Store(bytes_of(mean), ints, bytes.data());
        for (int lane = 0; lane < lane_count && first + lane < sampled.count(); ++lane) {
            pixels.rgba[sampled.pixels[static_cast<std::size_t>(first + lane)]] =
                static_cast<std::uint32_t>(bytes[static_cast<std::size_t>(lane)]);
        }
    }
}

template <class Mode>
HWY_INLINE void sample_packets(const BlockJobs& jobs, const BlockPaint& paint,
                               const SampledPixels& sampled, ColorSums& sums) {
    const int samples = sampled.count() * sampled.samples;
    for (int first = 0; first < samples; first += static_cast<int>(packets_a_pair) * lane_count) {
        const Pair<int> numbers{first, first + lane_count};
        const Pair<SamplePacket> packets{SamplePacket(sampled, SampleIndex(sampled, numbers[0])),
                                         SamplePacket(sampled, SampleIndex(sampled, numbers[1]))};
        const auto start_of = [&](BlockJob& job, std::size_t k)
                                  HWY_ATTR { return packets[k].starts(job); };
        const auto mesh_values = [&](const float* of, std::size_t k)
                                     HWY_ATTR { return hn::LoadU(floats, of + numbers[k]); };
        const Pair<TrueLook> looks = looks_of<Mode>(
            jobs, paint, {packets[0].offsets(), packets[1].offsets()}, start_of, mesh_values);
        for (std::size_t k = 0; k < packets_a_pair; ++k) {
            add_samples(looks[k].look.color, sampled, SampleIndex(sampled, numbers[k]), sums);
        }
    }
}

void sample_all(const BlockJobs& jobs, const BlockPaint& paint, const SampledPixels& sampled,
                BlockPixels& pixels) {
    ColorSums sums{};
    if (jobs.has_walls) {
        sample_packets<AmongTiles>(jobs, paint, sampled, sums);
    } else {
        sample_packets<InMemory>(jobs, paint, sampled, sums);
    }
    store_means(sums, sampled, pixels);
}

// Whether three pixels in line are not on a plane.
HWY_INLINE Lanes bend_at(const NearnessRows& rows, Floats before, Floats here, Floats after) {
    const Floats bend = hn::Abs(hn::Sub(hn::Add(before, after), hn::Add(here, here)));
    const Floats allowed = all(rows.disagreement);
    const Floats nearest = hn::Max(hn::Max(before, here), after);
    return hn::Gt(bend, rows.is_perspective ? hn::Mul(allowed, nearest) : allowed);
}

HWY_INLINE std::uint32_t row_bends(const NearnessRows& rows, const float* row) {
    std::uint32_t bits = 0;
    for (int col = 0; col < block_side; col += lane_count) {
        const auto at = [&](int place) HWY_ATTR { return hn::LoadU(floats, row + col + place); };
        const Floats here = at(0);
        const Lanes bends = hn::Or(bend_at(rows, at(-1), here, at(1)),
                                   bend_at(rows, at(-rows.stride), here, at(rows.stride)));
        std::array<std::uint8_t, 8> bytes{};
        hn::StoreMaskBits(floats, bends, bytes.data());
        const unsigned lanes = bytes[0] | static_cast<unsigned>(bytes[1]) << 8U;
        bits |= lanes << static_cast<unsigned>(col);
    }
    return bits;
}

void bends_of(const NearnessRows& rows, std::span<std::uint32_t> bits) {
    for (std::size_t i = 0; i < bits.size(); ++i) {
        bits[i] = row_bends(rows, rows.first + static_cast<std::ptrdiff_t>(i) * rows.stride);
    }
}

// As if they were hits.
HWY_INLINE PacketHits hits_at(const SunPlaces& places, int first) {
    const Ints number = hn::Iota(ints, first);
    const Lanes found = hn::RebindMask(floats, hn::Lt(number, all(places.count)));
    const auto whole = [&](const std::int32_t* values) HWY_ATTR {
        return hn::IfThenElseZero(hn::RebindMask(ints, found), hn::Load(ints, values + first));
    };
    const auto number_at = [&](const float* values) HWY_ATTR {
        return hn::IfThenElseZero(found, hn::Load(floats, values + first));
    };
    PacketHits hits;
    hits.found = found;
    hits.col = whole(places.col.data());
    hits.row = whole(places.row.data());
    hits.col_part = number_at(places.col_part.data());
    hits.row_part = number_at(places.row_part.data());
    hits.height = number_at(places.height.data());
    return hits;
}

HWY_INLINE Lanes hidden_at(const BlockJob& job, const PacketHits& hits) {
    Work none = Work::nothing();
    return job.bends != nullptr
               ? hidden_along_chords<AmongTiles>(job, hits, bent_rays(job, hits), none)
               : hidden_from_sun<AmongTiles>(job, hits, none);
}

void hide_all(const BlockJob& job, const SunPlaces& places,
              std::array<std::uint8_t, block_pixels>& hidden) {
    for (int first = 0; first < places.count; first += lane_count) {
        const Lanes dark = hidden_at(job, hits_at(places, first));
        std::array<std::uint8_t, 8> bytes{};
        hn::StoreMaskBits(floats, dark, bytes.data());
        const unsigned lanes = bytes[0] | static_cast<unsigned>(bytes[1]) << 8U;
        for (int lane = 0; lane < lane_count && first + lane < places.count; ++lane) {
            hidden[static_cast<std::size_t>(first + lane)] =
                static_cast<std::uint8_t>(lanes >> static_cast<unsigned>(lane) & 1U);
        }
    }
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace reljef::cast {

HWY_EXPORT(cast_all);
HWY_EXPORT(paint_all);
HWY_EXPORT(count_all);
HWY_EXPORT(sample_all);
HWY_EXPORT(bends_of);
HWY_EXPORT(hide_all);

BlockKernel block_kernel(std::int64_t targets) {
    hwy::ChosenTarget chosen;
    chosen.Update(targets != 0 ? targets : hwy::SupportedTargets());
    const std::size_t index = chosen.GetIndex();
    return {HWY_DISPATCH_TABLE(cast_all)[index],  HWY_DISPATCH_TABLE(paint_all)[index],
            HWY_DISPATCH_TABLE(count_all)[index], HWY_DISPATCH_TABLE(sample_all)[index],
            HWY_DISPATCH_TABLE(bends_of)[index],  HWY_DISPATCH_TABLE(hide_all)[index]};
}

std::int64_t compiled_targets() {
    return HWY_TARGETS;
}

} // namespace reljef::cast
#endif

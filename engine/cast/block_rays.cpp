#include "engine/cast/block_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

namespace reljef::cast {
namespace {

constexpr double no_hit = std::numeric_limits<double>::infinity();

// Floats have errors of 2^-24, and a height above the surface adds a few of them.
constexpr double height_rounding = 0x1p-20;

// Bases are whole numbers that floats have exactly.
constexpr double max_base = 0x1p22;

constexpr double half_block = 0.5 * block_side;

struct PixelChanges {
    glm::dvec3 right{0.0}; // for a pixel
    glm::dvec3 down{0.0};
};

// `pixel`: the block's middle.
PixelChanges changes_at(const PictureRays::Vectors& vectors, glm::dvec2 pixel) {
    const auto& bends = vectors.bends;
    return {vectors.right + 2.0 * pixel.x * bends[0] + pixel.y * bends[1],
            vectors.down + pixel.x * bends[1] + 2.0 * pixel.y * bends[2]};
}

// Anywhere in the block.
PixelChanges largest_changes(const PictureRays::Vectors& vectors, glm::dvec2 pixel) {
    const PixelChanges at = changes_at(vectors, pixel);
    const glm::dvec3 across = glm::abs(vectors.bends[1]);
    return {glm::abs(at.right) + half_block * (2.0 * glm::abs(vectors.bends[0]) + across),
            glm::abs(at.down) + half_block * (2.0 * glm::abs(vectors.bends[2]) + across)};
}

// `pixel`: the block's middle; `middle`: the vector there.
BlockRays::Vectors relative(const PictureRays::Vectors& vectors, glm::dvec2 pixel,
                            glm::dvec3 middle) {
    const auto& bends = vectors.bends;
    const PixelChanges at = changes_at(vectors, pixel);
    const PixelChanges largest = largest_changes(vectors, pixel);
    const auto half_of = [&](int rows) {
        const glm::dvec2 half(0.5 * beam_cols, 0.5 * rows);
        return glm::vec3(
            half.x * largest.right + half.y * largest.down + half.x * half.x * glm::abs(bends[0]) +
            half.x * half.y * glm::abs(bends[1]) + half.y * half.y * glm::abs(bends[2]));
    };
    return {.middle = glm::vec3(middle),
            .right = glm::vec3(at.right),
            .down = glm::vec3(at.down),
            .bends = {glm::vec3(bends[0]), glm::vec3(bends[1]), glm::vec3(bends[2])},
            .is_bent = vectors.is_bent(),
            .half_beam = half_of(beam_rows),
            .half_wide_beam = half_of(wide_beam_rows)};
}

// Along columns or rows.
float speed_of(const PictureRays::Vectors& directions, glm::dvec2 pixel) {
    const PixelChanges largest = largest_changes(directions, pixel);
    const glm::dvec3 fastest =
        glm::abs(directions.at(pixel)) + half_block * (largest.right + largest.down);
    return static_cast<float>(std::max(fastest.x, fastest.y));
}

bool are_finite(const PictureRays::Vectors& vectors) {
    const glm::dvec3 sum = vectors.at(glm::dvec2(1.0));
    return std::isfinite(sum.x) && std::isfinite(sum.y) && std::isfinite(sum.z);
}

// Metres by which a rounded ray may be above heights and still hit.
double lift_of(terrain::MinMax total) {
    return height_rounding * (std::max(std::abs(total.low), std::abs(total.high)) +
                              std::numeric_limits<float>::min());
}

BlockRays rays_of(const RayTile& tile, const PictureRays& rays, const PixelBlock& block) {
    const PictureRays::Vectors origin = places_at(rays, rays.anchor);
    const glm::dvec2 middle = glm::dvec2(block.first) + half_block;
    const glm::dvec3 place = origin.at(middle);
    const glm::dvec2 base =
        glm::clamp(glm::round(glm::dvec2(place)), glm::dvec2(-max_base), glm::dvec2(max_base));
    const terrain::MinMax total = tile.total();
    BlockRays block_rays;
    block_rays.base = glm::ivec2(base);
    block_rays.base_height = static_cast<float>(place.z);
    const double base_height = block_rays.base_height;
    block_rays.origin = relative(origin, middle, place - glm::dvec3(base, base_height));
    block_rays.direction = relative(rays.direction, middle, rays.direction.at(middle));
    block_rays.speed = speed_of(rays.direction, middle);
    block_rays.begin = static_cast<float>(rays.range.begin - rays.anchor);
    block_rays.end = static_cast<float>(
        std::min(rays.range.end - rays.anchor, 0.5 * std::numeric_limits<float>::max()));
    const double lift = lift_of(total) + height_rounding * std::abs(base_height);
    block_rays.lift = static_cast<float>(lift);
    block_rays.lowest = static_cast<float>(total.low - base_height - lift);
    block_rays.highest = static_cast<float>(total.high - base_height + lift);
    return block_rays;
}

TileSamples samples_of(const RayTile& tile) {
    return {.heights = &tile.heights()(0, 0),
            .height_stride = static_cast<int>(&tile.heights()(0, 1) - &tile.heights()(0, 0)),
            .maxima = tile.maxima(),
            .stride = tile.stride(),
            .rows = tile.rows(),
            .top_level = tile.top_level(),
            .cells = tile.cells()};
}

// Neighbours in a row are one thread's: their pixels share lines of the cache, which threads would
// take from each other. A thread has several runs, so that all end together.
int blocks_in_a_run(int blocks, const ParallelOptions& parallel) {
    constexpr int runs_a_thread = 16;
    constexpr int longest = 8; // longer ones gain nothing
    const int threads = static_cast<int>(thread_count(parallel.threads));
    return std::clamp(blocks / (runs_a_thread * threads), 1, longest);
}

bool overlap(const PixelBlock& a, const PixelBlock& b) {
    return glm::all(glm::lessThan(a.first, b.first + b.size)) &&
           glm::all(glm::lessThan(b.first, a.first + a.size));
}

// The t before which no ray of a block hits a tile; empty if none does.
std::optional<double> start_of(const RayTile& tile, const PictureRays& rays,
                               const PixelBlock& block, bool skips_free_space) {
    const bool is_finite = are_finite(rays.origin) && are_finite(rays.direction);
    if (!is_finite || tile.cells().x < 1 || tile.cells().y < 1) {
        return std::nullopt;
    }
    const double start =
        skips_free_space ? clear_until(tile, rays, block, rays.range.begin) : rays.range.begin;
    return start < rays.range.end ? std::optional(start) : std::nullopt;
}

// The pixels of a beam in a part of it: bits of BlockJob::beam_pixels.
std::uint16_t pixels_of(const PixelBlock& part) {
    unsigned lanes = 0;
    for (int row = part.first.y; row < part.first.y + part.size.y; ++row) {
        for (int col = part.first.x; col < part.first.x + part.size.x; ++col) {
            lanes |= 1U << static_cast<unsigned>(row % beam_rows * beam_cols + col % beam_cols);
        }
    }
    return static_cast<std::uint16_t>(lanes);
}

// Those of a part of the block, of whole beams or in one; the others hit nothing.
void start_beams(const PixelBlock& part, BlockJob& job) {
    job.found_starts = all_wide_beams;
    job.starts.fill(std::numeric_limits<float>::infinity());
    const glm::ivec2 end = part.first + part.size;
    if (part.size.x < beam_cols || part.size.y < beam_rows) {
        job.beam_pixels = pixels_of(part);
    }
    for (int row = part.first.y; row < end.y; row += beam_rows) {
        for (int col = part.first.x; col < end.x; col += beam_cols) {
            const int beam = row / beam_rows * beams_a_row + col / beam_cols;
            job.starts[static_cast<std::size_t>(beam)] = job.start;
        }
    }
}

void bend_sun_rays(const SunCourse& course, const PlacedTile& tile, BlockJob& job) {
    job.bends = &course.bends();
    const glm::dvec2 scale = course.unit_scale() / tile.scale;
    job.unit_scale = glm::vec2(scale);
    job.unit_first = glm::vec2(course.unit_first() - scale * tile.by);
}

class JobList {
public:
    JobList(const PlacedTiles& placed, const PixelBlock& block, const RaySkips& skips,
            std::vector<std::size_t>* indices)
        : placed_(placed), block_(block), skips_(skips), indices_(indices) {}

    // `part`: of the block.
    void add(std::size_t index, const PictureRays& rays, unsigned more_walls,
             const PixelBlock& part) {
        const PlacedTile& tile = placed_.tiles[index];
        const auto start = start_of(*tile.tile, rays, part, skips_.free_space);
        if (!start) {
            return;
        }
        BlockJob& job = jobs_.emplace_back();
        job.start = static_cast<float>(*start - rays.anchor);
        job.has_beams = skips_.beams;
        job.skips_blocks = skips_.blocks;
        job.skips_cells = skips_.cells;
        if (part.size != glm::ivec2(block_side)) {
            start_beams({part.first - block_.first, part.size}, job);
        }
        job.tile = samples_of(*tile.tile);
        job.rays = rays_of(*tile.tile, rays, block_);
        job.paint = &tile.paint;
        job.sun = tile.sun_tiles.empty() ? nullptr : &tile.sun;
        job.albedo = tile.albedo ? &*tile.albedo : nullptr;
        job.normals = tile.albedo ? &tile.normals : nullptr;
        job.sun_share = tile.sun_share ? &*tile.sun_share : nullptr;
        job.sun_tiles = tile.sun_tiles;
        if (placed_.sun_course != nullptr) {
            bend_sun_rays(*placed_.sun_course, tile, job);
        }
        if (skips_.certain && !tile.certain_sun.empty()) {
            job.certain_sun = tile.certain_sun.data();
            job.certain_stride = tile.certain_stride;
        }
        job.walls = tile.walls | more_walls;
        job.wall_floor =
            static_cast<float>(placed_.wall_floor - job.rays.base_height) - job.rays.lift;
        if (indices_ != nullptr) {
            indices_->push_back(index);
        }
    }

    std::vector<BlockJob> run() {
        if (placed_.curve != nullptr) {
            add_pieces();
            return std::move(jobs_);
        }
        for (std::size_t i = 0; i < placed_.tiles.size(); ++i) {
            if (overlap(placed_.tiles[i].seen, block_)) {
                add(i, placed_.tiles[i].rays, 0, {block_.first, glm::ivec2(block_side)});
            }
        }
        return std::move(jobs_);
    }

private:
    void add_pieces() {
        const RayPiece* last = nullptr;
        for (const RayPiece& piece : placed_.curve->pieces(block_)) {
            const bool is_first = last == nullptr || last->block.first != piece.block.first;
            add_piece(piece, is_first ? 0U : begin_wall);
            last = &piece;
        }
    }

    // One tile after the other, although the rays are bent: in parts that pass each border in one
    // direction.
    void add_piece(const RayPiece& piece, unsigned walls) {
        if (placed_.nodes.empty()) {
            add(0, piece.rays, walls, piece.block);
            return;
        }
        const auto along = [&](const PictureRays& rays) {
            return tiles_along(placed_.nodes, rays, piece.block, placed_.turn);
        };
        const TilesAlong all = along(piece.rays);
        if (!glm::any(all.turns)) {
            add_all(all.tiles, piece.rays, walls, piece.block);
            return;
        }
        if (piece.rays.origin.is_bent() || piece.rays.direction.is_bent()) {
            add_parts(piece, walls);
            return;
        }
        const auto tolerance = [&](double t) { return placed_.curve->unseen_samples(piece, t); };
        for (const PictureRays& rays :
             without_turns(piece.rays, piece.block, all.turns, tolerance)) {
            add_all(along(rays).tiles, rays, walls, piece.block);
            walls = begin_wall;
        }
    }

    // Fewer rays have one order more often. Those of a pixel without one become linear.
    void add_parts(const RayPiece& piece, unsigned walls) {
        constexpr glm::ivec2 beam(beam_cols, beam_rows);
        const glm::ivec2 whole = piece.block.size;
        const bool is_last = whole == glm::ivec2(1) || (whole.x <= beam.x && whole.y <= beam.y &&
                                                        placed_.curve->is_linear(piece));
        const glm::ivec2 size = is_last ? whole : part_size(whole);
        for (int row = 0; row < whole.y; row += size.y) {
            for (int col = 0; col < whole.x; col += size.x) {
                RayPiece part = piece;
                part.block = {piece.block.first + glm::ivec2(col, row), size};
                if (is_last) {
                    part.rays = made_linear(part.rays, part.block.first, size);
                }
                add_piece(part, walls);
            }
        }
    }

    void add_all(const std::vector<TileAlong>& tiles, const PictureRays& rays, unsigned walls,
                 const PixelBlock& part) {
        for (const TileAlong& along : tiles) {
            const PlacedTile& tile = placed_.tiles[along.tile];
            const glm::dvec2 by = tile.by + tile.scale * glm::dvec2(along.by, 0.0);
            add(along.tile, in_samples(rays, tile.scale, by), walls, part);
        }
    }

    const PlacedTiles& placed_;
    const PixelBlock& block_;
    const RaySkips& skips_;
    std::vector<std::size_t>* indices_;
    std::vector<BlockJob> jobs_;
};

} // namespace

SunTile sun_tile(const RayTile& tile, glm::dvec3 to_sun) {
    SunTile made;
    made.tile = samples_of(tile);
    made.highest = static_cast<float>(tile.total().high);
    made.lift = static_cast<float>(lift_of(tile.total()));
    made.to_sun = glm::vec3(to_sun);
    return made;
}

std::vector<BlockJob> block_jobs(const PlacedTiles& placed, const PixelBlock& block,
                                 const RaySkips& skips, std::vector<std::size_t>* indices) {
    return JobList(placed, block, skips, indices).run();
}

namespace {

glm::ivec2 blocks_of(glm::ivec2 size) {
    return (size + block_side - 1) / block_side;
}

} // namespace

int block_count(glm::ivec2 size) {
    return blocks_of(size).x * blocks_of(size).y;
}

bool for_each_block(glm::ivec2 size, const ParallelOptions& parallel,
                    const std::function<void(const PixelBlock& block, std::size_t index)>& body) {
    const glm::ivec2 blocks = blocks_of(size);
    const int run = blocks_in_a_run(block_count(size), parallel);
    const int runs_a_row = (blocks.x + run - 1) / run;
    const auto do_run = [&](int index) {
        const int row = index / runs_a_row;
        const int first_col = index % runs_a_row * run;
        for (int col = first_col; col < std::min(first_col + run, blocks.x); ++col) {
            const glm::ivec2 first = block_side * glm::ivec2(col, row);
            const int number = row * blocks.x + col;
            body({first, glm::min(size - first, glm::ivec2(block_side))},
                 static_cast<std::size_t>(number));
        }
    };
    return parallel_for(runs_a_row * blocks.y, do_run, parallel);
}

} // namespace reljef::cast

#include "engine/scene/streaming/tile_builder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/bilinear.h"
#include "engine/scene/streaming/ground_overlay.h"

namespace reljef::scene {
namespace {

// Vertices and one step around: sample (col + 1, row + 1) is vertex (col, row).
struct Surround {
    FilledHeights filled;
    Grid<glm::dvec3> places; // local metres
};

// `filled`: from the vertex before `first` on.
Surround surround_of(const TileBuilder& builder, terrain::TreeTile tile, glm::ivec2 first,
                     FilledHeights filled) {
    const glm::ivec2 size(filled.heights.cols(), filled.heights.rows());
    Surround around{std::move(filled), Grid<glm::dvec3>(size.x, size.y)};
    for (int row = 0; row < size.y; ++row) {
        for (int col = 0; col < size.x; ++col) {
            around.places(col, row) = builder.place(tile, first + glm::ivec2(col - 1, row - 1),
                                                    around.filled.heights(col, row));
        }
    }
    return around;
}

// At a pole, where there is no east, the normal is up.
glm::dvec3 normal_of(glm::dvec3 east, glm::dvec3 north, glm::dvec3 up) {
    constexpr double min_east = 1e-6;
    return glm::length(east) > min_east * glm::length(north)
               ? glm::normalize(glm::cross(east, north))
               : up;
}

void set_places(const Surround& around, const terrain::Placement& placement, TerrainTile& tile) {
    const glm::ivec2 count = tile.cells + 1;
    for (int row = 1; row <= count.y; ++row) {
        for (int col = 1; col <= count.x; ++col) {
            tile.bounds.add(around.places(col, row));
        }
    }
    tile.normals = Grid<glm::vec3>(count.x, count.y);
    tile.heightfield.heights = Grid<float>(count.x, count.y);
    for (int row = 1; row <= count.y; ++row) {
        for (int col = 1; col <= count.x; ++col) {
            const glm::dvec3 east = around.places(col + 1, row) - around.places(col - 1, row);
            const glm::dvec3 north = around.places(col, row - 1) - around.places(col, row + 1);
            tile.normals(col - 1, row - 1) =
                glm::vec3(normal_of(east, north, placement.up(around.places(col, row))));
            tile.heightfield.heights(col - 1, row - 1) = around.filled.heights(col, row);
        }
    }
}

Grid<terrain::MinMax> blocks_of(const Grid<float>& heights) {
    const terrain::MinMaxPyramid pyramid(heights.view());
    constexpr int level = std::countr_zero(static_cast<unsigned>(cells_per_block));
    return pyramid.level(std::min(level, pyramid.last_level()));
}

double error_of(const Grid<float>& heights) {
    float largest = 0.0F;
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 1; col + 1 < heights.cols(); col += 2) {
            const float middle = 0.5F * (heights(col - 1, row) + heights(col + 1, row));
            largest = std::max(largest, std::abs(heights(col, row) - middle));
        }
    }
    for (int row = 1; row + 1 < heights.rows(); row += 2) {
        for (int col = 0; col < heights.cols(); ++col) {
            const float middle = 0.5F * (heights(col, row - 1) + heights(col, row + 1));
            largest = std::max(largest, std::abs(heights(col, row) - middle));
        }
    }
    return largest;
}

// Whether a vertex and its eight neighbours are at 0.
bool is_sea(const Grid<float>& heights, int col, int row) {
    for (int r = row - 1; r <= row + 1; ++r) {
        const auto neighbours = heights.row(r).subspan(static_cast<std::size_t>(col - 1), 3);
        if (std::any_of(neighbours.begin(), neighbours.end(), [](float h) { return h != 0.0F; })) {
            return false;
        }
    }
    return true;
}

// Rise over run to the east and to the north. `spacing`: metres between samples.
glm::vec2 gradient_at(const Grid<float>& heights, glm::ivec2 at, glm::vec2 spacing) {
    return {(heights(at.x + 1, at.y) - heights(at.x - 1, at.y)) / (2.0F * spacing.x),
            (heights(at.x, at.y - 1) - heights(at.x, at.y + 1)) / (2.0F * spacing.y)};
}

// Of four samples around a place, `part` of the way from the second to the third (De Boor 1978).
std::array<double, 4> spline_weights(double part) {
    const double rest = 1.0 - part;
    const auto inner = [](double t) { return (4.0 - 3.0 * t * t * (2.0 - t)) / 6.0; };
    return {rest * rest * rest / 6.0, inner(part), inner(rest), part * part * part / 6.0};
}

// Cubic B-spline: bends nowhere, as bilinear heights do at samples. `turn`: columns after which
// they repeat, or 0.
float smooth_height(GridView<const float> heights, glm::dvec2 sample, int turn) {
    const glm::dvec2 last(heights.cols() - 1, heights.rows() - 1);
    const glm::dvec2 place = glm::clamp(sample, glm::dvec2(0.0), last);
    const glm::ivec2 first(glm::floor(place));
    const auto of_cols = spline_weights(place.x - first.x);
    const auto of_rows = spline_weights(place.y - first.y);
    double height = 0.0;
    for (int row = 0; row < 4; ++row) {
        const int at = std::clamp(first.y + row - 1, 0, heights.rows() - 1);
        for (int col = 0; col < 4; ++col) {
            const int beside = first.x + col - 1;
            const int around = turn > 0 ? (beside + turn) % turn : beside;
            height += of_rows[static_cast<std::size_t>(row)] *
                      of_cols[static_cast<std::size_t>(col)] *
                      heights(std::clamp(around, 0, heights.cols() - 1), at);
        }
    }
    return static_cast<float>(height);
}

bool is_void_at(const terrain::Heightfield& heightfield, glm::dvec2 sample) {
    const Grid<std::uint8_t>& voids = heightfield.void_mask;
    const glm::ivec2 nearest(glm::round(sample));
    return !voids.empty() && voids.clamped(nearest.x, nearest.y) != 0;
}

// The mean over a square of `side` samples.
float average_around(const terrain::Heightfield& heightfield, glm::dvec2 sample, int side) {
    const auto view = heightfield.heights.view();
    double sum = 0.0;
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            sum += terrain::bilinear_height(view, sample + glm::dvec2(col, row) - 0.5 * (side - 1));
        }
    }
    return static_cast<float>(sum / (static_cast<double>(side) * side));
}

bool shows_something(const Image& texels) {
    return std::any_of(texels.samples().begin(), texels.samples().end(),
                       [](Rgba8 texel) { return texel.a != 0; });
}

} // namespace

std::size_t bytes_of_tile(int texels_per_cell) {
    const auto samples = [](int texels) {
        const double side = terrain::tree_tile_cells * texels + 1;
        return side * side;
    };
    const double more = samples(texels_per_cell) - samples(1);
    return bytes_per_tile + static_cast<std::size_t>(bytes_per_texel * more);
}

namespace {

// Over a plane, rows of the overview are one spacing apart, also those of added poles. Rows of the
// terrain lie between them as latitudes do, so that its poles are nearer than the overview's:
// otherwise they would be no even rows, and no error of a coarser tile would hold.
geo::WrappedRows even_rows(geo::GlobalWrap wrap, int overview_rows) {
    const int source_rows = overview_rows - wrap.rows();
    wrap.north = wrap.north_rows();
    wrap.south = wrap.south_rows();
    return {wrap, source_rows};
}

} // namespace

TileBuilder::TileBuilder(std::shared_ptr<const TerrainSurface> overview, terrain::TileTree tree,
                         int reduction, const ImageryDetail& imagery, const geo::GlobalWrap& wrap)
    : overview_(std::move(overview)), tree_(tree), reduction_{reduction, {}, {}}, imagery_(imagery),
      tint_(overview_->ramp(), overview_->heightfield()) {
    if (tint_.has_water()) {
        water_ = terrain::water_mask(overview_->heightfield());
    }
    no_data_ = terrain::no_data_mask(overview_->heightfield(), overview_->ramp());
    check(reduction >= 1 && imagery.refinement >= 1,
          "an overview of a reduction of at least 1 was expected");
    reduction_.rows = {wrap, (tree.rows() - 1) / imagery.refinement + 1 - wrap.rows()};
    if (const auto& georeference = overview_->heightfield().georeference) {
        reduction_.overview_rows = georeference->geodetic.rows();
        if (overview_->placement().kind() == terrain::PlacementKind::plane) {
            reduction_.overview_rows =
                even_rows(reduction_.overview_rows.wrap(), overview_->heightfield().heights.rows());
        }
    }
}

double TileBuilder::step(terrain::TreeTile tile) const {
    return static_cast<double>(terrain::TileTree::step(tile)) / imagery_.refinement;
}

glm::dvec2 TileBuilder::first(terrain::TreeTile tile) const {
    return glm::dvec2(terrain::TileTree::first(tile)) / static_cast<double>(imagery_.refinement);
}

glm::dvec2 TileBuilder::sample(terrain::TreeTile tile, glm::ivec2 vertex) const {
    glm::ivec2 at = tree_.sample(tile, vertex);
    if (reduction_.rows.wrap().around) {
        const int step = terrain::TileTree::step(tile);
        const int first = terrain::TileTree::first(tile).x + vertex.x * step;
        const int turn = tree_.cols() - 1;
        const int last_vertex = (turn + step - 1) / step;
        if (first < 0) { // the last cell around may be shorter
            at.x = (last_vertex + first / step) * step - turn;
        } else if (first / step > last_vertex) {
            at.x = turn + (first / step - last_vertex) * step;
        }
    }
    return glm::dvec2(at) / static_cast<double>(imagery_.refinement);
}

terrain::TileLattice TileBuilder::lattice(terrain::TreeTile tile) const {
    const glm::ivec2 cells = tree_.cells(tile);
    return {first(tile), sample(tile, cells), step(tile), cells, reduction_.rows};
}

terrain::Placement TileBuilder::placement(terrain::TreeTile tile) const {
    return overview_->placement().of_tile(reduction_, lattice(tile));
}

glm::dvec2 TileBuilder::around_overview(glm::dvec2 overview_sample) const {
    const int turn = overview_->heightfield().heights.cols() - 1;
    if (reduction_.overview_rows.wrap().east) {
        overview_sample.x -= turn * std::floor(overview_sample.x / turn);
    }
    return overview_sample;
}

bool TileBuilder::has_all_samples(terrain::TreeTile tile) const {
    return terrain::TileTree::step(tile) <= imagery_.refinement;
}

terrain::TreeTile TileBuilder::tile_at(int level, glm::dvec2 sample) const {
    const glm::dvec2 last(tree_.cols() - 1, tree_.rows() - 1);
    const int side = terrain::tree_tile_cells << level;
    const glm::ivec2 at =
        glm::ivec2(glm::clamp(tree_sample(sample), glm::dvec2(0.0), last - 0.5)) / side;
    return {level, at.x, at.y};
}

int TileBuilder::texels_per_cell(int level) const {
    if (imagery_.finest_pixel <= 0.0) {
        return 1;
    }
    int texels = 1;
    while (texels < imagery_.max_texels &&
           spacing(level) > 1.001 * texels * imagery_.finest_pixel) {
        texels *= 2;
    }
    return texels;
}

glm::ivec2 TileBuilder::picture_size(terrain::TreeTile tile) const {
    return tree_.cells(tile) * texels_per_cell(tile.level) + 1;
}

double TileBuilder::texel(int level) const {
    return spacing(level) / texels_per_cell(level);
}

std::size_t TileBuilder::bytes_per_tile() const {
    return bytes_of_tile(texels_per_cell(tree_.root().level));
}

double TileBuilder::spacing(int level) const {
    const glm::dvec2 spacing = overview_->heightfield().spacing;
    return std::max(spacing.x, spacing.y) / reduction_.factor * step({level, 0, 0});
}

glm::dvec3 TileBuilder::place(terrain::TreeTile tile, glm::ivec2 vertex, double height) const {
    const glm::dvec2 at = on_overview(sample(tile, vertex));
    return overview_->placement().world_from_sample({at, height});
}

Box TileBuilder::bounds(terrain::TreeTile tile, terrain::HeightRange range) const {
    return bounds(tile, {0, 0}, tree_.cells(tile), range);
}

Box TileBuilder::bounds(terrain::TreeTile tile, glm::ivec2 first_vertex, glm::ivec2 last_vertex,
                        terrain::HeightRange range) const {
    return terrain::placed_bounds(overview_->placement(), on_overview(sample(tile, first_vertex)),
                                  on_overview(sample(tile, last_vertex)), range);
}

TileSummary TileBuilder::summary(terrain::TreeTile tile, const terrain::TileProof& proof) const {
    TileSummary summary;
    summary.id = tile;
    summary.range = {proof.low, proof.high};
    summary.bounds =
        bounds(tile, {summary.range.low - proof.error, summary.range.high + proof.error});
    summary.error = overview_->placement().exaggeration() * proof.error;
    summary.is_proven = true;
    summary.block_shares = proof.block_shares;
    return summary;
}

Grid<float> TileBuilder::overview_heights(terrain::TreeTile tile) const {
    const terrain::Heightfield& overview = overview_->heightfield();
    const int taps = std::max(1, static_cast<int>(step(tile) / reduction_.factor));
    const glm::ivec2 count = tree_.cells(tile) + 3;
    Grid<float> heights(count.x, count.y);
    for (int row = 0; row < count.y; ++row) {
        for (int col = 0; col < count.x; ++col) {
            const glm::dvec2 at = around_overview(on_overview(sample(tile, {col - 1, row - 1})));
            heights(col, row) = is_void_at(overview, at) ? std::numeric_limits<float>::quiet_NaN()
                                                         : average_around(overview, at, taps);
        }
    }
    return heights;
}

double TileBuilder::overview_error(terrain::TreeTile tile) const {
    const Grid<float>& heights = overview_->heightfield().heights;
    if (step(tile) >= reduction_.factor) {
        return 0.0;
    }
    const glm::ivec2 last(heights.cols() - 1, heights.rows() - 1);
    const auto inside = [&](glm::dvec2 at) { return glm::clamp(glm::ivec2(at), {0, 0}, last); };
    const glm::ivec2 low = inside(glm::floor(on_overview(sample(tile, {0, 0}))));
    const glm::ivec2 high = inside(glm::ceil(on_overview(sample(tile, tree_.cells(tile)))));
    float largest = 0.0F;
    for (int row = low.y; row <= high.y; ++row) {
        for (int col = low.x; col <= high.x; ++col) {
            const float along =
                0.5F * (heights.clamped(col - 1, row) + heights.clamped(col + 1, row));
            const float across =
                0.5F * (heights.clamped(col, row - 1) + heights.clamped(col, row + 1));
            const float height = heights(col, row);
            largest = std::max({largest, std::abs(height - along), std::abs(height - across)});
        }
    }
    return overview_->placement().exaggeration() * largest;
}

Rgba8 TileBuilder::color_at(glm::dvec2 overview_sample, Rgba8 tint) const {
    const Image& picture = overview_->terrain().color;
    if (picture.empty()) {
        return tint;
    }
    const Grid<float>& samples = overview_->heightfield().heights;
    const glm::dvec2 share =
        around_overview(overview_sample) / glm::dvec2(samples.cols() - 1, samples.rows() - 1);
    const glm::dvec2 texel = glm::clamp(share, glm::dvec2(0.0), glm::dvec2(1.0)) *
                             glm::dvec2(picture.cols() - 1, picture.rows() - 1);
    const Rgba8 nearest =
        picture(static_cast<int>(std::lround(texel.x)), static_cast<int>(std::lround(texel.y)));
    return nearest.a < 128
               ? tint
               : terrain::mixed(tint,
                                rgba8_from_linear(bilinear(picture, texel, linear_from_rgba8)),
                                static_cast<float>(overview_->imagery_share()));
}

bool TileBuilder::is_lake(glm::dvec2 overview_sample) const {
    if (water_.empty()) {
        return false;
    }
    const glm::ivec2 nearest(glm::round(around_overview(overview_sample)));
    return water_.clamped(nearest.x, nearest.y) != 0;
}

bool TileBuilder::is_outside(glm::dvec2 overview_sample) const {
    if (overview_->ramp().no_data || no_data_.empty()) {
        return overview_->ramp().no_data.has_value();
    }
    // The samples around: averages of the overview reach into voids.
    const glm::ivec2 nearest(glm::round(around_overview(overview_sample)));
    for (int row = -1; row <= 1; ++row) {
        for (int col = -1; col <= 1; ++col) {
            if (no_data_.clamped(nearest.x + col, nearest.y + row) != 0) {
                return true;
            }
        }
    }
    return false;
}

FilledHeights TileBuilder::filled(terrain::TreeTile tile, Grid<float> heights,
                                  Grid<std::uint8_t> was_void) const {
    if (!was_void.empty()) {
        return {std::move(heights), std::move(was_void)};
    }
    const auto samples = heights.samples();
    if (std::all_of(samples.begin(), samples.end(), [](float h) { return std::isfinite(h); })) {
        return {std::move(heights), {}};
    }
    const auto overview = overview_->heightfield().heights.view();
    const int turn = reduction_.overview_rows.wrap().east ? overview.cols() - 1 : 0;
    Grid<float> coarse(heights.cols(), heights.rows());
    for (int row = 0; row < coarse.rows(); ++row) {
        for (int col = 0; col < coarse.cols(); ++col) {
            const glm::dvec2 at = around_overview(on_overview(sample(tile, {col - 1, row - 1})));
            coarse(col, row) = smooth_height(overview, at, turn);
        }
    }
    // A sample of the overview, which has no finer waves, in vertices.
    const double reach = std::max(1.0, reduction_.factor / step(tile));
    return fill_tile_voids(std::move(heights), coarse, reach);
}

Image TileBuilder::vertex_colors(const TerrainTile& tile, glm::ivec2 first,
                                 const FilledHeights& filled, bool with_overview) const {
    const Grid<float>& around = filled.heights;
    const Grid<std::uint8_t>& voids = filled.was_void;
    Image colors(tile.cells.x + 1, tile.cells.y + 1);
    const glm::vec2 spacing(overview_->heightfield().spacing * (step(tile.id) / reduction_.factor));
    for (int row = 0; row < colors.rows(); ++row) {
        for (int col = 0; col < colors.cols(); ++col) {
            const glm::dvec2 at = on_overview(sample(tile.id, first + glm::ivec2(col, row)));
            if (!voids.empty() && voids(col + 1, row + 1) != 0 && is_outside(at)) {
                colors(col, row) = tint_.no_data();
                continue;
            }
            const bool is_water =
                tint_.has_water() && (is_sea(around, col + 1, row + 1) || is_lake(at));
            const Rgba8 tint = is_water
                                   ? terrain::HeightTint::water
                                   : tint_.at(tile.heightfield.heights(col, row),
                                              gradient_at(around, {col + 1, row + 1}, spacing));
            colors(col, row) = with_overview ? color_at(at, tint) : tint;
        }
    }
    return colors;
}

TerrainTile TileBuilder::make_part(terrain::TreeTile tile, glm::ivec2 first, FilledHeights filled,
                                   bool with_overview) const {
    TerrainTile made;
    made.id = tile;
    made.cells = {filled.heights.cols() - 3, filled.heights.rows() - 3};
    const Surround around = surround_of(*this, tile, first, std::move(filled));
    set_places(around, overview_->placement(), made);
    made.up = glm::vec3(overview_->placement().up(made.bounds.center()));
    made.albedo = vertex_colors(made, first, around.filled, with_overview);
    return made;
}

TerrainTile TileBuilder::make_cell(terrain::TreeTile tile, glm::ivec2 vertex,
                                   const FilledHeights& filled) const {
    FilledHeights around{Grid<float>(4, 4), {}};
    if (!filled.was_void.empty()) {
        around.was_void = Grid<std::uint8_t>(4, 4);
    }
    for (int row = 0; row < around.heights.rows(); ++row) {
        for (int col = 0; col < around.heights.cols(); ++col) {
            around.heights(col, row) = filled.heights(vertex.x + col, vertex.y + row);
            if (!around.was_void.empty()) {
                around.was_void(col, row) = filled.was_void(vertex.x + col, vertex.y + row);
            }
        }
    }
    TerrainTile made = make_part(tile, vertex, std::move(around), true);
    blend_overlay(*this, made, vertex);
    return made;
}

TerrainTile TileBuilder::make(terrain::TreeTile tile, Grid<float> heights,
                              const TilePicture& picture, Grid<std::uint8_t> was_void) const {
    const glm::ivec2 cells = tree_.cells(tile);
    check(heights.cols() == cells.x + 3 && heights.rows() == cells.y + 3,
          "a tile's heights with one around were expected");
    const double share = overview_->imagery_share();
    const bool with_overview = picture.texels.empty() || (!picture.whole && share == 1.0);
    TerrainTile made = make_part(
        tile, {0, 0}, filled(tile, std::move(heights), std::move(was_void)), with_overview);
    const Grid<float>& placed = made.heightfield.heights;
    made.range = terrain::height_range(placed, {});
    made.heightfield.range = made.range;
    made.heightfield.spacing = overview_->heightfield().spacing * (step(tile) / reduction_.factor);
    made.placement = placement(tile);
    made.blocks = blocks_of(placed);
    made.error = overview_->placement().exaggeration() * error_of(placed);
    made.coarse_texel = picture.has_more ? texel(tile.level) : 0.0;
    if (shows_something(picture.texels)) {
        const glm::ivec2 size = picture_size(tile);
        check(picture.texels.cols() == size.x && picture.texels.rows() == size.y,
              "a picture of a tile's picture_size was expected");
        made.albedo = terrain::composite(picture.texels, made.albedo, share);
    }
    blend_overlay(*this, made);
    return made;
}

} // namespace reljef::scene

#include <algorithm>
#include <cmath>
#include <mutex>
#include <unordered_map>

#include <glm/common.hpp>

#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/georeferencing.h"
#include "engine/io/raster/globe.h"
#include "engine/io/raster/sample_decoder.h"
#include "engine/io/remote/read_scope.h"
#include "engine/io/tile_set_state.h"

namespace reljef::io {
namespace {

constexpr int block_side = 1024; // lattice points per read
constexpr int min_chunk = 16384; // places per transform
// Samples: rounding error of places that are computed to be on a sample.
constexpr double on_sample = 1e-7;

using Kind = HeightSample::Kind;

// Degrees: 1 µm. PROJ's inverse of a datum shift grid is iterative and errs by tens of µm.
constexpr double inexact = 1e-11;
constexpr std::size_t probed_places = 64;

bool is_exact_inverse(std::span<const glm::dvec2> places, std::span<const glm::dvec2> points,
                      const CrsTransform& to_degrees) {
    std::vector<glm::dvec2> again(points.begin(), points.end());
    to_degrees.apply(again);
    for (std::size_t i = 0; i < again.size(); ++i) {
        const glm::dvec2 miss = again[i] - places[i];
        if (std::abs(std::remainder(miss.x, 360.0)) > inexact || std::abs(miss.y) > inexact) {
            return false;
        }
    }
    return true;
}

/// Transforms (longitude, latitude) to a layer's CRS in place; corrects an inexact PROJ inverse.
void to_crs(const TileLayer& layer, const CrsTransform& transform, std::span<glm::dvec2> places) {
    std::vector<glm::dvec2> points(places.begin(), places.end());
    transform.apply(points);
    const auto back = CrsTransform::create(layer.crs, wgs84_degrees, layer.box);
    const std::size_t probed = std::min(places.size(), probed_places);
    if (back && !is_exact_inverse(places.first(probed), std::span(points).first(probed), *back)) {
        back->apply(points);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const glm::dvec2 miss = places[i] - points[i];
            points[i] = places[i] + glm::dvec2(std::remainder(miss.x, 360.0), miss.y);
        }
        transform.apply(points);
    }
    std::copy(points.begin(), points.end(), places.begin());
}

/// Lattice points of places; NaN if undefined.
std::vector<glm::dvec2> lattice_points(const TileLayer& layer, std::span<const glm::dvec2> places,
                                       std::span<const int> requested, unsigned threads) {
    std::vector<glm::dvec2> points(requested.size());
    const auto count = static_cast<int>(requested.size());
    const int size = std::max(min_chunk, count / static_cast<int>(thread_count(threads)) + 1);
    const auto transform_part = [&](int chunk) {
        const GdalMessages ignored_messages; // projections are undefined at some places
        const auto begin = static_cast<std::size_t>(chunk) * static_cast<std::size_t>(size);
        const auto part = std::span(points).subspan(
            begin, std::min(static_cast<std::size_t>(size), points.size() - begin));
        for (std::size_t i = 0; i < part.size(); ++i) {
            const glm::dvec2 place = places[static_cast<std::size_t>(requested[begin + i])];
            part[i] = {place.y, place.x};
        }
        const auto transform = CrsTransform::create(wgs84_degrees, layer.crs, layer.box);
        if (!transform) {
            std::fill(part.begin(), part.end(), glm::dvec2(void_value));
            return;
        }
        to_crs(layer, *transform, part);
        for (glm::dvec2& point : part) {
            point = layer.lattice_from_wrapped(point);
        }
    };
    parallel_for((count + size - 1) / size, transform_part,
                 {.threads = threads, .stop = {}, .progress = {}});
    return points;
}

/// The tile that contains a point, or the nearest one within half a step.
struct OnTile {
    const LayerTile* tile = nullptr;
    glm::dvec2 point{0.0}; // on the layer's lattice, shifted by the tile's offset
};

double snapped(double value) {
    return std::abs(value - std::round(value)) <= on_sample ? std::round(value) : value;
}

glm::dvec2 clamped_to(const LayerTile& tile, glm::dvec2 point) {
    return glm::clamp(point, glm::dvec2(tile.col, tile.row),
                      glm::dvec2(tile.col + tile.cols - 1, tile.row + tile.rows - 1));
}

/// Distance of a point from a tile's samples, in steps; 0 inside.
double outside_by(const LayerTile& tile, glm::dvec2 point) {
    const glm::dvec2 outside = glm::abs(point - clamped_to(tile, point));
    return std::max(outside.x, outside.y);
}

/// Indexes of points in a block of the lattice.
struct Block {
    glm::ivec2 first{0};
    std::vector<int> points;
};

/// Clamps a point between the outermost row and a pole to the layer's cells.
glm::dvec2 in_reach(const TileLayer& layer, const geo::GlobalWrap& wrap, glm::dvec2 point) {
    const double north = -point.y;
    const double south = point.y - (layer.rows - 1.0);
    if (north > 0.0 && north <= wrap.north + on_sample) {
        point.y = std::max(point.y, -0.5);
    } else if (south > 0.0 && south <= wrap.south + on_sample) {
        point.y = std::min(point.y, layer.rows - 0.5);
    }
    return point;
}

std::vector<Block> blocks_of(const TileLayer& layer, const geo::GlobalWrap& wrap,
                             std::span<const glm::dvec2> points) {
    std::unordered_map<std::int64_t, std::size_t> numbers;
    std::vector<Block> blocks;
    const double first = -0.5 - on_sample;
    const glm::dvec2 last = glm::dvec2(layer.cols, layer.rows) - 1.0 - first;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec2 point = in_reach(layer, wrap, points[i]);
        if (!(point.x >= first && point.y >= first && point.x <= last.x && point.y <= last.y)) {
            continue;
        }
        const glm::ivec2 at(glm::max(point, 0.0) / static_cast<double>(block_side));
        const std::int64_t key = (static_cast<std::int64_t>(at.y) << 32) + at.x;
        const auto [entry, is_new] = numbers.try_emplace(key, blocks.size());
        if (is_new) {
            blocks.push_back({at * block_side, {}});
        }
        blocks[entry->second].points.push_back(static_cast<int>(i));
    }
    return blocks;
}

/// Extent of a tile: between samples only, or to the edge of its cells.
enum class Reach { samples, half_a_cell };

/// Heights of the poles of a global layer, metres; NaN if unused.
struct Poles {
    geo::GlobalWrap wrap;
    double north = void_value;
    double south = void_value;
};

/// NaN for a row without heights.
double mean_of_row(const TileLayer& layer, int row, const LayerReading& reading,
                   std::vector<FileError>& errors) {
    const CellWindow window{1, glm::ivec2(0), {0, row}, layer.cols, 1};
    const Grid<double> heights = read_cells(layer, window, reading, errors);
    double sum = 0.0;
    int count = 0;
    for (const double height : heights.samples()) {
        sum += std::isnan(height) ? 0.0 : height;
        count += std::isnan(height) ? 0 : 1;
    }
    return count > 0 ? sum / count : void_value;
}

Poles poles_of(const TileLayer& layer, std::span<const glm::dvec2> points,
               const LayerReading& reading, std::vector<FileError>& errors) {
    const int last = layer.rows - 1;
    bool any_north = false;
    bool any_south = false;
    for (const glm::dvec2 point : points) {
        any_north = any_north || point.y < 0.0;
        any_south = any_south || point.y > last;
    }
    Poles poles;
    if (any_north || any_south) {
        poles.wrap =
            closing_of(crs_from_text(layer.crs), layer.crs_from_lattice, layer.cols, layer.rows);
    }
    if (any_north && poles.wrap.north > 0.0) {
        poles.north = mean_of_row(layer, 0, reading, errors);
    }
    if (any_south && poles.wrap.south > 0.0) {
        poles.south = mean_of_row(layer, last, reading, errors);
    }
    return poles;
}

/// A layer's heights at the points of a block.
class BlockHeights {
public:
    BlockHeights(const TileLayer& layer, const Block& block, std::span<const glm::dvec2> points,
                 Reach reach, const Poles& poles)
        : layer_(layer), block_(block), points_(points), reach_(reach), poles_(poles) {
        const glm::dvec2 low(block.first - 1);
        const glm::dvec2 high(block.first + block_side + 1);
        for (const LayerTile& tile : layer.tiles) {
            const bool apart = tile.col > high.x || tile.row > high.y ||
                               tile.col + tile.cols < low.x || tile.row + tile.rows < low.y;
            if (!apart) {
                near_.push_back(&tile);
            }
        }
    }

    /// Calls answer(index, answer) for each point on a tile.
    template <class Answer>
    void find(const LayerReading& reading, std::vector<FileError>& errors, const Answer& answer) {
        std::vector<OnTile> found;
        found.reserve(block_.points.size());
        for (const int index : block_.points) {
            found.push_back(
                locate(in_reach(layer_, poles_.wrap, points_[static_cast<std::size_t>(index)])));
        }
        const CellWindow window = window_of(found);
        if (window.cols == 0) {
            return;
        }
        const Grid<double> heights = read_cells(layer_, window, reading, errors);
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (found[i].tile != nullptr) {
                const HeightSample flat =
                    answer_at(heights, found[i].point - glm::dvec2(window.first));
                answer(block_.points[i], towards_pole(flat, block_.points[i]));
            }
        }
    }

private:
    [[nodiscard]] OnTile locate(glm::dvec2 point) const {
        OnTile nearest;
        double min_outside = 0.5 + on_sample;
        for (const LayerTile* tile : near_) {
            glm::dvec2 own = point - tile->offset;
            own = {snapped(own.x), snapped(own.y)};
            const double outside = outside_by(*tile, own);
            if (outside < min_outside) {
                nearest = {tile, own};
                min_outside = outside;
            }
            if (outside == 0.0) {
                return nearest;
            }
        }
        if (nearest.tile != nullptr && !between_tiles(nearest.point)) {
            return reach_ == Reach::half_a_cell
                       ? OnTile{nearest.tile, clamped_to(*nearest.tile, nearest.point)}
                       : OnTile{};
        }
        return nearest;
    }
    /// Whether tiles contain all four samples around a point.
    [[nodiscard]] bool between_tiles(glm::dvec2 point) const {
        const glm::dvec2 low = glm::floor(point);
        const glm::dvec2 high = glm::ceil(point);
        const std::array samples{low, glm::dvec2(high.x, low.y), glm::dvec2(low.x, high.y), high};
        return std::all_of(samples.begin(), samples.end(), [&](glm::dvec2 sample) {
            return std::any_of(near_.begin(), near_.end(), [&](const LayerTile* tile) {
                return outside_by(*tile, sample) == 0.0;
            });
        });
    }
    /// Interpolates between the outermost row and a pole.
    [[nodiscard]] HeightSample towards_pole(HeightSample answer, int index) const {
        const double row = points_[static_cast<std::size_t>(index)].y;
        const bool north = row < 0.0;
        const double beyond = north ? -row : row - (layer_.rows - 1.0);
        const double pole = north ? poles_.north : poles_.south;
        if (beyond > 0.0 && !std::isnan(pole)) {
            const double steps = north ? poles_.wrap.north : poles_.wrap.south;
            answer.height = glm::mix(answer.height, pole, std::min(beyond / steps, 1.0));
        }
        return answer;
    }
    static CellWindow window_of(std::span<const OnTile> found) {
        PointBounds bounds;
        for (const OnTile& place : found) {
            if (place.tile != nullptr) {
                bounds.add(place.point);
            }
        }
        CellWindow window;
        if (bounds.low.x <= bounds.high.x) {
            window.set_range(glm::floor(bounds.low), glm::ceil(bounds.high));
        }
        return window;
    }
    static HeightSample answer_at(const Grid<double>& heights, glm::dvec2 at) {
        const glm::ivec2 low(glm::floor(at));
        const glm::ivec2 high(glm::ceil(at));
        const glm::dvec2 part = at - glm::dvec2(low);
        const double north = glm::mix(heights(low.x, low.y), heights(high.x, low.y), part.x);
        const double south = glm::mix(heights(low.x, high.y), heights(high.x, high.y), part.x);
        const double height = glm::mix(north, south, part.y);
        return std::isnan(height) ? HeightSample{Kind::in_void, 0.0}
                                  : HeightSample{Kind::height, height};
    }

    const TileLayer& layer_;
    const Block& block_;
    std::span<const glm::dvec2> points_;
    Reach reach_;
    const Poles& poles_;
    std::vector<const LayerTile*> near_;
};

/// Places without an answer so far. At the edges of cells, voids count as answers.
std::vector<int> unanswered(std::span<const HeightSample> answers, Reach reach) {
    std::vector<int> requested;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const Kind kind = answers[i].kind;
        if (kind == Kind::outside || (kind == Kind::in_void && reach == Reach::samples)) {
            requested.push_back(static_cast<int>(i));
        }
    }
    return requested;
}

void ask_layer(const TileLayer& layer, std::span<const glm::dvec2> places, Reach reach,
               const LayerReading& reading, unsigned threads, TileSet::Heights& result) {
    const std::vector<int> requested = unanswered(result.answers, reach);
    if (requested.empty()) {
        return;
    }
    const ReadScope scope(reading.options.stop);
    const auto points = lattice_points(layer, places, requested, threads);
    const Poles poles = poles_of(layer, points, reading, result.errors);
    const std::vector<Block> blocks = blocks_of(layer, poles.wrap, points);
    std::mutex mutex;
    const auto answer_block = [&](int number) {
        const ReadScope scope(reading.options.stop);
        std::vector<FileError> errors;
        BlockHeights heights(layer, blocks[static_cast<std::size_t>(number)], points, reach, poles);
        heights.find(reading, errors, [&](int index, HeightSample answer) {
            const auto place = static_cast<std::size_t>(requested[static_cast<std::size_t>(index)]);
            result.answers[place] = answer;
        });
        const std::lock_guard lock(mutex);
        result.errors.insert(result.errors.end(), errors.begin(), errors.end());
    };
    parallel_for(static_cast<int>(blocks.size()), answer_block,
                 {.threads = threads, .stop = reading.options.stop, .progress = {}});
}

} // namespace

TileSet::Heights TileSet::heights(std::span<const glm::dvec2> places,
                                  const std::stop_token& stop) const {
    Heights result;
    result.answers.resize(places.size());
    std::atomic<std::size_t> bytes_read{0};
    for (const Reach reach : {Reach::samples, Reach::half_a_cell}) {
        for (const TileLayer& layer : state_->layers) {
            ask_layer(layer, places, reach, state_->reading(bytes_read, stop),
                      state_->options.threads, result);
        }
    }
    keep_each_once(result.errors);
    result.bytes_read = bytes_read;
    return result;
}

} // namespace reljef::io

#include "engine/io/index/index_format.h"

#include <algorithm>
#include <bit>

#include "engine/io/cache/fnv_hash.h"

namespace reljef::io {
namespace {

std::uint64_t sealed(std::uint64_t hash, std::uint64_t word) {
    return (hash ^ word) * fnv_prime;
}

} // namespace

std::uint64_t seal_of(std::span<const float> floats, std::uint64_t place, std::uint64_t source) {
    std::uint64_t hash = sealed(fnv_start ^ source, place);
    for (const float value : floats) {
        hash = sealed(hash, std::bit_cast<std::uint32_t>(value));
    }
    return hash;
}

std::size_t index_in(glm::ivec2 count, int col, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(count.x) +
           static_cast<std::size_t>(col);
}

std::size_t count_of(glm::ivec2 count) {
    return static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y);
}

void copy_into(const Grid<float>& grid, std::span<float> floats, int stride) {
    for (int row = 0; row < grid.rows(); ++row) {
        std::copy(grid.row(row).begin(), grid.row(row).end(),
                  floats.begin() + std::ptrdiff_t{row} * stride);
    }
}

Grid<float> grid_from(std::span<const float> floats, glm::ivec2 size, int stride) {
    Grid<float> grid(size.x, size.y);
    for (int row = 0; row < size.y; ++row) {
        const auto from =
            floats.subspan(static_cast<std::size_t>(row) * static_cast<std::size_t>(stride));
        std::copy_n(from.begin(), size.x, grid.row(row).begin());
    }
    return grid;
}

} // namespace reljef::io

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <cpl_vsi.h>
#include <fmt/format.h>

#include "engine/io/cache/fnv_hash.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/remote/read_scope.h"
#include "engine/io/remote/remote_files.h"
#include "engine/io/tile_set_state.h"

namespace reljef::io {
namespace {

// Of a set with more files, the sizes and times of all are compared, and the content of these.
constexpr std::size_t max_opened_files = 16;
constexpr int blocks_of_file = 3;

/// Hash of a few blocks, spread over a file.
std::uint64_t hash_of_blocks(const std::string& name, vsi_l_offset bytes, std::uint64_t hash) {
    const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file(VSIFOpenL(name.c_str(), "rb"),
                                                             &VSIFCloseL);
    std::array<char, 4096> block{};
    for (int i = 0; file != nullptr && i < blocks_of_file; ++i) {
        const vsi_l_offset room = bytes - std::min<vsi_l_offset>(bytes, block.size());
        static_cast<void>(VSIFSeekL(
            file.get(), room / (blocks_of_file - 1) * static_cast<vsi_l_offset>(i), SEEK_SET));
        const std::size_t count = VSIFReadL(block.data(), 1, block.size(), file.get());
        hash = fnv_hash({block.data(), count}, hash);
    }
    return hash;
}

/// Of all files that GDAL reads for a raster: sizes, times and blocks.
std::uint64_t hash_of_raster(const std::filesystem::path& path, std::uint64_t hash) {
    const GdalMessages messages;
    const auto dataset = open_raster(path, messages);
    if (!dataset) {
        return hash;
    }
    const CPLStringList names((*dataset)->GetFileList());
    for (int i = 0; i < names.size(); ++i) {
        const std::string name = names[i];
        VSIStatBufL status{};
        if (VSIStatL(name.c_str(), &status) == 0 && VSI_ISREG(status.st_mode)) {
            hash = fnv_hash(
                fmt::format("{} {} {}\n", full_name(name), status.st_size, status.st_mtime), hash);
            hash = hash_of_blocks(name, static_cast<vsi_l_offset>(status.st_size), hash);
        }
    }
    return hash;
}

} // namespace

Result<std::uint64_t> TileSet::fingerprint() const {
    const ReadScope scope(state_->options.stop);
    for (const TileFile& file : state_->files) {
        if (is_remote(file.path)) {
            forget_remote_file(file.path.string());
        }
    }
    std::vector<std::string> ignored_notes;
    const auto now = index_files(state_->name, files_of(state_->options), ignored_notes);
    if (!now) {
        return now.error();
    }
    std::uint64_t hash = fnv_start;
    for (const IndexedFile& file : now->files) {
        hash = fnv_hash(fmt::format("{} {} {} {}\n", full_name(file.path), file.bytes,
                                    file.modified, file.sidecar_hash),
                        hash);
    }
    for (const TileFile& file : files().first(std::min(files().size(), max_opened_files))) {
        hash = hash_of_raster(file.path, hash);
    }
    return hash;
}

std::optional<glm::ivec2> TileSet::first_pixel(const TileGrid& grid) const {
    if (state_->layers.size() != 1 || state_->layers.front().tiles.size() != 1 ||
        is_remote(state_->files.front().path)) {
        return std::nullopt;
    }
    const LayerTile& tile = state_->layers.front().tiles.front();
    const geo::PixelAffine& affine =
        state_->indexed[static_cast<std::size_t>(tile.file)].crs_from_pixel;
    const glm::dvec2 step(affine.x_col, affine.y_row);
    const glm::dvec2 first =
        (grid.first - glm::dvec2(affine.x0, affine.y0)) / step - glm::dvec2(0.5);
    const glm::dvec2 last = first + glm::dvec2(grid.cols - 1, grid.rows - 1) * grid.step / step;
    const auto is_near = [](glm::dvec2 a, glm::dvec2 b) {
        return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)) < near_sample;
    };
    const glm::dvec2 nearest = glm::round(first);
    const glm::dvec2 expected_last = nearest + glm::dvec2(grid.cols - 1, grid.rows - 1);
    const bool is_inside = nearest.x >= 0.0 && nearest.y >= 0.0 && expected_last.x < tile.cols &&
                           expected_last.y < tile.rows;
    return affine.x_row == 0.0 && affine.y_col == 0.0 && is_inside && is_near(first, nearest) &&
                   is_near(last, expected_last)
               ? std::optional(glm::ivec2(nearest))
               : std::nullopt;
}

} // namespace reljef::io

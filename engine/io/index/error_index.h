#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/core/atomic_file.h"
#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/io/tile_set.h"
#include "engine/terrain/tree/tile_error.h"

namespace reljef::io {

/// A terrain to index: the samples of a grid over files.
struct IndexSource {
    TileSet tiles;
    TileGrid grid;
    Gaps gaps = Gaps::holes;
    terrain::TileTree tree;        ///< over the grid and the samples that close it
    std::uint64_t fingerprint = 0; ///< TileSet::fingerprint
    std::filesystem::path file;    ///< of the index
    float north_height = 0.0F;     ///< added poles, metres; NaN: void
    float south_height = 0.0F;
};

/// The file of a terrain's index. Its name depends on the terrain's path and on all that changes
/// its heights.
std::filesystem::path index_file(const TileSet& tiles, const TileGrid& grid, Gaps gaps,
                                 const std::filesystem::path& cache_folder);

/// The source and the file of its index. Fails as TileSet::fingerprint, for a grid that is larger
/// than a tree, and if the rows beside added poles cannot be read.
Result<IndexSource> index_source(TileSet tiles, const TileGrid& grid, Gaps gaps,
                                 const std::filesystem::path& cache_folder);

/// How a process writes an index beside others.
enum class IndexAccess {
    alone,  ///< fails if others write it
    queued, ///< alone, after the others
    shared, ///< with others that write other parts
};

/// The proofs of a terrain's tiles, and the heights of those from level 3, in a file. Reads each on
/// demand. All parts have checksums: parts that are damaged or missing are absent. Reading is
/// thread-safe; so is writing different parts.
class ErrorIndex {
public:
    /// Lowest level with stored heights. Those of finer tiles come from samples.
    static constexpr int first_stored_level = terrain::levels_per_chunk;

    /// Absent if there is none. Fails if it is unusable, or of another state of the source.
    static Result<std::optional<ErrorIndex>> open(const IndexSource& source);
    /// Opens or makes an index to write; empties a damaged one, and one of another state of the
    /// source. Fails while other processes write it, or after a stop while it waits for them.
    /// `on_wait`: called once after a second of waiting.
    static Result<ErrorIndex> open_to_write(const IndexSource& source,
                                            IndexAccess access = IndexAccess::alone,
                                            const std::stop_token& stop = {},
                                            const std::function<void()>& on_wait = {});
    /// Gives a shared index to this process alone. False, and then this process writes no more, if
    /// others write it still: the last of them gets it.
    [[nodiscard]] bool claim();

    /// Absent: unproven.
    [[nodiscard]] std::optional<terrain::TileProof> find(terrain::TreeTile tile) const;
    struct StoredTile {
        Grid<float> heights;         ///< at the tile's vertices and one step around them; NaN: void
        terrain::PartShares parts{}; ///< of its proof
    };
    /// Absent below first_stored_level.
    [[nodiscard]] std::optional<StoredTile> stored(terrain::TreeTile tile) const;
    /// Whether nothing is left to write, apart from damage.
    [[nodiscard]] bool is_complete() const { return is_complete_; }
    /// Whether it was complete, and proofs are damaged or missing now.
    [[nodiscard]] bool is_damaged() const { return is_damaged_; }

    struct Level {
        std::size_t tiles = 0;
        std::size_t unproven = 0;
        float max_error = 0.0F; ///< metres
    };
    [[nodiscard]] std::vector<Level> levels() const;
    [[nodiscard]] std::uint64_t bytes_of_proofs() const;
    [[nodiscard]] std::uint64_t bytes_of_heights() const;

    /// Writes the levels of a chunk. Interim residuals remain until complete().
    Result<void> write(terrain::Chunk chunk, const terrain::ChunkProof& proof);
    /// Of the highest level of a chunk's levels.
    [[nodiscard]] std::optional<terrain::Residuals> residuals(terrain::Chunk chunk) const;
    /// Whether a chunk's levels are there.
    [[nodiscard]] bool has(terrain::Chunk chunk) const;
    /// Drops the interim parts.
    Result<void> complete();
    /// Drops all parts.
    Result<void> clear();
    /// Removes the file.
    void remove();

private:
    struct Place {                // bytes from the start of the file
        std::uint64_t proofs = 0; // of the chunks with this base
        std::uint64_t tiles = 0;
        std::uint64_t residuals = 0; // of chunks whose highest level it is
    };
    ErrorIndex(const IndexSource& source, Descriptor file);
    [[nodiscard]] bool has_level(int level) const;
    [[nodiscard]] std::uint64_t proofs_at(terrain::Chunk chunk) const;
    [[nodiscard]] std::uint64_t tile_at(terrain::TreeTile tile) const;
    [[nodiscard]] std::uint64_t residuals_at(terrain::Chunk chunk) const;
    [[nodiscard]] bool read_at(std::uint64_t place, std::span<std::byte> bytes) const;
    Result<void> write_at(std::uint64_t place, std::span<const std::byte> bytes);
    [[nodiscard]] std::optional<std::vector<float>> read_block(std::uint64_t place,
                                                               std::size_t floats) const;
    /// A block of proofs; absent if it is damaged or missing.
    [[nodiscard]] std::optional<std::vector<float>> read_proofs(terrain::Chunk chunk) const;
    /// Counts the tiles of a chunk.
    void add_to(std::vector<Level>& levels, terrain::Chunk chunk) const;
    Result<void> write_block(std::uint64_t place, std::vector<float> floats);
    /// Whether the header is of this source; sets is_complete_.
    [[nodiscard]] bool has_begun();
    /// Of a complete index: whether it has its size, and all proofs are good.
    [[nodiscard]] bool has_all_parts() const;
    /// Whether all stored heights are good. Reads them.
    [[nodiscard]] bool has_all_heights() const;
    /// Empties a damaged file, and one of another state of the source.
    Result<void> begin();
    /// False if another process has the lock.
    Result<bool> lock(IndexAccess access);
    Result<void> write_tiles(int level, glm::ivec2 first, const terrain::ChunkLevel& made);
    [[nodiscard]] std::string header(bool is_complete) const;
    [[nodiscard]] Error error(const char* what) const;

    std::filesystem::path path_;
    terrain::TileTree tree_;
    std::uint64_t fingerprint_;
    Descriptor file_;
    std::vector<Place> places_; // by level
    std::uint64_t interim_ = 0; // where residuals begin
    bool is_complete_ = false;
    bool is_damaged_ = false;
};

} // namespace reljef::io

#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "engine/core/back_off.h"
#include "engine/core/result.h"
#include "engine/scene/streaming/tile_builder.h"
#include "engine/terrain/tree/tile_error.h"

namespace reljef::scene {

/// The content of a tile as read from its source. With `errors` the heights are unusable. With
/// `picture_errors` only, the tile is drawn, and its picture is read again (and its heights, if
/// they are the overview's).
struct TileContent {
    Grid<float> heights;              ///< at its vertices and one step around them; NaN: void
    Grid<std::uint8_t> was_void = {}; ///< 1: filled already; empty: nothing is
    TilePicture picture;
    std::vector<FileError> errors;         ///< one per file
    std::vector<FileError> picture_errors; ///< also of heights that the overview replaces
    bool of_overview = false;              ///< the heights are TileBuilder::overview_heights
    bool is_finest = false;                ///< finer tiles would show nothing more
    bool is_proven = false;                ///< TileStreamOptions::find_proof holds for the heights
    std::optional<terrain::PartShares> parts; ///< of that proof's error, if they are known
    bool ends_proofs = false;                 ///< the proofs are wrong: of no tile is one true
    std::size_t bytes_read = 0;               ///< from files
    std::vector<std::string> notes;           ///< new ones: each once in the stream's life
};

/// What is proven of a tile; absent: nothing. Called from several threads.
using TileProofFinder = std::function<std::optional<terrain::TileProof>(terrain::TreeTile)>;

/// Reads a tile; called from several threads. May return early after a stop request.
using TileContentReader = std::function<TileContent(terrain::TreeTile, std::stop_token)>;

struct TileStreamOptions {
    /// Bytes for loaded and drawn tiles; summaries of evicted tiles take a 64th of it more.
    std::size_t memory_budget = std::size_t{256} << 20;
    unsigned threads = 0; ///< 0: as many as the machine has
    /// As the stream's reader, without pictures; empty: that reader.
    TileContentReader read_heights = {};
    TileProofFinder find_proof = {}; ///< empty: no tile is proven
    bool is_all_proven = false;      ///< whether it has all proofs that there can be
    /// Grows when a reading finds that the source changed: tiles of earlier readings are outdated.
    /// Empty: it does not change.
    std::function<std::uint64_t()> source_changes = {};
    /// What was said of files that could not be read before the stream began: each begins with the
    /// name of its file. They are not reported again.
    std::vector<std::string> reported = {};
    /// Pause after the first failure of a file; each further pause is four times as long.
    std::chrono::milliseconds first_pause = BackOff::usual_first_pause;
};

struct TileStreamStats {
    std::size_t tiles = 0;     ///< in memory
    std::size_t bytes = 0;     ///< of these, drawn
    std::size_t max_bytes = 0; ///< so far
    int read = 0;
    int failed = 0;    ///< reads with errors
    int cancelled = 0; ///< requests withdrawn before their tiles arrived
    int evicted = 0;
    std::size_t bytes_read = 0; ///< from files
    bool is_all_proven = false;
};

/// The loaded tiles of a terrain, and the threads that read requested ones. Tiles are shared and
/// immutable. When memory runs out, the least recently used ones are evicted.
class TileStream {
public:
    TileStream(TileBuilder maker, TileContentReader read, const TileStreamOptions& options = {});
    ~TileStream();
    TileStream(const TileStream&) = delete;
    TileStream& operator=(const TileStream&) = delete;

    [[nodiscard]] const TileBuilder& maker() const { return maker_; }
    [[nodiscard]] const terrain::TileTree& tree() const { return maker_.tree(); }
    [[nodiscard]] const TileStreamOptions& options() const { return options_; }
    /// The readers of tiles, which keep none of them.
    [[nodiscard]] const TileContentReader& reader() const { return read_; }
    [[nodiscard]] const TileContentReader& height_reader() const {
        return options_.read_heights ? options_.read_heights : read_;
    }

    /// A loaded tile; null if it is not in memory.
    [[nodiscard]] std::shared_ptr<const TerrainTile> find(terrain::TreeTile tile) const;
    /// All loaded tiles, in the order of their ids.
    [[nodiscard]] std::vector<std::shared_ptr<const TerrainTile>> loaded() const;
    /// Summary of a loaded, proven or evicted tile. If the proofs turn out to be wrong, proven
    /// tiles are forgotten and read again. Avoids re-reading tiles that were rejected. Empty for
    /// unproven tiles that were evicted long ago.
    [[nodiscard]] std::optional<TileSummary> recall(terrain::TreeTile tile) const;
    struct Found {
        std::shared_ptr<const TerrainTile> tile;
        glm::dvec2 place{0.0}; ///< in vertices
    };
    /// The finest loaded tile at a sample of the overview.
    [[nodiscard]] std::optional<Found> finest_at(glm::dvec2 overview_sample) const;
    /// Tiles of one view that fit in memory.
    [[nodiscard]] std::size_t max_drawn() const;
    /// The memory budget with which this number of tiles can be drawn, bytes.
    [[nodiscard]] std::size_t budget_for(std::size_t drawn_tiles) const;
    static constexpr std::size_t min_drawn = 64; ///< enough for any view, coarsely
    /// ImageryDetail::max_texels so that min_drawn tiles fit; at least 1.
    static int texels_within(std::size_t memory_budget);

    /// Begins a view. Reads the missing tiles, the most urgent first, and cancels earlier requests
    /// that are not repeated. Keeps the used tiles, and reads them again if their picture is
    /// incomplete or they are outdated. If memory runs out, evicts tiles that this view does not
    /// use. `with_cones`: the view needs TerrainTile::cones; loaded tiles without them are missing.
    void request(std::span<const terrain::TreeTile> missing,
                 std::span<const terrain::TreeTile> used = {}, bool with_cones = false);
    /// Whether a file was reported before the stream began, or has failed max_attempts times since
    /// it was last read.
    [[nodiscard]] bool has_given_up(const std::filesystem::path& file) const;
    /// Waits until all requested tiles are loaded or have failed max_attempts times; false after a
    /// stop request. Precondition: no other thread requests tiles.
    bool wait(const std::stop_token& stop);
    /// The same with a time limit; false if it was reached.
    bool wait_for(const std::stop_token& stop, std::chrono::milliseconds longest);
    static constexpr int max_attempts = BackOff::max_attempts; ///< then pauses of half a minute

    /// Whether a tile is missing because it failed max_attempts times.
    [[nodiscard]] bool has_given_up(terrain::TreeTile tile) const;

    /// Changes whenever tiles arrive, are evicted or given up.
    [[nodiscard]] std::uint64_t revision() const;
    /// Whether tiles arrived since the last call.
    bool take_arrivals();
    /// Whether tiles of this view are outdated and did not fail: request() reads them again.
    [[nodiscard]] bool has_outdated() const;
    /// Whether requested tiles are still missing.
    [[nodiscard]] bool is_busy() const;
    /// Errors since the last call, one per file in the stream's life.
    std::vector<std::string> take_errors();
    std::vector<std::string> take_notes();
    [[nodiscard]] std::size_t failed_files() const;
    [[nodiscard]] TileStreamStats stats() const;

private:
    using Clock = BackOff::Clock;
    struct Made {
        std::shared_ptr<const TerrainTile> tile; // null: there were errors
        std::size_t shown = 0;                   // opaque texels of its picture
        std::uint64_t changes = 0;               // of the source when its reading began
    };
    struct Entry {
        Made made;
        std::uint64_t used = 0; // the last view that used it
    };
    struct TileFailure {
        BackOff latest; // the longest pause of its files
        std::vector<std::filesystem::path> files;
    };
    void work(const std::stop_token& stop);
    void load(terrain::TreeTile tile, std::unique_lock<std::mutex>& lock);
    static Made with_cones_over(Made made);
    void note_cones(const Made& made); // once
    std::optional<terrain::TreeTile> next_tile(Clock::time_point now);
    [[nodiscard]] std::optional<Clock::time_point> next_attempt() const;
    [[nodiscard]] Made make(terrain::TreeTile tile, TileContent& content, const Made& before) const;
    [[nodiscard]] bool lacks_cones(terrain::TreeTile tile) const;
    static Made better_of(const Made& before, Made now, bool has_whole_picture);
    void finish(terrain::TreeTile tile, const TileContent& content, Made made, bool stopped);
    void note_failure(terrain::TreeTile tile, std::span<const FileError> errors);
    void forget_failure(terrain::TreeTile tile);
    void record_errors(std::span<const FileError> errors);
    [[nodiscard]] bool was_reported(const std::filesystem::path& file) const;
    void keep(terrain::TreeTile tile, Made made);
    void drop_proofs();
    [[nodiscard]] std::uint64_t changes_of_source() const;
    void note_changes();
    [[nodiscard]] bool is_outdated(terrain::TreeTile tile) const;
    [[nodiscard]] bool is_in_use(const Entry& entry) const { return entry.used + 1 >= view_; }
    [[nodiscard]] std::vector<terrain::TreeTile>
    requests_for(std::span<const terrain::TreeTile> tiles) const;
    void evict();
    void remember(const TileSummary& tile) const;
    [[nodiscard]] bool is_settled() const;
    [[nodiscard]] bool has_failed_for_good(terrain::TreeTile tile) const;

    const TileBuilder maker_;
    const TileContentReader read_;
    const TileStreamOptions options_;

    mutable std::mutex mutex_;
    std::condition_variable_any changed_;
    std::map<terrain::TreeTile, Entry> tiles_;
    mutable std::map<terrain::TreeTile, TileSummary> remembered_; // evicted or proven
    mutable std::deque<terrain::TreeTile> remembered_order_;      // the oldest first
    std::vector<terrain::TreeTile> requested_;                    // the most urgent first
    std::map<terrain::TreeTile, std::stop_source> in_flight_;
    std::map<terrain::TreeTile, TileFailure> failures_;
    std::map<std::filesystem::path, BackOff> file_failures_; // shared by all tiles of a file
    std::set<std::filesystem::path> failed_files_;
    std::vector<std::string> new_errors_;
    std::vector<std::string> new_notes_;
    bool has_proofs_ = false;
    std::uint64_t changes_ = 0; // of the source that readings found
    std::uint64_t view_ = 0;
    bool with_cones_ = false; // in this view
    bool has_noted_cones_ = false;
    std::uint64_t revision_ = 0;
    bool has_arrivals_ = false;
    TileStreamStats stats_;
    std::vector<std::jthread> threads_; // last: they stop before other members are destroyed
};

} // namespace reljef::scene

#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "engine/core/back_off.h"
#include "engine/scene/streamed_tile.h"

namespace reljef::scene {

/// A tile as read from its source: heights at its vertices and one step around them (NaN: none),
/// its picture, and faults, one sentence per file. If `faults` is not empty, the heights are
/// unusable. If only `picture_faults` is not empty, the tile is drawn, and its picture is read
/// again; so are its heights if they are the overview's.
struct TileContent {
    Grid<float> heights;
    TilePicture picture;
    struct FileError {
        std::string file;
        std::string message;
    };
    std::vector<FileError> errors;
    std::vector<FileError> picture_errors; ///< and of heights that the overview stands in for
    bool of_overview = false;              ///< the heights are TileBuilder::overview_heights
    std::size_t bytes_read = 0;            ///< that it took from its files
    std::vector<std::string> notes;        ///< that came up, each once in the stream's life
};

/// Reads a tile; called from several threads at a time. May give up where a stop is asked for.
using TileContentReader = std::function<TileContent(terrain::TreeTile, std::stop_token)>;

struct TileStreamOptions {
    /// Bytes, for tiles here and when drawn; a 64th of it more for what is remembered of others.
    std::size_t memory_budget = std::size_t{256} << 20;
    unsigned threads = 0; ///< 0: as many as the machine has
    /// After the first failure of a file its tiles are read again so much later, then four times
    /// that, …
    std::chrono::milliseconds first_pause = BackOff::usual_first_pause;
};

struct TileStreamStats {
    std::size_t tiles = 0; ///< in memory
    std::size_t bytes = 0; ///< of these, drawn
    std::size_t max_bytes = 0;
    int read = 0;
    int failed = 0;    ///< readings with faults
    int cancelled = 0; ///< no longer wanted before they were there
    int evicted = 0;
    std::size_t bytes_read = 0; ///< by all readings
};

/// The tiles of a terrain that are in memory, and the threads that read the requested ones. The
/// only part of a scene that changes by itself. Tiles are shared, so none changes while it is used.
/// When memory runs out, the least recently used ones are evicted.
class TileStream {
public:
    TileStream(TileBuilder maker, TileContentReader read, const TileStreamOptions& options = {});
    ~TileStream();
    TileStream(const TileStream&) = delete;
    TileStream& operator=(const TileStream&) = delete;

    [[nodiscard]] const TileBuilder& maker() const { return maker_; }
    [[nodiscard]] const terrain::TileTree& tree() const { return maker_.tree(); }

    /// A tile that is in memory, else null.
    [[nodiscard]] std::shared_ptr<const StreamedTile> find(terrain::TreeTile tile) const;
    /// Summary of a resident or evicted tile. Avoids re-reading tiles that were rejected. Empty for
    /// tiles that were evicted long ago.
    [[nodiscard]] std::optional<TileSummary> recall(terrain::TreeTile tile) const;
    /// The finest tile that is there over a sample of the overview, and the place on its vertices.
    struct Found {
        std::shared_ptr<const StreamedTile> tile;
        glm::dvec2 place{0.0};
    };
    [[nodiscard]] std::optional<Found> finest_at(glm::dvec2 overview_sample) const;
    /// As many as may be drawn at a time.
    [[nodiscard]] std::size_t max_drawn() const;
    static constexpr std::size_t min_drawn = 16; ///< enough for any view, coarsely
    /// ImageryDetail::max_texels so that these fit, or 1.
    static int texels_within(std::size_t memory_budget);

    /// Begins a view. Reads the missing tiles, the most urgent first, and cancels earlier requests
    /// that are not repeated. The used tiles stay in memory; those that lack a part of their
    /// picture are read again. Tiles that neither this view nor the one before used go where memory
    /// runs out.
    void request(std::span<const terrain::TreeTile> missing,
                 std::span<const terrain::TreeTile> used = {});
    /// Until all that is wanted is there or has failed for good (`max_attempts`); false where it
    /// was stopped. Only while nobody else wants.
    bool wait(const std::stop_token& stop);
    /// The same, but no longer than that: false.
    bool wait_for(const std::stop_token& stop, std::chrono::milliseconds longest);
    /// The tiles that need a file which fails so often are left alone for half a minute, then read
    /// once more, and so on; nobody waits for them any more.
    static constexpr int max_attempts = BackOff::max_attempts;

    /// Whether a tile is not there as it failed so often, for half a minute at least.
    [[nodiscard]] bool has_given_up(terrain::TreeTile tile) const;

    /// Another number whenever tiles came, went or were given up.
    [[nodiscard]] std::uint64_t revision() const;
    /// Whether tiles came since the last call.
    bool take_news();
    /// Whether something is being read or about to be.
    [[nodiscard]] bool is_busy() const;
    /// Faults since the last call, of each file once in the stream's life.
    std::vector<std::string> take_errors();
    /// Notes of its readings since the last call.
    std::vector<std::string> take_notes();
    /// Files that had faults, all in all.
    [[nodiscard]] std::size_t failed_files() const;
    [[nodiscard]] TileStreamStats stats() const;

private:
    using Clock = BackOff::Clock;
    struct Made {
        std::shared_ptr<const StreamedTile> tile; // null: there were faults
        std::size_t shown = 0;                    // texels of its picture that images show
    };
    struct Entry {
        Made made;
        std::uint64_t used = 0; // view that used it last
    };
    struct TileFailure {
        BackOff latest; // of the files' the one that lasts longest
        std::vector<std::string> files;
    };
    void work(const std::stop_token& stop);
    std::optional<terrain::TreeTile> next_tile(Clock::time_point now);
    [[nodiscard]] std::optional<Clock::time_point> next_attempt() const;
    [[nodiscard]] Made make(terrain::TreeTile tile, TileContent& reading, const Made& before) const;
    static Made better_of(const Made& before, Made now, bool has_whole_picture);
    void finish(terrain::TreeTile tile, const TileContent& reading, Made made, bool stopped);
    void note_failure(terrain::TreeTile tile, std::span<const TileContent::FileError> errors);
    void forget_failure(terrain::TreeTile tile);
    const BackOff& file_failure(const std::string& file, Clock::time_point now);
    void record_errors(std::span<const TileContent::FileError> errors);
    void keep(terrain::TreeTile tile, Made made);
    [[nodiscard]] std::vector<terrain::TreeTile>
    asked_for(std::span<const terrain::TreeTile> tiles) const;
    [[nodiscard]] bool is_wanting(terrain::TreeTile tile) const;
    void evict();
    void remember(const TileSummary& tile);
    [[nodiscard]] bool is_settled() const;

    const TileBuilder maker_;
    const TileContentReader read_;
    const TileStreamOptions options_;

    mutable std::mutex mutex_;
    std::condition_variable_any changed_;
    std::map<terrain::TreeTile, Entry> tiles_;
    std::map<terrain::TreeTile, TileSummary> remembered_; // of those that went
    std::deque<terrain::TreeTile> remembered_order_;      // these, the first first
    std::vector<terrain::TreeTile> wanted_;               // most urgent first
    std::map<terrain::TreeTile, std::stop_source> in_flight_;
    std::map<terrain::TreeTile, TileFailure> failures_;
    std::map<std::string, BackOff> file_failures_; // they fail for all their tiles alike
    std::map<std::string, std::string> errors_;    // by file
    std::vector<std::string> new_errors_;
    std::vector<std::string> new_notes_;
    std::uint64_t view_ = 0;
    std::uint64_t revision_ = 0;
    bool news_ = false;
    TileStreamStats stats_;
    std::vector<std::jthread> threads_; // last: they stop before the rest goes
};

/// As TerrainSurface::height_at, of the finest tile that is there.
std::optional<double> height_at(const TerrainNode& terrain, double x, double y);

} // namespace reljef::scene

#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "app/viewer/appearance/background.h"
#include "engine/core/color.h"
#include "engine/core/hit.h"
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/scene/graph/scene.h"
#include "engine/session/comparing/error_figures.h"
#include "engine/session/comparing/scene_truth.h"
#include "engine/session/log.h"

namespace reljef::app {

/// A picture that is compared with the truth.
struct ComparedFrame {
    Image picture;
    HitBuffer hits;
};

/// A view at rest, as drawn by one technique or two.
struct ComparedView {
    scene::Camera camera;
    std::vector<ComparedFrame> frames; ///< left, right; at least one; of equal size
};

/// The truth of scenes, which one thread at a time finds.
struct LockedTruth {
    explicit LockedTruth(session::SceneTruth made) : truth(std::move(made)) {}

    std::mutex mutex;
    session::SceneTruth truth;
};

struct TruePicture {
    std::shared_ptr<LockedTruth> scene;
    scene::Camera camera;
    int rays_per_side = 0;
    double milliseconds = 0.0; ///< of its rays
    std::shared_ptr<const truth::Picture> picture;
};

struct FoundErrors {
    TruePicture truth;
    std::vector<session::ErrorFigures> figures; ///< of the frames
    Image map;                                  ///< of the left frame
};

/// Finds the exact picture of a view, and the errors of its frames, in the background: with a ray
/// for each pixel first, then with four.
class TruthSearch {
public:
    /// `threads` 0: as many as the machine has.
    explicit TruthSearch(int threads) : threads_(threads) {}
    ~TruthSearch() { stop(); }
    TruthSearch(const TruthSearch&) = delete;
    TruthSearch& operator=(const TruthSearch&) = delete;

    /// Replaces what is being found. Fails where the scene has no truth.
    Result<void> begin(const scene::Scene& scene, ComparedView view);
    /// Forgets the errors and stops, without waiting. Keeps the truth: the next view may be the
    /// same with another technique.
    void stop();
    /// Releases the truth, too.
    void forget();
    /// Takes what is found. Returns whether something is new.
    bool update();

    [[nodiscard]] bool is_busy() const { return work_ != nullptr; }
    [[nodiscard]] double progress() const;
    /// Absent: not yet, or it failed, which is a note.
    [[nodiscard]] const std::optional<FoundErrors>& found() const { return found_; }
    void relay_to(session::Log& log) { log_.relay_to(log); }

private:
    struct Search {
        std::shared_ptr<const ComparedView> view;
        std::shared_ptr<LockedTruth> scene;
        int rays_per_side = 0;
        std::optional<TruePicture> known; // of this view
    };
    struct Work {
        Search search;
        session::RelayedLog log;
        std::optional<Background<FoundErrors>> found; // uses the others
    };
    static Result<TruePicture> draw_truth(const Search& search, const ParallelOptions& parallel);
    static Result<FoundErrors> find(const Search& search, const ParallelOptions& parallel);
    void begin(Search search);
    [[nodiscard]] bool is_known(const Search& search) const;

    int threads_;
    session::RelayedLog log_;
    std::shared_ptr<LockedTruth> scene_;
    std::optional<TruePicture> last_; // the last truth
    std::optional<FoundErrors> found_;
    std::unique_ptr<Work> work_;
    std::vector<std::unique_ptr<Work>> retired_; // stopping
};

} // namespace reljef::app

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/hit.h"
#include "engine/core/parallel_for.h"
#include "engine/scene/graph/scene.h"
#include "engine/scene/motion/camera_path.h"
#include "engine/scene/streaming/tile_stream.h"
#include "engine/session/ground.h"
#include "engine/session/log.h"
#include "engine/session/scene_renderer.h"
#include "engine/session/scene_setup.h"
#include "engine/session/streaming.h"
#include "engine/truth/draw.h"
#include "engine/truth/streamed_truth.h"

namespace reljef::session {

/// Draws the frames of one scene. Only the camera moves from frame to frame.
class FrameMaker {
public:
    virtual ~FrameMaker() = default;
    /// Waits for the tiles of the next frame; drawing waits, too.
    virtual void wait_for_tiles(const scene::Scene& scene, const std::stop_token& stop) = 0;
    virtual Result<Image> draw(const scene::Scene& scene, const ParallelOptions& parallel) = 0;
    virtual Result<HitBuffer> draw_hits(const scene::Scene& scene,
                                        const ParallelOptions& parallel) = 0;
    /// Before the parts of the picture (scene::Camera::whole) that the scene's camera shows at this
    /// size are drawn: all are drawn by the same means, and stats() counts them together.
    virtual void begin_parts(const scene::Scene& /*scene*/, glm::ivec2 /*picture*/) {}
    /// For later frames: no contour label lies in these areas of the picture.
    virtual void keep_clear(const std::vector<scene::PicturePart>& /*areas*/) {}
    /// Counts and times of the last frame, one per line.
    [[nodiscard]] virtual std::string stats() const = 0;
    /// Sentences about frames so far that did not keep their error bound, or may not have kept it.
    [[nodiscard]] virtual std::vector<std::string> error_notes() const { return {}; }
};

struct FrameTimes {
    std::vector<double> waiting_ms; ///< of each frame, for streamed tiles
    std::vector<double> drawing_ms; ///< of each frame, selection included
    std::size_t memory_before = 0;  ///< process maximum before the terrain was read, bytes
};

struct DeviceFramesOptions {
    bool timed = false;       ///< waits for the end of each frame
    int memory_megabytes = 0; ///< SourceOptions::memory_megabytes of the scene
    /// False: tiles are requested, and frames show what is there. error_notes() then do not
    /// judge their errors: what they lack is on its way.
    bool waits_for_tiles = true;
    /// Tints what draws each tile (view/choice/choice_picture.h).
    bool shows_choice = false;
};

class DeviceFrames : public FrameMaker {
public:
    /// `log` receives the errors of streamed tiles and outlives this object.
    DeviceFrames(Device device, Log& log, const DeviceFramesOptions& options = {});
    void wait_for_tiles(const scene::Scene& scene, const std::stop_token& stop) override;
    Result<Image> draw(const scene::Scene& scene, const ParallelOptions& parallel) override;
    Result<HitBuffer> draw_hits(const scene::Scene& scene,
                                const ParallelOptions& parallel) override;
    void begin_parts(const scene::Scene& scene, glm::ivec2 picture) override;
    void keep_clear(const std::vector<scene::PicturePart>& areas) override {
        device_.renderer().keep_clear(areas);
    }
    [[nodiscard]] std::string stats() const override;
    [[nodiscard]] std::vector<std::string> error_notes() const override;
    [[nodiscard]] const FrameTimes& times() const { return times_; }
    /// Of the last frame, or hits; of a picture in parts, those of all parts together.
    [[nodiscard]] const view::FrameStats& frame_stats() const { return stats_; }
    [[nodiscard]] const Device& device() const { return device_; }
    [[nodiscard]] int selections() { return device_.renderer().selector().count(); }

private:
    // Of all frames that are over their error bound.
    struct FramesOver {
        double kept_error = 0.0;      // the largest, pixels
        ExpectedError expected;       // of that frame
        MemoryForBound memory;        // the largest
        std::size_t triangles = 0;    // that keep it, if all terrains are in memory
        bool counts_triangles = true; // false: of a frame they are not known, or not enough
        bool misses_tiles = false;
        bool lacks_triangles = false;
        bool by_rounding = false; // that of the largest error
    };
    void take_stats(const view::FrameStats& stats, const scene::Scene& scene);
    void note_kept_error(const scene::Scene& scene);
    std::size_t triangles_needed();
    void note_fewer_vertices(const scene::Scene& scene);
    Result<Image> tinted(Image picture);
    /// How to keep the bound of the frames that are over it. Precondition: there are some.
    [[nodiscard]] std::string remedy() const;
    [[nodiscard]] std::string unproven_note() const;

    Device device_;
    Log& log_;
    DeviceFramesOptions options_;
    FrameTimes times_;
    std::optional<scene::Camera> ready_for_; // the next view, if its tiles are loaded
    double waited_ms_ = 0.0;                 // for the next view
    view::FrameStats stats_;
    int parts_ = 0; // since begin_parts()
    view::FrameStats all_parts_;
    std::optional<FramesOver> over_;
    double max_of_fewer_vertices_ = 0.0; // pixels by which frames without all samples are off
    int megabytes_for_vertices_ = 0;     // that hold all samples as vertices; 0: they were drawn
    int max_unproven_ = 0;               // tiles of a frame with an expected error
    std::optional<int> megabytes_for_all_samples_;
    bool names_bound_ = true;         // of the last frame with one
    std::optional<double> min_share_; // of probes within the bound, by searches without a proof
    int frames_as_triangles_ = 0;     // whose technique could not be drawn
    std::vector<scene::TileStreamStats> stream_stats_; // after the last frame
};

/// Draws with exact rays on the CPU.
class TruthFrames : public FrameMaker {
public:
    /// `log` receives the notes of streamed files and outlives this object.
    TruthFrames(glm::ivec2 size, int rays_per_side, Log& log)
        : size_(size), rays_per_side_(rays_per_side), log_(log) {}
    /// Only for the ground below the eye; rays wait for the others.
    void wait_for_tiles(const scene::Scene& scene, const std::stop_token& stop) override;
    Result<Image> draw(const scene::Scene& scene, const ParallelOptions& parallel) override;
    Result<HitBuffer> draw_hits(const scene::Scene& scene,
                                const ParallelOptions& parallel) override;
    [[nodiscard]] std::string stats() const override;

private:
    Result<void> prepare(const scene::Scene& scene);
    void log_notes();

    glm::ivec2 size_;
    int rays_per_side_;
    Log& log_;
    std::optional<truth::StreamedTruth> streamed_; // made for the first frame of a streamed terrain
    std::optional<truth::SceneCaster> caster_;     // made for the first frame
    std::optional<truth::Shading> shading_;        // made for the first picture
    double prepare_ms_ = 0.0;
    double draw_ms_ = 0.0;
};

/// Counts rows as the source does. A pole row of a closed globe is none of its rows: between the
/// first row and the north pole, rows are negative. Columns stay. `by_rays`: the hits of
/// TruthFrames.
HitBuffer in_source_rows(HitBuffer hits, const TerrainScene& scene, bool by_rays);

enum class Underground { lifted, allowed };

/// Moves the camera as fly_to, waits for its tiles and raises it as keep_above_ground (ground.h).
/// Lift::depth is 0 for a camera that was above the ground.
Lift fly_above_ground(TerrainScene& scene, const scene::CameraPath& path, int index, int frames,
                      FrameMaker& maker, const std::stop_token& stop,
                      Underground underground = Underground::lifted);

/// Lifts the camera as lift_camera (ground.h). Waits for the tiles of its view before, and after
/// each lift.
Lift stand_above_ground(TerrainScene& scene, FrameMaker& maker, const std::stop_token& stop,
                        Underground underground = Underground::lifted);

} // namespace reljef::session

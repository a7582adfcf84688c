#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "bench/report/results.h"
#include "bench/runner/suite_options.h"
#include "engine/core/result.h"
#include "engine/session/scene_renderer.h"
#include "engine/session/scene_setup.h"
#include "engine/truth/detail_plane.h"
#include "engine/truth/draw.h"
#include "engine/truth/geometric_error.h"
#include "engine/truth/image_error.h"

namespace reljef::bench {

/// The device of a suite; it selects tiles in every frame. With session::BackendKind::cpu it is
/// that of OpenGL, which measures beside rays. Fails as session::Device::create, and as
/// session::read_costs if a calibration is named.
Result<session::Device> make_device(const SuiteOptions& options);
/// The same for rays on the CPU.
Result<session::Device> make_rays_device(const SuiteOptions& options);

/// With the device's costs. `threads`: as of environment_of() for its information.
Environment environment_of(const session::Device& device, int threads);
inline RunSettings run_settings(const SuiteOptions& options) {
    return {options.quick, options.rounds, options.moving, options.cold};
}

enum class Daylight {
    scene,   ///< its own sun and air
    low_sun, ///< its sun, 10 degrees above the horizon
    night    ///< neither a sun nor air
};

/// A terrain, or copies of a detail texture on a level square, to measure on.
struct SceneChoice {
    /// A built-in name, a scene file or a DEM file; with `size`: "natural" or "urban".
    std::string terrain;
    int size = 0;          ///< samples a side of a generated terrain; 0: the default
    bool tileable = false; ///< of a generated urban
    /// Every technique draws terrain on a plane. The ellipsoid needs a georeference.
    terrain::PlacementKind placement = terrain::PlacementKind::plane;
    /// A name of terrains::detail_names(): the detail texture; empty: the terrain.
    std::string detail = {};
    /// Reads a georeferenced DEM file tile by tile within this memory; 0: keeps all of it.
    int memory_megabytes = 0;

    friend bool operator==(const SceneChoice&, const SceneChoice&) = default;
};

/// As session::open_terrain(), but the built-in `urban` has stepped walls: a harder surface than
/// straight ones, without the time that façades take.
Result<session::TerrainSource> open_measured(const session::SourceOptions& terrain,
                                             session::Log& log, const std::stop_token& stop);

/// Places the camera; keeps its near distance.
void set_pose(session::TerrainScene& scene, scene::Pose pose);

/// The errors of a picture and of its hits, as a row has them.
RowError row_error_of(const truth::GeometricErrors& geometric, const truth::ImageErrors& image);

struct MeasuredError {
    RowError error;
    std::optional<ShownView> view; ///< with SuiteOptions::keep_views
};

/// A terrain under a sun and a sky, or copies of a detail texture on a square under a sun, with the
/// true picture, which is computed on demand.
class BenchmarkScene {
public:
    /// Fails on the gallery: its models have no true picture, only its detail textures do.
    static Result<BenchmarkScene> open(const SceneChoice& choice, const SuiteOptions& options,
                                       const std::stop_token& stop);

    /// The scene's title; "urban 512 tile" for a generated terrain with a size.
    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const scene::Scene& scene() const { return scene_.scene; }
    /// World metres.
    [[nodiscard]] const Box& bounds() const { return scene_.bounds; }
    /// World metres; of a detail texture, of its plane.
    [[nodiscard]] double ground(double x, double y) const {
        return detail_ ? 0.0 : scene_.ground(x, y);
    }
    /// Precondition: a terrain.
    [[nodiscard]] const scene::Node& terrain() const { return *scene_.terrain; }

    void set_pose(scene::Pose pose) {
        bench::set_pose(scene_, pose);
        pose_ = pose;
    }
    /// Looks north and `down` degrees down at the ground in the middle of the terrain, from
    /// `distance` metres. Fails if the eye is below the ground. Precondition: a terrain.
    Result<void> look_from(double distance, double down);
    void set_daylight(Daylight daylight);
    /// Not for measure_error(), which needs a pose or look_from().
    void set_camera(const scene::Camera& camera);
    void set_technique(const scene::Technique& technique);

    /// Draws a frame from the last pose or look_from(), and compares it with the true picture; the
    /// scene keeps the technique. A picture without terrain (a flat surface seen from below) has
    /// holes and no reprojection error. Fails if neither picture shows terrain, or when stopped.
    Result<MeasuredError> measure_error(const scene::Technique& technique,
                                        session::SceneRenderer& renderer,
                                        const std::stop_token& stop);
    /// Of the terrain's pixels in the picture of the last technique, those that show a place which
    /// the terrain itself hides from the eye; see truth::hidden_places(). Precondition: a terrain,
    /// and measure_error() before.
    [[nodiscard]] Result<double> hidden_percent(session::SceneRenderer& renderer) const;

private:
    struct TruePicture {
        std::optional<scene::Pose> pose; // absent: of look_from()
        HitBuffer hits;
        std::shared_ptr<const Image> image;
    };

    static Result<BenchmarkScene> open_detail(const SceneChoice& choice,
                                              const SuiteOptions& options);
    BenchmarkScene(std::string name, session::TerrainScene scene, const SuiteOptions& options)
        : name_(std::move(name)), scene_(std::move(scene)), options_(options) {}
    Result<truth::Picture> draw_truth(const ParallelOptions& parallel);
    Result<const TruePicture*> truth(const std::stop_token& stop); // kept for the next call
    [[nodiscard]] std::string view_text() const;                   // "oblique", "from 300 m"
    [[nodiscard]] truth::SurfaceView surface_view() const;
    [[nodiscard]] Result<truth::GeometricErrors> errors(const HitBuffer& shown,
                                                        const HitBuffer& truth) const;

    std::string name_;
    session::TerrainScene scene_;
    SuiteOptions options_;
    std::optional<scene::Pose> pose_ = scene::Pose::overview; // absent: look_from()
    double distance_ = 0.0;                                   // of the last look_from(), metres
    std::optional<double> visibility_;                        // of the scene's air
    std::optional<double> sun_altitude_;                      // of the scene
    std::optional<truth::SceneCaster> caster_;
    std::optional<truth::Shading> shading_;
    std::optional<truth::DetailPlane> detail_; // absent for terrains
    std::optional<TruePicture> truth_;
};

class BenchmarkScenes {
public:
    /// `keep`: keeps all scenes; otherwise only the last one.
    BenchmarkScenes(const SuiteOptions& options, std::stop_token stop, bool keep)
        : options_(options), stop_(std::move(stop)), keep_(keep) {}

    /// Valid as long as this; unless all scenes are kept, until the next call.
    Result<BenchmarkScene*> get(const SceneChoice& choice);

private:
    SuiteOptions options_;
    std::stop_token stop_;
    bool keep_;
    std::vector<std::pair<SceneChoice, std::unique_ptr<BenchmarkScene>>> open_;
};

} // namespace reljef::bench

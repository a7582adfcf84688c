#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "bench/runner/suite_options.h"
#include "engine/core/result.h"
#include "engine/session/scene_renderer.h"
#include "engine/session/scene_setup.h"
#include "engine/truth/draw.h"
#include "engine/truth/geometric_error.h"
#include "engine/truth/tile_plane.h"

namespace reljef::bench {

/// The device of a suite; it selects each frame anew. Fails as session::Device::create.
Result<session::Device> make_device(const SuiteOptions& options);

/// Which terrain to measure on.
struct SceneChoice {
    /// A built-in name, a scene file or a DEM file; with a `size`, the generator "natural" or
    /// "urban".
    std::string terrain;
    int size = 0;          ///< samples a side of a generated terrain; 0: as `terrain` has it
    bool tileable = false; ///< of a generated urban
    /// Of terrains::detail_names(): no terrain, but copies of this tile over a level square.
    std::string tile = {};

    friend bool operator==(const SceneChoice&, const SceneChoice&) = default;
};

/// How stages are opened.
struct BenchmarkSceneOptions {
    glm::ivec2 size{1024, 768}; ///< of the picture, pixels
    int threads = 0;            ///< 0: as many as the machine has
    bool quiet = false;
};

/// The exact picture from one pose.
struct TruePicture {
    scene::Pose pose = scene::Pose::overview;
    HitBuffer hits;
    std::shared_ptr<const Image> image;
};

/// A terrain under a sun and a sky, or a tile of detail on a square under a sun, and what is right
/// there, found when first asked for.
class BenchmarkScene {
public:
    /// Fails on the gallery, whose models have no truth: its tiles have stages of their own.
    static Result<BenchmarkScene> open(const SceneChoice& choice,
                                       const BenchmarkSceneOptions& options,
                                       const std::stop_token& stop);

    /// The title of its scene, "urban 512 tile" for a generated one of a size of its own.
    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const scene::Scene& scene() const { return scene_.scene; }
    /// Precondition: it is no tile's.
    [[nodiscard]] const scene::Node& terrain() const { return *scene_.terrain; }

    void set_pose(scene::Pose pose);
    /// Not one of the poses: truth() is of those only.
    void set_camera(const scene::Camera& camera);
    void set_technique(const scene::Technique& technique);

    /// Seen from the pose that was set last. Kept for the next call. Fails where it is stopped.
    Result<std::reference_wrapper<const TruePicture>> truth(const std::stop_token& stop);

    /// Of a frame seen from that pose, see truth::geometric_errors().
    [[nodiscard]] Result<truth::GeometricErrors>
    errors(const HitBuffer& shown, const HitBuffer& truth, unsigned threads) const;

private:
    static Result<BenchmarkScene> open_tile(const SceneChoice& choice,
                                            const BenchmarkSceneOptions& options);
    BenchmarkScene(std::string name, session::TerrainScene scene,
                   const BenchmarkSceneOptions& options)
        : name_(std::move(name)), scene_(std::move(scene)), options_(options) {}
    Result<truth::Picture> true_picture(const ParallelOptions& parallel);

    std::string name_;
    session::TerrainScene scene_;
    BenchmarkSceneOptions options_;
    scene::Pose pose_ = scene::Pose::overview;
    std::optional<truth::SceneCaster> caster_;
    std::optional<truth::Shading> shading_;
    std::optional<truth::TilePlane> tile_; // where it is one's
    std::optional<TruePicture> truth_;
};

/// Opens stages as they are asked for, each once.
class BenchmarkScenes {
public:
    /// `keep`: holds all of them; else only the one asked for last, for large ones.
    BenchmarkScenes(const BenchmarkSceneOptions& options, std::stop_token stop, bool keep)
        : options_(options), stop_(std::move(stop)), keep_(keep) {}

    /// Valid until another one is asked for, or, kept, as long as this.
    Result<BenchmarkScene*> get(const SceneChoice& choice);

private:
    BenchmarkSceneOptions options_;
    std::stop_token stop_;
    bool keep_;
    std::vector<std::pair<SceneChoice, std::unique_ptr<BenchmarkScene>>> open_;
};

} // namespace reljef::bench

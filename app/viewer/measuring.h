#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "app/viewer/appearance/background.h"
#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/scene/graph/terrain_node.h"
#include "engine/session/ground.h"
#include "engine/session/log.h"
#include "engine/session/measuring/terrain_viewshed.h"
#include "engine/terrain/measure/profile.h"

namespace reljef::app {

/// Points picked on the ground and on objects, the way between the last two, and what is seen from
/// the last one.
class Measuring {
public:
    static constexpr double eye_height = 2.0; ///< above the ground, for lines of sight, metres

    /// Colours of the viewshed over the ground.
    static constexpr Rgba8 visible_color{136, 214, 84, 104};
    static constexpr Rgba8 hidden_color{18, 22, 70, 140};

    /// The scene outlives this.
    explicit Measuring(const session::TerrainScene& scene) : scene_(scene) {}

    void set_on(bool on) { is_on_ = on; }
    [[nodiscard]] bool is_on() const { return is_on_; }

    /// Picks a point of the ground or of an object; empty: the sky. Returns lines that tell its
    /// height, slope and aspect (of an object its name), and from the second point on the distance
    /// from the last one, along the ground too, and whether they see each other. Fails for the sky.
    Result<std::string> pick(const std::optional<session::PickedPlace>& place);
    [[nodiscard]] std::span<const glm::dvec3> points() const { return points_; }
    /// Between the last two points; empty before.
    [[nodiscard]] std::span<const terrain::ProfilePoint> profile() const { return profile_; }
    /// Whether the last two points see each other, eye_height above the ground.
    [[nodiscard]] bool is_in_sight() const { return is_in_sight_; }
    /// Of each point: its place, height, slope and aspect.
    [[nodiscard]] std::span<const std::string> texts() const { return texts_; }
    void clear();

    /// Writes "distance,height" lines. Fails without a profile.
    Result<void> save_profile(const std::filesystem::path& file) const;
    /// Begins the viewshed of the last point in the background; a streamed terrain's is that of its
    /// overview. Fails without a point, and while one is made.
    Result<void> begin_viewshed(const std::filesystem::path& file);
    /// Writes a finished viewshed, and keeps it as seen(). Returns a line on it, or the error;
    /// empty: not yet.
    std::optional<Result<std::string>> update();
    /// The last viewshed as colours over the ground, see scene::TerrainOptions::overlay; null:
    /// none.
    [[nodiscard]] const std::shared_ptr<const Image>& seen() const { return seen_; }
    void forget_viewshed() { seen_ = nullptr; }
    /// The label is empty if there is no viewshed.
    [[nodiscard]] session::RelayedLog::TaskProgress progress() const;

private:
    struct Viewshed {
        std::filesystem::path file;
        std::shared_ptr<const scene::TerrainSurface> surface;
        session::RelayedLog log;
        std::optional<Background<session::TerrainViewshed>> work; // uses the others
    };

    [[nodiscard]] const scene::TerrainNode& terrain() const {
        return *scene_.terrain->get<scene::TerrainNode>();
    }

    const session::TerrainScene& scene_;
    bool is_on_ = false;
    std::vector<glm::dvec3> points_; // world metres
    session::PickedPlace last_;
    double last_height_ = 0.0;       // of the last point, true metres
    std::vector<std::string> texts_; // of the points
    bool is_in_sight_ = false;
    std::vector<terrain::ProfilePoint> profile_;
    std::unique_ptr<Viewshed> viewshed_;
    std::shared_ptr<const Image> seen_;
};

} // namespace reljef::app

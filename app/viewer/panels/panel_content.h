#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/viewer/places/bookmark.h"
#include "engine/core/color.h"
#include "engine/geo/georeference.h"
#include "engine/geo/sun_position.h"
#include "engine/scene/graph/scene.h"
#include "engine/scene/technique/technique.h"
#include "engine/view/frame_stats.h"
#include "engine/view/picture/picture_marks.h"

namespace reljef::app {

// What the panels show: values only. A panel reads them and returns actions (panel_action.h).

struct FrameContent {
    view::FrameStats stats;
    double last_ms = 0.0;                    ///< of the last frame
    std::optional<double> frames_per_second; ///< absent at rest
    std::vector<float> recent_ms;            ///< oldest first
    glm::ivec2 picture{0};                   ///< drawn pixels; the window may show them enlarged
    glm::ivec2 window{0};                    ///< pixels
};

struct TechniqueChoice {
    scene::Technique technique;
    std::string reason;            ///< why it cannot be chosen; empty: it can
    std::optional<int> digit = {}; ///< the key that chooses it
};

/// Pixels of the window.
struct PixelBox {
    glm::dvec2 low{0.0};
    glm::dvec2 high{0.0};
};

struct ModelContent {
    std::string name;
    scene::Technique technique;
    std::optional<PixelBox> box = {}; ///< around it, of the selected one; absent: not in view
};

struct TechniqueContent {
    scene::Technique requested;              ///< of the first model if there are several
    std::vector<TechniqueChoice> choices;    ///< in the catalogue's order
    std::vector<ModelContent> models;        ///< the gallery's, else empty
    scene::Technique usual;                  ///< the edited one as it is without a choice
    std::optional<std::size_t> model;        ///< that the panel edits; absent: all
    std::vector<std::string> option_reasons; ///< in the catalogue's order: why one cannot be set
    std::size_t parameter = 0;               ///< that keys change, in the catalogue's order
    bool is_as_at_start = true;              ///< all models have their first techniques
    bool wireframe = false;
};

struct AppearanceContent {
    scene::Light light;                              ///< requested
    std::optional<geo::UniversalTime> sun_time = {}; ///< of the sun at the start; absent: none
    double turbidity = 1.0;
    std::optional<double> visibility = {}; ///< metres; 0: no haze; absent: no sky
    std::optional<geo::Geodetic> on_earth; ///< of the terrain's middle
    double true_north = 0.0;               ///< there, degrees clockwise from the scene's north
    std::string ramp;                      ///< requested; empty: heights have no colours
    std::vector<std::string> ramps;        ///< the built-in ones
    std::optional<double> imagery_share;   ///< requested; empty: the terrain has no imagery
    double grain = 0.0;                    ///< TerrainNode::grain
    double eye_dome = 0.0;                 ///< scene::Scene::eye_dome()
    double contours = 0.0;                 ///< TerrainNode::contours
    std::string faded_contours;            ///< why they are not seen; empty: they are
    bool labels_contours = true;           ///< TerrainNode::labels_contours
    double exaggeration = 1.0;             ///< requested
    double max_exaggeration = 1.0;         ///< that can be typed
    std::string fixed_exaggeration;        ///< why it cannot change; empty: it can
    std::optional<int> samples;            ///< absent: chosen for each frame
    bool shows_map = false;
    bool plays_path = false;
    bool follows_ground = false;
};

using view::LegendStop;

/// What the right part of the window shows.
enum class CompareWith { nothing, truth, errors, technique };

/// A row of two figures; the right one is empty if there is none.
struct FigureContent {
    std::string name;
    std::string left;
    std::string right;
};

struct CompareContent {
    CompareWith with = CompareWith::nothing;
    std::string obstacle;       ///< why there is no truth; empty: there is one
    scene::Technique technique; ///< on the right, if it is compared
    double share = 0.5;         ///< of the window left of the line
    std::string left_name;
    std::string right_name;
    std::optional<double> left_ms; ///< of the last frame, or of all rays of the truth
    std::optional<double> right_ms;
    std::vector<FigureContent> figures; ///< of the view; empty: not known yet
    std::string state;                  ///< what is awaited; empty: nothing
    double progress = 0.0;              ///< of that, [0, 1]
    std::vector<LegendStop> colors;     ///< of errors: the heights are pixels, by their logarithm
};

/// A picked point of the ground.
struct MeasuredPoint {
    std::string place;               ///< "46.12345, 8.12345"
    std::string ground;              ///< its height, slope and aspect
    std::optional<glm::dvec2> pixel; ///< in the window; absent: behind the eye
};

/// The ground between the last two points.
struct ProfileContent {
    std::vector<float> heights; ///< at equal distances, metres; without voids
    double distance = 0.0;      ///< horizontal, metres
    double over_ground = 0.0;   ///< metres
    double climb = 0.0;         ///< metres
    double descent = 0.0;       ///< metres
    double lowest = 0.0;        ///< metres
    double highest = 0.0;       ///< metres
    bool in_sight = false;      ///< the ends see each other
};

struct NamedColor {
    std::string name;
    Rgba8 color; ///< over the ground
};

struct MeasureContent {
    bool is_on = false; ///< clicks pick points
    std::vector<MeasuredPoint> points;
    std::optional<ProfileContent> profile;
    std::optional<bool> viewshed; ///< whether the ground has its colours; absent: there is none
    std::vector<NamedColor> ground_colors; ///< of the viewshed; empty: those of heights
};

struct PathContent {
    std::vector<double> keys; ///< times since the beginning, seconds, ascending
    double time = 0.0;        ///< of the flight, seconds since the beginning
    bool is_playing = false;
    bool is_recording = false;
    std::optional<double> video; ///< progress of the video that is rendered, [0, 1]
};

struct CrsPlace {
    glm::dvec2 at{0.0};
    std::string name; ///< "WGS 84 / UTM zone 10N"
    bool is_metric = true;
};

/// A point of the scene.
struct PlaceContent {
    glm::dvec3 world{0.0};                 ///< scene metres
    std::optional<geo::Geodetic> on_earth; ///< height: true metres
    std::optional<CrsPlace> in_crs;
    double height = 0.0;                ///< true metres above the DEM's zero
    std::optional<double> above_ground; ///< true metres; of the eye
    std::string object;                 ///< its name; empty: the ground
};

struct TaskContent {
    std::string label; ///< empty: none
    double fraction = 0.0;
};

/// How long new messages stay in view, seconds.
inline constexpr double message_seconds = 9.0;

struct MessageContent {
    std::string text;
    bool is_error = false;
    double age = 0.0; ///< seconds
};

struct KeyContent {
    std::string names; ///< "T, 1 2 ..."
    std::string meaning;
};

struct PanelContent {
    std::string terrain;
    FrameContent frame;
    TechniqueContent technique;
    AppearanceContent appearance;
    CompareContent compare;
    MeasureContent measure;
    PathContent path;
    BookmarkContent bookmarks;
    PlaceContent eye;
    std::optional<PlaceContent> cursor;     ///< the ground or object under the pointer
    std::optional<double> heading;          ///< degrees clockwise from north
    std::optional<double> metres_per_pixel; ///< of the window, at its middle
    double speed = 0.0;                     ///< metres per second
    std::vector<LegendStop> legend;         ///< upwards; empty: heights have no colours
    TaskContent task;
    std::vector<MessageContent> messages; ///< oldest first
    std::vector<KeyContent> keys;
};

} // namespace reljef::app

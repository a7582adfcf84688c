#pragma once

#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/viewer/panels/panel_content.h"
#include "engine/core/event.h"
#include "engine/scene/technique/technique.h"

namespace reljef::app {

/// Draws all models, or one, with a technique.
struct ChooseTechnique {
    scene::Technique technique;
    std::optional<std::size_t> model; ///< absent: all
};

/// The model that the technique panel edits; absent: all.
struct SelectModel {
    std::optional<std::size_t> model;
};

/// The parameter that keys change.
struct SelectParameter {
    std::size_t index = 0;
};

struct SetSun {
    double azimuth = 0.0;  ///< degrees clockwise from north
    double altitude = 0.0; ///< degrees above the horizon, [-90, 90]
};

struct SetTurbidity {
    double turbidity = 1.0; ///< [scene::min_turbidity, scene::max_turbidity]
};

/// How far one sees through haze.
struct SetVisibility {
    double metres = 0.0; ///< > 0
};

/// Fine structure of near ground.
struct SetGrain {
    double strength = 0.0; ///< [0, scene::max_grain]
};

/// Eye-dome lighting.
struct SetEyeDome {
    double strength = 0.0; ///< [0, 1]
};

struct SetContourLabels {
    bool shown = true;
};
struct SetContours {
    /// Of height from one line to the next; 0: none. Others than scene::min_contours to
    /// max_contours become the nearest of them, with a note.
    double metres = 0.0;
};

/// Colours of heights.
struct SetRamp {
    std::string name; ///< of a built-in ramp
};

/// The rest of the colours are those of heights.
struct SetImageryShare {
    double share = 1.0; ///< [0, 1]
};

struct SetExaggeration {
    double factor = 1.0; ///< (0, terrain::max_exaggeration]
};

struct SetSamples {
    std::optional<int> samples; ///< absent: chosen for each frame
};

struct SetComparison {
    CompareWith with = CompareWith::nothing;
};

/// Compares with a technique.
struct SetOtherTechnique {
    scene::Technique technique;
};

/// Moves the line between the compared pictures.
struct SetWipe {
    double share = 0.5; ///< of the width, [0, 1]
};

/// The technique on the right comes to the left, and the other way round.
struct SwapTechniques {};

/// Shows the path's view at a time since its beginning, and stops there.
struct SeekPath {
    double seconds = 0.0;
};

/// Inserts the view as a keyframe at a time since the path's beginning.
struct InsertPathKey {
    double seconds = 0.0;
};

/// Gives a keyframe the view.
struct MovePathKey {
    std::size_t key = 0;
};

/// Moves a keyframe to another time since the path's beginning.
struct RetimePathKey {
    std::size_t key = 0;
    double seconds = 0.0;
};

struct RemovePathKey {
    std::size_t key = 0;
};

/// Stretches the path.
struct SetPathDuration {
    double seconds = 0.0; ///< > 0
};

/// Keeps the view under a name; empty: "view 1", "view 2", ….
struct AddBookmark {
    std::string name;
};

struct GoToBookmark {
    Bookmark bookmark;
};

struct RenameBookmark {
    Bookmark bookmark;
    std::string name; ///< not empty
};

struct RemoveBookmark {
    Bookmark bookmark;
};

/// Of the flight with keys.
struct SetSpeed {
    double speed = 0.0; ///< metres per second, > 0
};

struct CancelVideo {};

/// Forgets the measured points.
struct ClearPoints {};

/// Colours the ground by what the last viewshed sees.
struct ShowViewshed {
    bool shown = true;
};

/// Does what the key does.
struct PressKey {
    Key key = Key::unknown;
};

/// Copies the command that renders this view.
struct CopyCommand {};

using PanelAction =
    std::variant<ChooseTechnique, SelectModel, SelectParameter, SetSun, SetTurbidity, SetVisibility,
                 SetGrain, SetContours, SetContourLabels, SetEyeDome, SetRamp, SetImageryShare,
                 SetExaggeration, SetSamples, PressKey, CopyCommand, SetComparison,
                 SetOtherTechnique, SetWipe, SwapTechniques, SeekPath, InsertPathKey, MovePathKey,
                 RetimePathKey, RemovePathKey, SetPathDuration, CancelVideo, ClearPoints,
                 AddBookmark, GoToBookmark, RenameBookmark, RemoveBookmark, SetSpeed, ShowViewshed>;
using PanelActions = std::vector<PanelAction>;

inline PanelActions& operator+=(PanelActions& actions, PanelActions more) {
    actions.insert(actions.end(), std::make_move_iterator(more.begin()),
                   std::make_move_iterator(more.end()));
    return actions;
}

} // namespace reljef::app

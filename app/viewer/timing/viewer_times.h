#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace reljef::app {

/// How the panels came into a frame.
enum class PanelWork { hidden, copied, drawn };

/// What the viewer still has to do.
struct OpenWork {
    bool is_preparing = false; ///< computes maps or finer ground in the background
    bool is_loading = false;   ///< waits for tiles
    bool has_actions = false;  ///< of controls, which take effect before the next frame
    bool is_stale = false;     ///< the panels have events that no frame shows
    bool is_reduced = false;   ///< the last picture has fewer pixels or samples than requested
};

/// A frame that the window has shown.
struct ShownFrame {
    double at = 0.0; ///< when, seconds since the program began
    std::optional<double> picture_ms =
        {};                ///< of the scene; absent: that of the last frame is shown
    double frame_ms = 0.0; ///< picture, panels and window; 0 without a picture
    double panels_ms = 0.0;
    PanelWork panels = PanelWork::hidden;
};

/// Times of one kind.
struct TimeRow {
    std::string_view key;  ///< in JSON
    std::string_view name; ///< in text
    std::vector<double> ms;
    std::optional<int> max_frames = {}; ///< of answers: from the event to the frame that shows it
};

struct TimeReport {
    /// Seconds since the program began; absent: never shown.
    std::optional<double> first_picture;
    /// All tiles and maps that the first view needs are in it.
    std::optional<double> complete_picture;
    std::vector<TimeRow> rows;
};

/// Times of a viewer: of its pictures, its panels, and its answers to keys and clicks. Has no
/// clock: all times are arguments, seconds since the program began.
class ViewerTimes {
public:
    /// A key or button went down, a button went up, or the wheel turned.
    void receive(double at, const OpenWork& work);
    /// A control of the panels took effect: events since the last frame were for it.
    void act();
    /// The window shows a frame, with all that was received and is not open.
    void show(const ShownFrame& frame, const OpenWork& work);
    /// Nothing is drawn until something happens: what has no answer yet has changed nothing.
    void rest();

    /// A row for each kind, also without times.
    [[nodiscard]] TimeReport report() const;

private:
    struct Input {
        double at = 0.0;
        int frames = 0; // since then
        bool is_control = false;
        bool is_loading = false;
        bool is_preparing = false; // at that time, for something else
        bool has_waited = false;   // for the background
    };
    struct Answer {
        Input input;
        double ms = 0.0;
    };

    std::vector<Input> inputs_; // without an answer
    std::vector<Answer> answers_;
    std::vector<ShownFrame> frames_;
    std::optional<double> first_picture_;
    std::optional<double> complete_picture_;
};

} // namespace reljef::app

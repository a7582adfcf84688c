// The viewer's keys.
#include <array>

#include <fmt/format.h>

#include "app/viewer/viewer.h"

namespace reljef::app {

struct Viewer::Binding {
    Key key;
    Key other; // alternative; unknown: none
    void (Viewer::*action)();
    const char* names;
    const char* meaning;
};

std::span<const Viewer::Binding> Viewer::bindings() {
    static constexpr std::array<Binding, 34> all{
        {{Key::p, Key::unknown, &Viewer::toggle_path, "P", "fly along the path, or stop"},
         {Key::g, Key::unknown, &Viewer::toggle_follow_ground, "G",
          "keep the height above the ground, or fly where you look"},
         {Key::o, Key::unknown, &Viewer::toggle_map, "O", "map from straight above, and back"},
         {Key::t, Key::unknown, &Viewer::next_technique, "T, 1 2 ...",
          "next technique, or the technique of that number"},
         {Key::digit0, Key::unknown, &Viewer::restore_techniques, "0",
          "the techniques of the start; the gallery's models have different ones"},
         {Key::right_bracket, Key::unknown, &Viewer::raise_parameter, "]",
          "raise the technique's parameter that is highlighted"},
         {Key::left_bracket, Key::unknown, &Viewer::lower_parameter, "[", "lower it"},
         {Key::period, Key::unknown, &Viewer::next_parameter, ".", "highlight the next parameter"},
         {Key::comma, Key::unknown, &Viewer::last_parameter, ",",
          "highlight the parameter before it"},
         {Key::l, Key::unknown, &Viewer::turn_light, "L", "turn the light by 15 degrees"},
         {Key::f, Key::unknown, &Viewer::toggle_wireframe, "F",
          "only the edges of triangles, or filled triangles"},
         {Key::m, Key::unknown, &Viewer::toggle_mouse_look, "M",
          "turn with every move of the mouse, or only with its button held"},
         {Key::r, Key::home, &Viewer::go_to_start, "R, Home", "back to the first view"},
         {Key::b, Key::unknown, &Viewer::bookmark_here, "B", "keep this view as a bookmark"},
         {Key::n, Key::unknown, &Viewer::next_bookmark, "N", "fly to the next bookmark"},
         {Key::v, Key::unknown, &Viewer::copy_camera, "V, Ctrl-C",
          "copy the --camera of this view"},
         {Key::x, Key::unknown, &Viewer::toggle_measuring, "X",
          "measure: each click picks a point of the ground; X ends it"},
         {Key::i, Key::unknown, &Viewer::keep_profile, "I",
          "save the profile between the last two points"},
         {Key::u, Key::unknown, &Viewer::keep_viewshed, "U",
          "save what is seen from the last point, 2 m above it, and colour the ground by it"},
         {Key::f2, Key::unknown, &Viewer::toggle_viewshed, "F2",
          "end these colours of the ground, or show them again"},
         {Key::k, Key::unknown, &Viewer::toggle_recording, "K",
          "record the flight as the path, or end it and save the path"},
         {Key::insert, Key::unknown, &Viewer::append_key, "Insert",
          "append this view to the path, 3 s later"},
         {Key::erase, Key::unknown, &Viewer::remove_key, "Delete",
          "remove the keyframe where the flight along the path stands"},
         {Key::j, Key::unknown, &Viewer::keep_path, "J", "save the path (TOML, and GPX on Earth)"},
         {Key::y, Key::unknown, &Viewer::ask_for_video, "Y",
          "render the path to a video; Esc cancels it"},
         {Key::space, Key::unknown, &Viewer::toggle_comparison, "Space",
          "compare with the truth, or with what was compared last; and back"},
         {Key::enter, Key::unknown, &Viewer::next_comparison, "Enter",
          "compare with the truth, its errors, or another technique"},
         {Key::backslash, Key::unknown, &Viewer::next_other_technique, "\\",
          "compare with the next technique"},
         {Key::minus, Key::unknown, &Viewer::move_line_left, "-",
          "move the line between the compared pictures to the left, as dragging it does"},
         {Key::plus, Key::unknown, &Viewer::move_line_right, "+, =", "move it to the right"},
         {Key::c, Key::f12, &Viewer::ask_for_screenshot, "C, F12",
          "save the picture here as reljef-0001.png, reljef-0002.png, ..."},
         {Key::z, Key::unknown, &Viewer::ask_for_command, "Z",
          "copy the command that renders this view"},
         {Key::h, Key::f1, &Viewer::ask_for_help, "H, F1", "show the keys, or hide them"},
         {Key::escape, Key::unknown, &Viewer::leave, "Esc",
          "release the mouse, end and save a recording, or quit"}}};
    return all;
}

std::vector<KeyContent> Viewer::key_list() {
    std::vector<KeyContent> list{
        {"wheel", "closer to the ground under the pointer, or farther"},
        {"left drag", "orbit around the ground under the pointer"},
        {"right drag", "pan; the map: every button (Q E: closer, farther)"},
        {"middle drag", "turn in place; so does a left drag from the sky"},
        {"double click", "fly there"},
        {"W A S D, arrows", "move (shift: faster; Ctrl and wheel: speed)"},
        {"Q E", "down, up; never under the ground"}};
    for (const Binding& binding : bindings()) {
        list.push_back({binding.names, binding.meaning});
    }
    list.push_back({"Tab", "hide the panels, or show them"});
    return list;
}

std::string Viewer::keys() {
    std::string text;
    for (const KeyContent& key : key_list()) {
        text += fmt::format("  {:<15}  {}\n", key.names, key.meaning);
    }
    return text;
}

bool Viewer::receive_key(const KeyEvent& event) {
    const Modifiers& with = event.modifiers;
    if (event.pressed && with.control && event.key == Key::c && !event.repeat) {
        copy_camera();
        return true;
    }
    if (!event.pressed || event.repeat || with.control || with.alt || with.super) {
        return false;
    }
    if (event.key >= Key::digit1 && event.key <= Key::digit9) {
        choose_technique(static_cast<std::size_t>(event.key) -
                         static_cast<std::size_t>(Key::digit1));
        return true;
    }
    for (const Binding& binding : bindings()) {
        if (event.key != Key::unknown && (binding.key == event.key || binding.other == event.key)) {
            (this->*binding.action)();
            return true;
        }
    }
    return false;
}

} // namespace reljef::app

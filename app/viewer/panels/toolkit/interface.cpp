#include "app/viewer/panels/toolkit/interface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <iterator>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include <backends/imgui_impl_opengl3.h>
#include <glm/common.hpp>
#include <imgui.h>
#include <imgui_internal.h> // the areas of windows

#include "app/viewer/panels/toolkit/kept_picture.h"
#include "app/viewer/panels/toolkit/panel_changes.h"
#include "app/viewer/panels/toolkit/panel_rasterizer.h"
#include "engine/gl/framebuffer.h"
#include "engine/gl/texture.h"

namespace reljef::app {
namespace {

constexpr const char* glsl_version = "#version 330 core";
constexpr double min_step = 1e-4; // seconds; ImGui needs more than 0
// After an event: one frame to react, one with the new state, one with areas that fit it.
constexpr int frames_after_event = 3;

struct KeyPair {
    ImGuiKey imgui;
    Key key;
};
constexpr std::array keys{KeyPair{ImGuiKey_Tab, Key::tab},
                          KeyPair{ImGuiKey_LeftArrow, Key::left},
                          KeyPair{ImGuiKey_RightArrow, Key::right},
                          KeyPair{ImGuiKey_UpArrow, Key::up},
                          KeyPair{ImGuiKey_DownArrow, Key::down},
                          KeyPair{ImGuiKey_PageUp, Key::page_up},
                          KeyPair{ImGuiKey_PageDown, Key::page_down},
                          KeyPair{ImGuiKey_Home, Key::home},
                          KeyPair{ImGuiKey_End, Key::end},
                          KeyPair{ImGuiKey_Insert, Key::insert},
                          KeyPair{ImGuiKey_Delete, Key::erase},
                          KeyPair{ImGuiKey_Backspace, Key::backspace},
                          KeyPair{ImGuiKey_Space, Key::space},
                          KeyPair{ImGuiKey_Enter, Key::enter},
                          KeyPair{ImGuiKey_Escape, Key::escape},
                          KeyPair{ImGuiKey_A, Key::a},
                          KeyPair{ImGuiKey_C, Key::c},
                          KeyPair{ImGuiKey_V, Key::v},
                          KeyPair{ImGuiKey_X, Key::x},
                          KeyPair{ImGuiKey_Y, Key::y},
                          KeyPair{ImGuiKey_Z, Key::z}};

std::optional<int> button_of(const Event& event) {
    const auto* const button = std::get_if<MouseButtonEvent>(&event);
    return button == nullptr || button->button == MouseButton::other
               ? std::nullopt
               : std::optional(static_cast<int>(button->button));
}

ImVec2 in_floats(glm::dvec2 pixel) {
    return {static_cast<float>(pixel.x), static_cast<float>(pixel.y)};
}

void set_modifiers(ImGuiIO& io, const Modifiers& with) {
    io.KeyShift = with.shift;
    io.KeyCtrl = with.control;
    io.KeyAlt = with.alt;
    io.KeySuper = with.super;
}

void pass_to(ImGuiIO& io, const Event& event) {
    if (const auto* key = std::get_if<KeyEvent>(&event)) {
        io.KeysDown[static_cast<std::size_t>(key->key)] = key->pressed;
        set_modifiers(io, key->modifiers);
    } else if (const auto* text = std::get_if<TextEvent>(&event)) {
        io.AddInputCharacter(static_cast<unsigned int>(text->character));
    } else if (const auto* move = std::get_if<MouseMoveEvent>(&event)) {
        io.MousePos = in_floats(move->position);
    } else if (const auto* button = std::get_if<MouseButtonEvent>(&event)) {
        io.MousePos = in_floats(button->position);
        set_modifiers(io, button->modifiers);
        if (const auto index = button_of(event)) {
            io.MouseDown[*index] = button->pressed;
        }
    } else if (const auto* scroll = std::get_if<ScrollEvent>(&event)) {
        io.MouseWheel += static_cast<float>(scroll->offset.y);
    } else if (const auto* focus = std::get_if<FocusEvent>(&event)) {
        io.AddFocusEvent(focus->focused);
    }
}

// Draws with OpenGL, which has its shaders and its font from the first call on. Precondition: all
// textures of the data are the font.
void draw_with_opengl(ImDrawData& data) {
    ImGui_ImplOpenGL3_NewFrame();
    const ImTextureID font = ImGui::GetIO().Fonts->TexID;
    // Texels of letters lie on pixels, and areas have one colour: the nearest texel is exact, and
    // takes software renderers less time than the bilinear filter that ImGui sets.
    gl::set_sampling(static_cast<unsigned int>(reinterpret_cast<std::uintptr_t>(font)),
                     {.filter = gl::Filter::nearest}, 1);
    for (ImDrawList* const list :
         std::span(data.CmdLists, static_cast<std::size_t>(data.CmdListsCount))) {
        for (ImDrawCmd& command : list->CmdBuffer) {
            command.TextureId = font;
        }
    }
    ImGui_ImplOpenGL3_RenderDrawData(&data);
}

} // namespace

struct Interface::State {
    InterfaceOptions options;
    Fonts fonts;
    ImGuiContext* context = nullptr;
    PointerFocus focus;
    std::deque<Event> events; // that no frame has seen
    int frames_due = frames_after_event;
    std::vector<Area> areas; // of the panels in the last frame
    KeptPicture picture;
    PanelChanges changes;
    bool is_kept = false; // the last frame, in the picture
    bool types_text = false;
    bool opens_list = false;
    bool closes_list = false; // in the next frame
    std::string copied;       // what ImGui asked for last

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (context != nullptr) {
            ImGui::SetCurrentContext(context);
            if (ImGui::GetIO().BackendRendererUserData != nullptr) {
                ImGui_ImplOpenGL3_Shutdown();
            }
            ImGui::DestroyContext(context);
        }
    }

    [[nodiscard]] bool is_over(glm::dvec2 pixel) const {
        return std::any_of(areas.begin(), areas.end(),
                           [&](const Area& area) { return area.contains(pixel); });
    }

    // A press and its release in one frame would be none: the second change of a button or a key
    // waits.
    void pass_events(ImGuiIO& io) {
        std::array<bool, 3> has_changed{};
        std::set<Key> changed_keys;
        while (!events.empty()) {
            const auto* const key = std::get_if<KeyEvent>(&events.front());
            if (key != nullptr && !key->repeat && !changed_keys.insert(key->key).second) {
                return;
            }
            if (const auto button = button_of(events.front())) {
                bool& changed = has_changed.at(static_cast<std::size_t>(*button));
                if (std::exchange(changed, true)) {
                    return;
                }
            }
            pass_to(io, events.front());
            events.pop_front();
        }
    }

    // Windows without a parent, which contain all others. What is drawn below them is not kept.
    [[nodiscard]] std::vector<RoundedArea> shown_areas() const {
        std::vector<RoundedArea> shown;
        for (const ImGuiWindow* const window : context->Windows) {
            if (window->Active && !window->Hidden && window->ParentWindow == nullptr &&
                !window->IsFallbackWindow) {
                const glm::dvec2 low(window->Pos.x, window->Pos.y);
                const glm::dvec2 size(window->Size.x, window->Size.y);
                shown.push_back({glm::ivec2(glm::floor(low)), glm::ivec2(glm::ceil(low + size)),
                                 static_cast<int>(window->WindowRounding)});
            }
        }
        return shown;
    }

    void draw_frame() {
        gl::bind_window();
        ImDrawData panels = *ImGui::GetDrawData();
        const bool has_background = draw_background(panels);
        const glm::ivec2 size(static_cast<int>(panels.DisplaySize.x),
                              static_cast<int>(panels.DisplaySize.y));
        if (!options.keeps_unchanged || !make_picture(size)) {
            is_kept = false;
            draw_with_opengl(panels);
            return;
        }
        picture.draw(shown_areas(), changes.update(panels),
                     [&](const PixelArea& area, Image& drawn) {
                         rasterize(panels, letters(), area, drawn);
                     });
        is_kept = !has_background;
    }

    // Whether there is a picture of that size.
    bool make_picture(glm::ivec2 size) {
        if (picture.is_of(size)) {
            return true;
        }
        changes.forget();
        return picture.resize(size);
    }

    // The alpha of the font atlas.
    static GridView<const std::uint8_t> letters() {
        unsigned char* alpha = nullptr;
        int width = 0;
        int height = 0;
        ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&alpha, &width, &height);
        return {alpha, width, height, width};
    }

    // Draws what lies between the view and the panels, such as measured points, and takes it out.
    static bool draw_background(ImDrawData& panels) {
        const bool has_background = ImGui::GetBackgroundDrawList()->VtxBuffer.Size > 0;
        if (has_background) {
            ImDrawData background = panels;
            background.CmdListsCount = 1; // the first one
            draw_with_opengl(background);
            ++panels.CmdLists;
            --panels.CmdListsCount;
        }
        return has_background;
    }

    void read_areas() {
        areas.clear();
        for (const ImGuiWindow* const window : context->Windows) {
            const bool is_panel = window->WasActive && window->ParentWindow == nullptr &&
                                  (window->Flags & ImGuiWindowFlags_NoMouseInputs) == 0 &&
                                  !window->IsFallbackWindow;
            if (is_panel) {
                const ImVec2 low = window->Pos;
                areas.push_back({{low.x, low.y}, {low.x + window->Size.x, low.y + window->Size.y}});
            }
        }
    }
};

Interface::Interface(std::unique_ptr<State> state) : state_(std::move(state)) {}
Interface::Interface(Interface&& other) noexcept = default;
Interface& Interface::operator=(Interface&& other) noexcept = default;
Interface::~Interface() = default;

Result<Interface> Interface::create(const InterfaceOptions& options) {
    auto state = std::make_unique<State>();
    state->options = options;
    state->context = ImGui::CreateContext();
    ImGui::SetCurrentContext(state->context);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    for (const KeyPair& pair : keys) {
        io.KeyMap[pair.imgui] = static_cast<int>(pair.key);
    }
    io.ClipboardUserData = state.get();
    io.GetClipboardTextFn = [](void* user) {
        auto& self = *static_cast<State*>(user);
        self.copied = self.options.clipboard ? self.options.clipboard() : self.copied;
        return self.copied.c_str();
    };
    io.SetClipboardTextFn = [](void* user, const char* text) {
        auto& self = *static_cast<State*>(user);
        self.copied = text;
        if (self.options.set_clipboard) {
            self.options.set_clipboard(self.copied);
        }
    };
    state->fonts = apply_theme(static_cast<float>(options.scale));
    io.Fonts->Build(); // takes long, so not in the first frame
    if (options.draws && !ImGui_ImplOpenGL3_Init(glsl_version)) {
        return Error{"panels: libGL.so.1 cannot be loaded, the package libgl1 was expected"};
    }
    return Interface(std::move(state));
}

bool Interface::receive(const Event& event) {
    const PanelsShown shown{[this](glm::dvec2 pixel) { return state_->is_over(pixel); },
                            state_->types_text, state_->opens_list};
    const auto receiver = state_->focus.receiver_of(event, shown);
    const auto* const key = std::get_if<KeyEvent>(&event);
    state_->closes_list = state_->closes_list || (state_->opens_list && key != nullptr &&
                                                  key->pressed && key->key == Key::escape);
    const bool is_held = key != nullptr && key->repeat && !state_->types_text;
    if (receiver != PointerFocus::Receiver::view && !is_held) {
        state_->events.push_back(event);
        state_->frames_due = frames_after_event;
    }
    return receiver == PointerFocus::Receiver::panels;
}

bool Interface::is_stale() const {
    return state_->frames_due > 0 || !state_->events.empty();
}

bool Interface::has_input() const {
    ImGui::SetCurrentContext(state_->context);
    const auto& held = ImGui::GetIO().MouseDown;
    const bool is_held =
        std::any_of(std::begin(held), std::end(held), [](bool down) { return down; });
    return std::any_of(state_->events.begin(), state_->events.end(), [&](const Event& event) {
        return is_held || std::holds_alternative<KeyEvent>(event) || button_of(event) ||
               std::holds_alternative<ScrollEvent>(event);
    });
}

void Interface::refresh() {
    state_->frames_due = frames_after_event;
}

bool Interface::is_kept(glm::ivec2 size) const {
    return state_->is_kept && state_->picture.is_of(size);
}

void Interface::show_again() const {
    state_->picture.show();
}

bool Interface::types_text() const {
    return state_->types_text;
}

bool Interface::is_over_panel(glm::dvec2 pixel) const {
    return state_->opens_list || state_->is_over(pixel);
}

void Interface::forget() {
    ImGui::SetCurrentContext(state_->context);
    ImGuiIO& io = ImGui::GetIO();
    std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
    std::fill(std::begin(io.MouseDown), std::end(io.MouseDown), false);
    state_->events.clear();
    state_->areas.clear();
    state_->is_kept = false;
    state_->focus = {};
    state_->types_text = false;
    state_->opens_list = false;
    state_->frames_due = frames_after_event;
}

void Interface::begin(glm::ivec2 size, double seconds) {
    ImGui::SetCurrentContext(state_->context);
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = in_floats(glm::dvec2(size));
    io.DeltaTime = static_cast<float>(std::max(std::isfinite(seconds) ? seconds : 0.0, min_step));
    state_->pass_events(io);
    state_->frames_due = std::max(state_->frames_due - 1, 0);
    ImGui::NewFrame();
    if (std::exchange(state_->closes_list, false)) {
        ImGui::ClosePopupsOverWindow(nullptr, false);
    }
}

void Interface::end() {
    ImGui::Render();
    if (state_->options.draws) {
        state_->draw_frame();
    }
    const ImGuiIO& io = ImGui::GetIO();
    state_->types_text = io.WantTextInput;
    state_->opens_list =
        ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    state_->read_areas();
}

const Fonts& Interface::fonts() const {
    return state_->fonts;
}

float Interface::scale() const {
    return static_cast<float>(state_->options.scale);
}

} // namespace reljef::app

#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <imgui.h>

#include "app/viewer/panels/toolkit/interface.h"

namespace reljef::app {

ImU32 in_imgui(Rgba8 color);

/// A panel of a fixed area. Ends with the object.
class Card {
public:
    enum class Scrolling { none, vertical };
    enum class Order { usual, top }; ///< top: over all other panels

    Card(const char* name, const Area& area, Scrolling scrolling = Scrolling::none,
         Order order = Order::usual);
    ~Card();
    Card(const Card&) = delete;
    Card& operator=(const Card&) = delete;
};

/// Another font until the object ends.
class FontScope {
public:
    explicit FontScope(ImFont* font) { ImGui::PushFont(font); }
    ~FontScope() { ImGui::PopFont(); }
    FontScope(const FontScope&) = delete;
    FontScope& operator=(const FontScope&) = delete;
};

void text(std::string_view line);
void muted_text(std::string_view line);
void wrapped_muted_text(std::string_view paragraph);
/// A paragraph that one should see; nothing if it is empty.
void warning_text(std::string_view paragraph);
/// One line that ends with "..." where the panel ends; the tip shows all of it.
void fitted_text(const std::string& line);
/// A muted name at the left, its value at the right edge.
void row(std::string_view name, const std::string& value);
/// A heading with space above it.
void section(ImFont* font, std::string_view heading);
/// Explains the last item while the pointer rests on it, also if it is disabled.
void tip(std::string_view explanation);
/// A button over the whole width.
bool wide_button(const char* label);
/// Rows of buttons of equal width, one of them chosen. Returns the chosen one.
std::size_t tabs(std::span<const char* const> names, std::size_t chosen, std::size_t in_a_row);
/// A box to tick, labelled as the command line has it.
bool tick(const char* label, bool is_on);

} // namespace reljef::app

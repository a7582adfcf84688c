#include "app/viewer/panels/toolkit/theme.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

#include <imgui.h>

namespace reljef::app {
namespace {

struct FontFiles {
    const char* text;
    const char* bold;
};

// Debian's packages fonts-open-sans and fonts-dejavu-core.
constexpr std::array font_files{
    FontFiles{"/usr/share/fonts/truetype/open-sans/OpenSans-Regular.ttf",
              "/usr/share/fonts/truetype/open-sans/OpenSans-Semibold.ttf"},
    FontFiles{"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
              "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"}};

// Pairs of first and last code point: Latin with accents, Greek, Cyrillic, punctuation, arrows and
// mathematical signs. The atlas reads them when it is built.
constexpr std::array<ImWchar, 13> letters{0x20,   0x24F,  0x370,  0x3FF,  0x400,  0x52F, 0x2010,
                                          0x2044, 0x2190, 0x2193, 0x2248, 0x2265, 0};
constexpr std::array<ImWchar, 5> digits_and_units{0x20, 0xFF, 0x2010, 0x2044, 0};

constexpr float text_size = 16.0F; // pixels at scale 1
constexpr float small_size = 14.0F;
constexpr float heading_size = 16.0F;
constexpr float figure_size = 26.0F;

const FontFiles* installed_fonts() {
    const auto* const found =
        std::find_if(font_files.begin(), font_files.end(), [](const FontFiles& files) {
            std::error_code ignored;
            return std::filesystem::exists(files.text, ignored) &&
                   std::filesystem::exists(files.bold, ignored);
        });
    return found == font_files.end() ? nullptr : found;
}

Fonts load_fonts(float scale) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    const FontFiles* const files = installed_fonts();
    if (files == nullptr) {
        ImFontConfig config;
        config.SizePixels = 13.0F * scale;
        ImFont* const font = atlas.AddFontDefault(&config);
        return {font, font, font, font,
                "no font with accents: install the package fonts-open-sans or fonts-dejavu-core"};
    }
    const auto add = [&](const char* file, float size, const ImWchar* ranges) {
        return atlas.AddFontFromFileTTF(file, size * scale, nullptr, ranges);
    };
    Fonts fonts;
    fonts.text = add(files->text, text_size, letters.data());
    fonts.heading = add(files->bold, heading_size, letters.data());
    fonts.small = add(files->text, small_size, letters.data());
    fonts.figure = add(files->bold, figure_size, digits_and_units.data());
    return fonts;
}

ImVec4 linear_order(Rgba8 color) {
    return ImGui::ColorConvertU32ToFloat4(IM_COL32(color.r, color.g, color.b, color.a));
}

void set_colors(ImGuiStyle& style) {
    const auto set = [&](ImGuiCol which, Rgba8 color) {
        style.Colors[which] = linear_order(color);
    };
    constexpr Rgba8 none{0, 0, 0, 0};
    set(ImGuiCol_Text, palette::text);
    set(ImGuiCol_TextDisabled, palette::muted);
    set(ImGuiCol_WindowBg, palette::surface);
    set(ImGuiCol_ChildBg, none);
    set(ImGuiCol_PopupBg, palette::raised);
    set(ImGuiCol_Border, palette::line);
    set(ImGuiCol_FrameBg, palette::field);
    set(ImGuiCol_FrameBgHovered, palette::field_hovered);
    set(ImGuiCol_FrameBgActive, palette::field_hovered);
    set(ImGuiCol_ScrollbarBg, none);
    set(ImGuiCol_ScrollbarGrab, palette::grab);
    set(ImGuiCol_ScrollbarGrabHovered, palette::muted);
    set(ImGuiCol_ScrollbarGrabActive, palette::muted);
    set(ImGuiCol_CheckMark, palette::accent);
    set(ImGuiCol_SliderGrab, palette::accent);
    set(ImGuiCol_SliderGrabActive, palette::accent);
    set(ImGuiCol_Button, palette::field);
    set(ImGuiCol_ButtonHovered, palette::field_hovered);
    set(ImGuiCol_ButtonActive, palette::accent_soft);
    set(ImGuiCol_Header, palette::accent_soft);
    set(ImGuiCol_HeaderHovered, palette::field_hovered);
    set(ImGuiCol_HeaderActive, palette::accent_soft);
    set(ImGuiCol_Separator, palette::line);
    set(ImGuiCol_Tab, none);
    set(ImGuiCol_TabHovered, palette::field_hovered);
    set(ImGuiCol_TabActive, palette::accent_soft);
    set(ImGuiCol_TabUnfocused, none);
    set(ImGuiCol_TabUnfocusedActive, palette::accent_soft);
    set(ImGuiCol_PlotLines, palette::accent);
    set(ImGuiCol_PlotHistogram, palette::accent);
    set(ImGuiCol_TextSelectedBg, palette::accent_soft);
}

} // namespace

Fonts apply_theme(float scale) {
    ImGuiStyle& style = ImGui::GetStyle();
    style = ImGuiStyle();
    style.WindowPadding = {14.0F, 12.0F};
    style.FramePadding = {8.0F, 3.0F};
    style.ItemSpacing = {8.0F, 6.0F};
    style.ItemInnerSpacing = {6.0F, 4.0F};
    style.WindowRounding = 0.0F; // a copy for each panel, see KeptPicture
    style.ChildRounding = 6.0F;
    style.FrameRounding = 5.0F;
    style.PopupRounding = 0.0F;
    style.GrabRounding = 5.0F;
    style.TabRounding = 5.0F;
    style.ScrollbarRounding = 4.0F;
    style.ScrollbarSize = 9.0F;
    style.GrabMinSize = 12.0F;
    style.WindowBorderSize = 1.0F;
    style.PopupBorderSize = 1.0F;
    style.DisabledAlpha = 0.42F;
    style.AntiAliasedLinesUseTex = false; // these need a bilinear filter
    style.CircleTessellationMaxError = 0.5F;
    style.ScaleAllSizes(scale);
    set_colors(style);
    return load_fonts(scale);
}

} // namespace reljef::app

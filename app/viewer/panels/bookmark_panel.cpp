#include "app/viewer/panels/bookmark_panel.h"

#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "app/viewer/panels/panel_text.h"
#include "app/viewer/panels/toolkit/number_control.h"
#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {
namespace {

constexpr double lowest_speed = 0.1; // metres a second, of the slider
constexpr double highest_speed = 1e5;
constexpr const char* rename_label = "Rename";
constexpr const char* delete_label = "Delete";

float width_of_button(const char* label) {
    return ImGui::CalcTextSize(label).x + 2.0F * ImGui::GetStyle().FramePadding.x;
}

// Cuts a name that is too long between two characters.
template <class Name> void set_name(Name& name, std::string_view text) {
    std::size_t size = std::min(text.size(), name.size() - 1);
    while (size < text.size() && size > 0 &&
           (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) {
        --size;
    }
    name = {};
    std::copy_n(text.begin(), size, name.begin());
}

// Over the last item, which began at `corner`. Not as its label, where ## would begin an
// identifier.
void write_name(const ImVec2& corner, std::string_view name) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PushClipRect(corner, ImGui::GetItemRectMax(), true);
    list.AddText(corner, ImGui::GetColorU32(ImGuiCol_Text), name.data(), name.data() + name.size());
    list.PopClipRect();
}

PanelActions draw_speed(const PanelContent& content) {
    const auto speed =
        number_row("Speed",
                   {.slider = {lowest_speed, highest_speed},
                    .decimals = 1,
                    .is_logarithmic = true,
                    .unit = "m/s",
                    .meaning = "Of the flight with W A S D and the arrows; shift is four times as "
                               "fast. Ctrl and the wheel change it, too."},
                   content.speed);
    return speed ? PanelActions{SetSpeed{*speed}} : PanelActions();
}

} // namespace

PanelActions BookmarkPanel::draw_new() {
    constexpr const char* add = "Add  (B)";
    PanelActions actions;
    ImGui::SetNextItemWidth(-width_of_button(add) - ImGui::GetStyle().ItemSpacing.x);
    bool is_added =
        ImGui::InputTextWithHint("##new", "name of this view", new_name_.data(), new_name_.size(),
                                 ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    is_added = ImGui::Button(add) || is_added;
    tip("Keeps this view; without a name it is \"view 1\", \"view 2\" and so on");
    if (is_added) {
        actions.emplace_back(AddBookmark{new_name_.data()});
        new_name_ = {};
    }
    return actions;
}

PanelActions BookmarkPanel::draw_name_field() {
    if (begins_renaming_) {
        ImGui::SetKeyboardFocusHere();
    }
    ImGui::SetNextItemWidth(-1.0F);
    const bool is_entered =
        ImGui::InputText("##other", other_name_.data(), other_name_.size(),
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    const bool is_left = !begins_renaming_ && ImGui::IsItemDeactivated();
    begins_renaming_ = false;
    PanelActions actions;
    if (is_entered && other_name_.front() != '\0') {
        actions.emplace_back(RenameBookmark{renamed_->bookmark, other_name_.data()});
    }
    if (is_entered || is_left) {
        renamed_.reset();
    }
    return actions;
}

PanelActions BookmarkPanel::draw_row(std::size_t row, const Bookmark& bookmark) {
    if (renamed_ && renamed_->row == row && renamed_->bookmark == bookmark) {
        return draw_name_field();
    }
    PanelActions actions;
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const float buttons = width_of_button(rename_label) + width_of_button(delete_label) + gap;
    const float width = std::max(ImGui::GetContentRegionAvail().x - buttons - gap, 1.0F);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    if (ImGui::Selectable("##go", false, 0, {width, 0.0F})) {
        actions.emplace_back(GoToBookmark{bookmark});
    }
    write_name(corner, bookmark.name);
    tip("Fly there: " + bookmark.name + ", " + bookmark.camera);
    ImGui::SameLine();
    if (ImGui::SmallButton(rename_label)) {
        renamed_ = {row, bookmark};
        set_name(other_name_, bookmark.name);
        begins_renaming_ = true;
    }
    ImGui::SameLine();
    if (ImGui::SmallButton(delete_label)) {
        actions.emplace_back(RemoveBookmark{bookmark});
    }
    return actions;
}

PanelActions BookmarkPanel::draw(const PanelContent& content, const Fonts& fonts) {
    const FontScope small(fonts.small);
    const BookmarkContent& bookmarks = content.bookmarks;
    PanelActions actions;
    section(fonts.heading, "Bookmarks");
    actions += draw_new();
    for (std::size_t i = 0; i < bookmarks.bookmarks.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        actions += draw_row(i, bookmarks.bookmarks[i]);
        ImGui::PopID();
    }
    if (bookmarks.bookmarks.empty()) {
        wrapped_muted_text("No bookmarks of this terrain so far.");
    } else if (wide_button("Fly to the next one  (N)")) {
        actions.emplace_back(PressKey{Key::n});
    }
    if (!bookmarks.note.empty()) {
        wrapped_muted_text(bookmarks.note);
    }
    section(fonts.heading, "Flight");
    actions += draw_speed(content);
    if (tick("Keep the height above ground  (G)", content.appearance.follows_ground)) {
        actions.emplace_back(PressKey{Key::g});
    }
    if (wide_button("Back to the first view  (R)")) {
        actions.emplace_back(PressKey{Key::r});
    }
    return actions;
}

} // namespace reljef::app

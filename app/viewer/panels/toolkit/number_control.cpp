#include "app/viewer/panels/toolkit/number_control.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <imgui_internal.h> // the text of a box that has lost the focus

#include "app/viewer/panels/toolkit/widgets.h"

namespace reljef::app {
namespace {

constexpr const char* box_label = "##box";
constexpr const char* typing_request = "##types"; // a key of the window's storage
constexpr float box_letters = 9.0F;
constexpr int shown_decimals = 3; // in the box, besides those of the slider

std::optional<double> number_in(std::string_view text) {
    text.remove_prefix(text.starts_with('+') ? 1 : 0);
    double value = 0.0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = code == std::errc{} && end == text.data() + text.size();
    return is_number && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

void number_tip(std::string_view meaning) {
    constexpr std::string_view typing = "Ctrl+click or double click: type a value. Enter sets it.";
    tip(meaning.empty() ? std::string(typing) : fmt::format("{}\n{}", meaning, typing));
}

double rounded(double value, std::optional<int> decimals) {
    const double parts = std::pow(10.0, decimals.value_or(0));
    return decimals ? std::round(value * parts) / parts : value;
}

// A number in the window's storage.
class KeptNumber {
public:
    explicit KeptNumber(const char* name) : name_(name) {}

    void set(std::optional<double> number) const {
        const Halves halves = halves_of(number);
        for (int i = 0; i < 2; ++i) {
            ImGui::GetStateStorage()->SetInt(key(i), halves.at(static_cast<std::size_t>(i)));
        }
    }
    [[nodiscard]] std::optional<double> get() const {
        const ImGuiStorage& storage = *ImGui::GetStateStorage();
        const Halves none = halves_of(std::nullopt);
        const auto number = std::bit_cast<double>(
            Halves{storage.GetInt(key(0), none[0]), storage.GetInt(key(1), none[1])});
        return std::isfinite(number) ? std::optional(number) : std::nullopt;
    }

private:
    using Halves = std::array<int, 2>;

    static Halves halves_of(std::optional<double> number) {
        return std::bit_cast<Halves>(number.value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    [[nodiscard]] ImGuiID key(int half) const {
        return ImGui::GetID(fmt::format("{} {}", name_, half).c_str());
    }

    const char* name_;
};

// Of an active box: once another box is clicked, ImGui has the text of that one only.
constexpr const char* number_of_box = "##typed";
// Of a slider before it was clicked.
constexpr const char* number_before = "##before";
constexpr const char* click_time = "##clicked"; // of that click, seconds

// Numbers that cannot be 0 are not shown as 0.
std::string box_text(const NumberControl& control, double value) {
    const int decimals = control.decimals.value_or(0);
    const bool is_small = control.typed.value_or(control.slider).begin > 0.0 && value > 0.0 &&
                          value < std::pow(10.0, -decimals);
    return is_small ? fmt::format("{:.6g}", value) : number_text(value, decimals + shown_decimals);
}

} // namespace

std::string number_text(double value, int decimals) {
    std::string text = fmt::format("{:.{}f}", value, std::max(decimals, 0));
    if (text.find('.') != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        text.erase(text.find_last_not_of('.') + 1);
    }
    return text == "-0" ? "0" : text;
}

float number_box_width() {
    return box_letters * ImGui::CalcTextSize("0").x + 2.0F * ImGui::GetStyle().FramePadding.x;
}

std::optional<double> number_box(const std::string& shown, float width, std::string_view meaning) {
    std::array<char, 40> buffer{};
    std::copy_n(shown.begin(), std::min(shown.size(), buffer.size() - 1), buffer.begin());
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const ImGuiID item = ImGui::GetID(box_label);
    const ImGuiID request = ImGui::GetID(typing_request);
    const bool was_active = ImGui::GetActiveID() == item;
    if (was_active) {
        storage.SetBool(request, false);
    } else if (storage.GetBool(request)) {
        ImGui::SetKeyboardFocusHere();
    }
    ImGui::SetNextItemWidth(width);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ImGui::GetStyle().FramePadding.x, 1.0F});
    const bool is_entered =
        ImGui::InputText(box_label, buffer.data(), buffer.size(),
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll |
                             ImGuiInputTextFlags_CharsScientific);
    ImGui::PopStyleVar();
    const bool is_left = ImGui::IsItemDeactivatedAfterEdit();
    number_tip(meaning);
    const ImGuiInputTextState* const edited = ImGui::GetInputTextState(item);
    if (edited != nullptr && ImGui::GetActiveID() == item) {
        KeptNumber(number_of_box).set(number_in(edited->TextA.Data));
    }
    if (!is_left) {
        return std::nullopt;
    }
    // What was clicked before the box is drawn took the focus already.
    if (!was_active && edited == nullptr) {
        return KeptNumber(number_of_box).get();
    }
    const std::string_view text = was_active ? buffer.data() : edited->TextA.Data;
    const bool is_given_up =
        !is_entered && (text == shown || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)));
    return is_given_up ? std::nullopt : number_in(text);
}

std::optional<double> number_slider(const NumberControl& control, double value) {
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const ImGuiID request = ImGui::GetID(typing_request);
    const ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput |
                                   (control.is_logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
    double moved = value;
    ImGui::SetNextItemWidth(-1.0F);
    const bool is_moved =
        ImGui::SliderScalar("##slider", ImGuiDataType_Double, &moved, &control.slider.begin,
                            &control.slider.end, "", flags);
    number_tip(control.meaning);
    const bool is_clicked = ImGui::IsItemHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Left);
    const bool is_double = is_clicked && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
    if (is_double || (is_clicked && ImGui::GetIO().KeyCtrl)) {
        storage.SetBool(request, true); // the box, in the next frame
    }
    const KeptNumber before(number_before);
    const KeptNumber clicked(click_time);
    // For ImGui a click beside the slider and one on it are a double click, too.
    const bool is_second = clicked.get() && ImGui::GetTime() - *clicked.get() <=
                                                double(ImGui::GetIO().MouseDoubleClickTime);
    if (is_double && is_second) {
        return before.get();
    }
    if (is_clicked) {
        before.set(value);
        clicked.set(ImGui::GetTime());
    }
    return is_moved && moved != value && !storage.GetBool(request)
               ? std::optional(rounded(moved, control.decimals))
               : std::nullopt;
}

std::optional<double> number_row(const char* name, const NumberControl& control, double value) {
    ImGui::PushID(name);
    const std::string unit(control.unit);
    const float gap = unit.empty() ? 0.0F : ImGui::GetStyle().ItemInnerSpacing.x;
    const float behind = gap + ImGui::CalcTextSize(unit.c_str()).x;
    const float at = ImGui::GetWindowContentRegionMax().x - number_box_width() - behind;
    muted_text(name);
    ImGui::SameLine(at);
    auto typed = number_box(box_text(control, value), number_box_width(), control.meaning);
    if (!unit.empty()) {
        ImGui::SameLine(0.0F, gap);
        muted_text(unit);
    }
    const auto moved = number_slider(control, value);
    ImGui::PopID();
    if (typed) {
        const Interval allowed = control.typed.value_or(control.slider);
        return std::clamp(*typed, allowed.begin, allowed.end);
    }
    return moved;
}

} // namespace reljef::app

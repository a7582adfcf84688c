#include "engine/io/image/texture_role.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <string>
#include <vector>

namespace reljef::io {
namespace {

bool is_letter(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

bool is_capital(char c) {
    return std::isupper(static_cast<unsigned char>(c)) != 0;
}

char small(char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

// In small letters.
std::vector<std::string> name_words(std::string_view stem) {
    std::vector<std::string> words;
    bool goes_on = false;
    for (std::size_t i = 0; i < stem.size(); ++i) {
        if (!is_letter(stem[i])) {
            goes_on = false;
            continue;
        }
        const bool begins = goes_on && is_capital(stem[i]) && !is_capital(stem[i - 1]);
        if (!goes_on || begins) {
            words.emplace_back();
        }
        words.back() += small(stem[i]);
        goes_on = true;
    }
    return words;
}

using Words = std::span<const std::string>;

bool is_one_of(std::string_view word, std::span<const std::string_view> known) {
    return std::find(known.begin(), known.end(), word) != known.end();
}

bool has_one_of(Words words, std::span<const std::string_view> known) {
    return std::any_of(words.begin(), words.end(),
                       [&](const std::string& word) { return is_one_of(word, known); });
}

constexpr std::array<std::string_view, 1> layer_words{"layers"};
constexpr std::array<std::string_view, 3> mask_words{"mask", "alpha", "opacity"};
constexpr std::array<std::string_view, 7> normal_words{"normal", "normals",   "norm",      "nor",
                                                       "nrm",    "normalmap", "normheight"};
constexpr std::array<std::string_view, 5> height_words{"height", "heights", "heightmap", "disp",
                                                       "displacement"};
constexpr std::array<std::string_view, 8> color_words{"color", "colour",  "col",      "clr",
                                                      "diff",  "diffuse", "diffspec", "albedo"};

// "sheet_back", "sheet_back_height", "height_back_1", but not "back_wall".
bool is_back(Words words) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        const bool is_last = i + 1 == words.size();
        if (words[i] == "back" && (is_last || is_one_of(words[i + 1], height_words) ||
                                   (i > 0 && is_one_of(words[i - 1], height_words)))) {
            return true;
        }
    }
    return false;
}

} // namespace

std::string_view to_string(TextureRole role) {
    constexpr std::array<std::string_view, 6> names{
        "colours", "heights", "normals", "layers", "heights of the back", "a mask"};
    return names[static_cast<std::size_t>(role)];
}

std::optional<TextureRole> texture_role(std::string_view stem) {
    const std::vector<std::string> words = name_words(stem);
    if (has_one_of(words, layer_words)) {
        return TextureRole::layers;
    }
    if (has_one_of(words, mask_words)) {
        return TextureRole::mask;
    }
    if (is_back(words)) {
        return TextureRole::back_heights;
    }
    if (has_one_of(words, normal_words)) {
        return TextureRole::normals;
    }
    if (has_one_of(words, height_words)) {
        return TextureRole::heights;
    }
    return has_one_of(words, color_words) ? std::optional(TextureRole::color) : std::nullopt;
}

} // namespace reljef::io

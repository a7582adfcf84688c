#pragma once

#include <algorithm>
#include <string>

namespace reljef::io {

/// A text whose ASCII capitals are small letters, such as an extension.
inline std::string lowercase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](char letter) {
        return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    });
    return text;
}

} // namespace reljef::io

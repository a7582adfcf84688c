#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

namespace reljef::io {

/// A text whose ASCII capitals are small letters, such as an extension.
inline std::string lowercase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](char letter) {
        return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    });
    return text;
}

/// Of a file's name, in small letters: ".tif" of a.TIF.
inline std::string extension_of(const std::filesystem::path& path) {
    return lowercase(path.extension().string());
}

} // namespace reljef::io

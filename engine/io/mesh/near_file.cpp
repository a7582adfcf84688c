#include "engine/io/mesh/near_file.h"

#include <algorithm>
#include <system_error>

namespace reljef::io {

bool is_file_below(const std::filesystem::path& folder, const std::filesystem::path& file) {
    std::error_code code;
    const std::filesystem::path top = std::filesystem::canonical(folder, code);
    if (code) {
        return false;
    }
    const std::filesystem::path real = std::filesystem::canonical(file, code);
    if (code || !std::filesystem::is_regular_file(real, code)) {
        return false;
    }
    return std::mismatch(top.begin(), top.end(), real.begin(), real.end()).first == top.end();
}

std::string extension_of(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) {
        return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    });
    return extension;
}

} // namespace reljef::io

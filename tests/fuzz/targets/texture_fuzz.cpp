// Texture sets. The first part of an input names files, a line each; the others are their contents.
#include <algorithm>

#include "engine/io/image/texture_files.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {
namespace {

// The next line, as the name of a file in a folder.
std::string next_name(std::string_view& lines) {
    const auto end = std::min(lines.find('\n'), lines.size());
    std::string name(lines.substr(0, end));
    lines.remove_prefix(std::min(end + 1, lines.size()));
    std::erase_if(name, [](char letter) { return letter == '/' || letter == '\0'; });
    constexpr std::size_t max_name = 64;
    name.resize(std::min(name.size(), max_name));
    return name == "." || name == ".." ? std::string() : name;
}

} // namespace

void texture_target(std::string_view input) {
    const InputFolder folder;
    const auto parts = parts_of(input);
    std::string_view names = parts.front();
    for (std::size_t i = 1; i < parts.size(); ++i) {
        if (const std::string name = next_name(names); !name.empty()) {
            static_cast<void>(folder.write(name, parts[i]));
        }
    }
    if (const auto files = io::find_texture_files(folder.path())) {
        static_cast<void>(io::read_texture_set(*files));
    }
}

} // namespace reljef::fuzz

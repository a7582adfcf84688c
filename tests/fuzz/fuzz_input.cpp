#include "tests/fuzz/fuzz_input.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace reljef::fuzz {
namespace fs = std::filesystem;

void expect(bool property, const char* what) {
    if (!property) {
        std::fprintf(stderr, "found: a property that does not hold: %s\n", what);
        throw Finding(what);
    }
}

std::vector<std::string_view> parts_of(std::string_view bytes) {
    constexpr std::string_view line = "\n----\n";
    std::vector<std::string_view> parts;
    for (auto end = bytes.find(line); end != std::string_view::npos; end = bytes.find(line)) {
        parts.push_back(bytes.substr(0, end));
        bytes.remove_prefix(end + line.size());
    }
    parts.push_back(bytes);
    return parts;
}

InputFolder::InputFolder() {
    std::string name = (fs::temp_directory_path() / "reljef-fuzz-XXXXXX").string();
    expect(::mkdtemp(name.data()) != nullptr, "a temporary folder");
    path_ = name;
}

InputFolder::~InputFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

fs::path InputFolder::write(std::string_view name, std::string_view bytes) const {
    fs::path path = path_ / name;
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    expect(file.flush().good(), "a file that can be written");
    return path;
}

fs::path write_as_kind(const InputFolder& folder, std::string_view input,
                       std::span<const FileKind> kinds) {
    const std::size_t index =
        input.empty() ? 0 : static_cast<unsigned char>(input.front() - 'a') % kinds.size();
    input.remove_prefix(input.empty() ? 0 : 1);
    const FileKind& kind = kinds[index];
    if (kind.sidecar.empty()) {
        return folder.write(kind.name, input);
    }
    const std::vector<std::string_view> parts = parts_of(input);
    static_cast<void>(folder.write(kind.sidecar, parts.size() > 1 ? parts[1] : std::string_view()));
    return folder.write(kind.name, parts.front());
}

} // namespace reljef::fuzz

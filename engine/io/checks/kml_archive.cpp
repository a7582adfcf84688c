#include "engine/io/checks/kml_archive.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include <cpl_vsi.h>
#include <fmt/format.h>

#include "engine/io/checks/little_endian.h"
#include "engine/io/checks/lowercase.h"
#include "engine/io/remote/read_scope.h"

namespace reljef::io {
namespace {

constexpr int max_members = 10'000;
constexpr std::size_t max_name = 255;
constexpr int max_folder_depth = 16;

using File = std::unique_ptr<VSILFILE, decltype(&VSIFCloseL)>;

File opened(const std::string& name) {
    return {VSIFOpenL(name.c_str(), "rb"), &VSIFCloseL};
}

std::string bytes_at(const File& file, vsi_l_offset first, std::size_t count) {
    std::string bytes(count, '\0');
    const bool found = VSIFSeekL(file.get(), first, SEEK_SET) == 0;
    bytes.resize(found ? VSIFReadL(bytes.data(), 1, count, file.get()) : 0);
    return bytes;
}

/// Whether the names of an archive's members are few and short. GDAL keeps one for each folder of
/// each member. `directory`: its central directory.
bool has_short_names(std::string_view directory, std::size_t members) {
    constexpr std::size_t head = 46;
    for (std::size_t i = 0; i < members; ++i) {
        if (directory.size() < head || !directory.starts_with("PK\1\2")) {
            return false;
        }
        const std::size_t name = little_endian(directory, 28, 2);
        const std::size_t length =
            head + name + little_endian(directory, 30, 2) + little_endian(directory, 32, 2);
        if (name > max_name || length > directory.size()) {
            return false;
        }
        directory.remove_prefix(length);
    }
    return true;
}

// ".ZIP File Format Specification" 6.3.10, 4.3.12 and 4.3.16. GDAL takes the last record of an end,
// too.
Result<void> check_members(const std::filesystem::path& path) {
    constexpr std::size_t end_bytes = 22;
    constexpr std::size_t max_end = end_bytes + 0xFFFF; // with a comment
    constexpr std::size_t max_directory = max_members * 1000;
    const File file = opened(path.string());
    std::error_code code;
    const std::uintmax_t size = std::filesystem::file_size(path, code);
    const std::size_t tail = std::min<std::uintmax_t>(code ? 0 : size, max_end);
    const std::string last = file != nullptr ? bytes_at(file, size - tail, tail) : std::string();
    const std::size_t end = last.rfind("PK\5\6");
    if (end == std::string::npos || last.size() - end < end_bytes) {
        return Error{fmt::format("{}: is no ZIP archive, a KMZ was expected", path.string())};
    }
    const std::size_t members = little_endian(last, end + 10, 2);
    const std::size_t bytes = little_endian(last, end + 12, 4);
    const std::uintmax_t end_place = size - tail + end;
    const bool is_small = members <= static_cast<std::size_t>(max_members) &&
                          bytes <= std::min<std::uintmax_t>(max_directory, end_place);
    if (!is_small || !has_short_names(bytes_at(file, end_place - bytes, bytes), members)) {
        return Error{fmt::format("{}: the names of its members are damaged, too many or too long: "
                                 "at most {} of {} bytes were expected",
                                 path.string(), max_members, max_name)};
    }
    return {};
}

/// Reads all of a file; archives may state less. Fails beyond `max_bytes`.
Result<void> check_length(const std::string& name, std::uintmax_t max_bytes,
                          const std::filesystem::path& path) {
    const File file = opened(name);
    std::array<char, 1 << 16> piece;
    std::uintmax_t bytes = 0;
    while (file != nullptr) {
        const std::size_t read = VSIFReadL(piece.data(), 1, piece.size(), file.get());
        bytes += read;
        if (read == 0) {
            break;
        }
        if (ReadScope::stop_requested()) {
            return Error{fmt::format("{}: reading was stopped", path.string())};
        }
        if (bytes > max_bytes) {
            return Error{fmt::format("{}: holds a KML of over {} bytes, a smaller one was expected",
                                     path.string(), max_bytes)};
        }
    }
    return {};
}

Result<std::string> find_kml(const std::filesystem::path& path) {
    const std::string archive = "/vsizip/{" + path.string() + "}";
    const std::unique_ptr<VSIDIR, decltype(&VSICloseDir)> folder(
        VSIOpenDir(archive.c_str(), max_folder_depth, nullptr), &VSICloseDir);
    std::string found;
    const VSIDIREntry* entry = nullptr;
    while (folder != nullptr && (entry = VSIGetNextDirEntry(folder.get())) != nullptr) {
        const std::string_view name = entry->pszName;
        const bool is_kml = !VSI_ISDIR(entry->nMode) && extension_of(name) == ".kml";
        if (is_kml && (found.empty() || name == "doc.kml")) {
            found = name;
        }
    }
    if (found.empty()) {
        return Error{fmt::format("{}: holds no KML, a KMZ with one was expected", path.string())};
    }
    return fmt::format("{}/{}", archive, found);
}

} // namespace

Result<std::string> vector_file_name(const std::filesystem::path& path, std::uintmax_t max_bytes) {
    if (extension_of(path) != ".kmz") {
        return path.string();
    }
    if (auto good = check_members(path); !good) {
        return good.error();
    }
    auto kml = find_kml(path);
    if (!kml) {
        return kml;
    }
    const auto good = check_length(*kml, max_bytes, path);
    return good ? std::move(kml) : good.error();
}

} // namespace reljef::io

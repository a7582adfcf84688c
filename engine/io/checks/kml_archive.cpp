#include "engine/io/checks/kml_archive.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
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

constexpr std::uintmax_t max_members = 10'000;
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

/// The list of an archive's members, as its end states it.
struct Directory {
    std::uintmax_t end = 0; ///< place in the file
    std::uintmax_t bytes = 0;
    std::uintmax_t members = 0;
};

bool is_flat(std::string_view name) {
    const auto separators = std::count_if(
        name.begin(), name.end(), [](char letter) { return letter == '/' || letter == '\\'; });
    return name.size() <= max_name && separators <= max_folder_depth;
}

/// Whether its names are few, short and flat. GDAL keeps one for each folder of each member.
/// ".ZIP File Format Specification" 6.3.10, 4.3.12.
bool has_short_names(const File& file, const Directory& directory) {
    constexpr std::size_t head = 46;
    constexpr std::uintmax_t max_directory = max_members * 1000;
    if (directory.members > max_members ||
        directory.bytes > std::min(max_directory, directory.end)) {
        return false;
    }
    const std::string bytes =
        bytes_at(file, directory.end - directory.bytes, static_cast<std::size_t>(directory.bytes));
    std::string_view left = bytes;
    for (std::uintmax_t i = 0; i < directory.members; ++i) {
        if (left.size() < head || !left.starts_with("PK\1\2")) {
            return false;
        }
        const std::size_t name = little_endian(left, 28, 2);
        const std::size_t length =
            head + name + little_endian(left, 30, 2) + little_endian(left, 32, 2);
        if (length > left.size() || !is_flat(left.substr(head, name))) {
            return false;
        }
        left.remove_prefix(length);
    }
    return true;
}

/// That of a file of over 4 GB, which others may have, too (4.3.14 and 4.3.15). GDAL looks for it
/// first. `tail`: the last bytes of the file.
std::optional<Directory> long_directory(const File& file, std::string_view tail) {
    constexpr std::size_t locator_bytes = 20;
    constexpr std::size_t record_bytes = 56;
    const std::size_t locator = tail.rfind("PK\6\7");
    if (locator == std::string_view::npos || tail.size() - locator < locator_bytes) {
        return std::nullopt;
    }
    const std::uintmax_t place = little_endian(tail, locator + 8, 8);
    const std::string record = bytes_at(file, place, record_bytes);
    if (record.size() < record_bytes || !record.starts_with("PK\6\6")) {
        return std::nullopt;
    }
    return Directory{place, little_endian(record, 40, 8), little_endian(record, 32, 8)};
}

/// 4.3.16. As to GDAL, the last end counts.
std::optional<Directory> short_directory(std::string_view tail, std::uintmax_t tail_place) {
    constexpr std::size_t end_bytes = 22;
    const std::size_t end = tail.rfind("PK\5\6");
    if (end == std::string_view::npos || tail.size() - end < end_bytes) {
        return std::nullopt;
    }
    return Directory{tail_place + end, little_endian(tail, end + 12, 4),
                     little_endian(tail, end + 10, 2)};
}

Result<void> check_members(const std::filesystem::path& path) {
    constexpr std::uintmax_t max_tail = 22 + 0xFFFF; // an end with a comment
    const File file = opened(path.string());
    std::error_code code;
    const std::uintmax_t size = std::filesystem::file_size(path, code);
    const std::uintmax_t tail = code || file == nullptr ? 0 : std::min(size, max_tail);
    const std::string last =
        tail > 0 ? bytes_at(file, size - tail, static_cast<std::size_t>(tail)) : std::string();
    const auto long_one = long_directory(file, last);
    const auto directory = long_one ? long_one : short_directory(last, size - tail);
    if (!directory) {
        return Error{fmt::format("{}: is no ZIP archive, a KMZ was expected", path.string())};
    }
    if (!has_short_names(file, *directory)) {
        return Error{
            fmt::format("{}: the names of its members are damaged, too many or too long: at "
                        "most {} of {} bytes, {} folders deep, were expected",
                        path.string(), max_members, max_name, max_folder_depth)};
    }
    return {};
}

/// How GDAL names an archive.
std::string archive_name(const std::filesystem::path& path) {
    const std::string name = path.string();
    return name.find_first_of("{}") == std::string::npos ? "/vsizip/{" + name + "}"
                                                         : "/vsizip/" + name;
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
    const std::string archive = archive_name(path);
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
        return Error{fmt::format("{}: holds no KML that can be read, a KMZ with one was expected",
                                 path.string())};
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

#include "engine/io/checks/zip_archive.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include <cpl_vsi.h>
#include <fmt/format.h>

#include "engine/io/checks/little_endian.h"
#include "engine/io/checks/lowercase.h"
#include "engine/io/remote/read_scope.h"

namespace reljef::io {
namespace {

constexpr std::string_view zip_system = "/vsizip/";
constexpr std::uintmax_t max_members = 10'000;
constexpr std::size_t max_name = 255;
constexpr int max_folder_depth = 16;

using File = std::unique_ptr<VSILFILE, decltype(&VSIFCloseL)>;

File opened(const std::string& name) {
    return {VSIFOpenL(name.c_str(), "rb"), &VSIFCloseL};
}

std::uintmax_t bytes_in(const std::string& name) {
    VSIStatBufL status{};
    return VSIStatL(name.c_str(), &status) == 0 ? static_cast<vsi_l_offset>(status.st_size) : 0;
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

/// Whether its names are few, short and flat. ".ZIP File Format Specification" 6.3.10, 4.3.12.
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

/// `archive`: a name for GDAL.
Result<void> check_archive(const std::string& archive) {
    constexpr std::uintmax_t max_tail = 22 + 0xFFFF; // an end with a comment
    const File file = opened(archive);
    const std::uintmax_t size = file == nullptr ? 0 : bytes_in(archive);
    const std::uintmax_t tail = std::min(size, max_tail);
    const std::string last =
        tail > 0 ? bytes_at(file, size - tail, static_cast<std::size_t>(tail)) : std::string();
    const auto long_one = long_directory(file, last);
    const auto directory = long_one ? long_one : short_directory(last, size - tail);
    if (!directory) {
        return Error{fmt::format("{}: is no ZIP archive, a whole one was expected", archive)};
    }
    if (!has_short_names(file, *directory)) {
        return Error{
            fmt::format("{}: the names of its members are damaged, too many or too long: at "
                        "most {} of {} bytes, {} folders deep, were expected",
                        archive, max_members, max_name, max_folder_depth)};
    }
    return {};
}

/// How GDAL names what is in an archive.
std::string archive_name(const std::string& archive) {
    return archive.find_first_of("{}") == std::string::npos
               ? fmt::format("{}{{{}}}", zip_system, archive)
               : fmt::format("{}{}", zip_system, archive);
}

/// Where "{a}/b" has the brace that closes the first.
std::size_t closing_brace(std::string_view text) {
    int depth = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        depth += text[i] == '{' ? 1 : text[i] == '}' ? -1 : 0;
        if (depth == 0) {
            return i;
        }
    }
    return text.size();
}

bool has_archive_extension(const std::string& name) {
    // Those by which GDAL finds archives in names without braces.
    constexpr std::array<std::string_view, 6> extensions{".zip", ".kmz",  ".dwf",
                                                         ".ods", ".xlsx", ".xlsm"};
    const std::string end = extension_of(name);
    return std::find(extensions.begin(), extensions.end(), end) != extensions.end();
}

/// The names of all files that GDAL may take for the archive of "a.zip/b.zip/c".
std::vector<std::string> possible_archives(std::string_view text) {
    if (text.starts_with('{')) {
        return {std::string(text.substr(1, closing_brace(text) - 1))};
    }
    std::vector<std::string> all;
    for (std::size_t at = 0; at < text.size();) {
        at = std::min(text.find_first_of("/\\", at + 1), text.size());
        std::string name(text.substr(0, at));
        if (has_archive_extension(name)) {
            all.push_back(std::move(name));
        }
    }
    return all;
}

} // namespace

Result<std::vector<ArchiveMember>> archive_members(const std::filesystem::path& path) {
    if (auto good = check_archive(path.string()); !good) {
        return good.error();
    }
    const std::string archive = archive_name(path.string());
    const std::unique_ptr<VSIDIR, decltype(&VSICloseDir)> folder(
        VSIOpenDir(archive.c_str(), max_folder_depth, nullptr), &VSICloseDir);
    std::vector<ArchiveMember> members;
    const VSIDIREntry* entry = nullptr;
    while (folder != nullptr && (entry = VSIGetNextDirEntry(folder.get())) != nullptr) {
        if (ReadScope::stop_requested()) {
            return Error{fmt::format("{}: reading was stopped", path.string())};
        }
        if (!VSI_ISDIR(entry->nMode)) {
            members.push_back({entry->pszName, fmt::format("{}/{}", archive, entry->pszName)});
        }
    }
    return members;
}

Result<void> check_archives_of(const std::string& name) { // NOLINT(misc-no-recursion)
    if (!name.starts_with(zip_system)) {
        return {};
    }
    for (const std::string& archive :
         possible_archives(std::string_view(name).substr(zip_system.size()))) {
        if (auto good = check_archives_of(archive); !good) {
            return good;
        }
        VSIStatBufL status{};
        const bool is_file = VSIStatL(archive.c_str(), &status) == 0 && !VSI_ISDIR(status.st_mode);
        if (auto good = is_file ? check_archive(archive) : Result<void>(); !good) {
            return good;
        }
    }
    return {};
}

} // namespace reljef::io

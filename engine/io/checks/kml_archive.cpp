#include "engine/io/checks/kml_archive.h"

#include <memory>

#include <cpl_vsi.h>
#include <fmt/format.h>

#include "engine/io/checks/lowercase.h"
#include "engine/io/remote/read_scope.h"

namespace reljef::io {
namespace {

constexpr int max_entries = 10'000;
constexpr int max_folder_depth = 16;

struct ArchiveEntry {
    std::string name;
    std::uintmax_t bytes = 0; ///< when decompressed
};

Result<ArchiveEntry> find_kml(const std::filesystem::path& path) {
    const std::string archive = "/vsizip/{" + path.string() + "}";
    const std::unique_ptr<VSIDIR, decltype(&VSICloseDir)> folder(
        VSIOpenDir(archive.c_str(), max_folder_depth, nullptr), &VSICloseDir);
    ArchiveEntry found;
    const VSIDIREntry* entry = nullptr;
    for (int i = 0; folder != nullptr && i < max_entries &&
                    (entry = VSIGetNextDirEntry(folder.get())) != nullptr;
         ++i) {
        if (ReadScope::stop_requested()) {
            return Error{fmt::format("{}: reading was stopped", path.string())};
        }
        const std::string_view name = entry->pszName;
        const bool is_kml = !VSI_ISDIR(entry->nMode) && extension_of(name) == ".kml";
        if (is_kml && (found.name.empty() || name == "doc.kml")) {
            found = {fmt::format("{}/{}", archive, name), entry->nSize};
        }
    }
    if (found.name.empty()) {
        return Error{fmt::format("{}: holds no KML among its first {} entries, a KMZ with one was "
                                 "expected",
                                 path.string(), max_entries)};
    }
    return found;
}

} // namespace

Result<std::string> name_of_lines(const std::filesystem::path& path, std::uintmax_t max_bytes) {
    if (extension_of(path) != ".kmz") {
        return path.string();
    }
    auto kml = find_kml(path);
    if (!kml) {
        return kml.error();
    }
    if (kml->bytes > max_bytes) {
        return Error{fmt::format("{}: holds a KML of {} bytes, one of at most {} was expected",
                                 path.string(), kml->bytes, max_bytes)};
    }
    return std::move(kml->name);
}

} // namespace reljef::io

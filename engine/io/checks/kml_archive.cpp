#include "engine/io/checks/kml_archive.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include <cpl_vsi.h>
#include <fmt/format.h>

#include "engine/io/checks/lowercase.h"
#include "engine/io/checks/zip_archive.h"
#include "engine/io/remote/read_scope.h"

namespace reljef::io {
namespace {

/// Reads all of a file; archives may state less. Fails beyond `max_bytes`.
Result<void> check_length(const std::string& name, std::uintmax_t max_bytes,
                          const std::filesystem::path& path) {
    const std::unique_ptr<VSILFILE, decltype(&VSIFCloseL)> file(VSIFOpenL(name.c_str(), "rb"),
                                                                &VSIFCloseL);
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
    auto members = archive_members(path);
    if (!members) {
        return members.error();
    }
    std::erase_if(*members,
                  [](const ArchiveMember& member) { return extension_of(member.path) != ".kml"; });
    if (members->empty()) {
        return Error{fmt::format("{}: holds no KML that can be read, a KMZ with one was expected",
                                 path.string())};
    }
    const auto main =
        std::find_if(members->begin(), members->end(),
                     [](const ArchiveMember& member) { return member.path == "doc.kml"; });
    return main != members->end() ? main->name : members->front().name;
}

} // namespace

Result<std::string> vector_file_name(const std::filesystem::path& path, std::uintmax_t max_bytes) {
    if (extension_of(path) != ".kmz") {
        return path.string();
    }
    auto kml = find_kml(path);
    if (!kml) {
        return kml;
    }
    const auto good = check_length(*kml, max_bytes, path);
    return good ? std::move(kml) : good.error();
}

} // namespace reljef::io

#include "engine/io/sidecar_files.h"

#include <algorithm>
#include <array>
#include <string>
#include <unordered_map>

#include <fmt/format.h>

#include "engine/io/cache/fnv_hash.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 18> side_extensions{
    ".xml", ".prj", ".hdr",  ".ovr", ".msk", ".tfw", ".wld", ".txt",     ".toml",
    ".md",  ".csv", ".json", ".gpx", ".kml", ".log", ".pdf", ".geojson", ".html"};
constexpr std::array<std::string_view, 18> raster_extensions{
    ".tif", ".tiff", ".vrt", ".hgt", ".dem", ".asc", ".dt0", ".dt1", ".dt2",
    ".img", ".bil",  ".ter", ".hf2", ".flt", ".adf", ".xyz", ".zip", ".gz"};

template <class List> bool holds(const List& list, std::string_view word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return text;
}

std::string lower_extension(const fs::path& path) {
    return lower(path.extension().string());
}

/// Checksums of what lies beside each other, by what its names begin with.
class Families {
public:
    void add(const IndexedFile& file) {
        const fs::path path = lower(file.path);
        const std::uint64_t hash =
            fnv_hash(fmt::format("{}\n{}\n{}\n", file.path, file.bytes, file.modified));
        if (path.extension() == ".adf") {
            add_to(grid_in(path), hash);
        } else if (!is_named_raster(path)) {
            add_by_name(path.string(), hash);
        }
    }
    [[nodiscard]] std::uint64_t of(const IndexedFile& file) const {
        const fs::path path = lower(file.path);
        const auto found =
            hashes_.find(path.extension() == ".adf" ? grid_in(path)
                                                    : fs::path(path).replace_extension().string());
        return found != hashes_.end() ? found->second : 0;
    }

private:
    static std::string grid_in(const fs::path& path) { return (path.parent_path() / "*").string(); }

    /// "sub/a.tif.ovr" belongs to "sub/a.tif" and to "sub/a".
    void add_by_name(const std::string& path, std::uint64_t hash) {
        const std::size_t name = path.find_last_of('/') + 1; // npos + 1 is 0
        for (auto end = path.find('.', name); end != std::string::npos;
             end = path.find('.', end + 1)) {
            add_to(path.substr(0, end), hash);
        }
        add_to(path, hash);
    }
    void add_to(const std::string& family, std::uint64_t hash) {
        std::uint64_t& all = hashes_.try_emplace(family, fnv_start).first->second;
        all = fnv_hash(fmt::format("{:x}", hash), all);
    }

    std::unordered_map<std::string, std::uint64_t> hashes_;
};

} // namespace

bool is_named_raster(const fs::path& path) {
    return holds(raster_extensions, lower_extension(path));
}

bool is_named_side_file(const fs::path& path) {
    return holds(side_extensions, lower_extension(path));
}

void set_beside(std::span<IndexedFile> files) {
    Families families;
    for (const IndexedFile& file : files) {
        families.add(file);
    }
    for (IndexedFile& file : files) {
        file.beside = families.of(file);
    }
}

} // namespace reljef::io

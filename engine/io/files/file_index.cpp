#include "engine/io/files/file_index.h"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <system_error>
#include <tuple>
#include <unordered_map>

#include <fmt/format.h>

#include "engine/core/parallel_for.h"
#include "engine/io/cache/cache_file.h"
#include "engine/io/cache/fnv_hash.h"
#include "engine/io/checks/lowercase.h"
#include "engine/io/raster/crs_transform.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/gdal_drivers.h"
#include "engine/io/raster/georeferencing.h"
#include "engine/io/raster/sample_decoder.h"
#include "engine/io/remote/read_scope.h"
#include "engine/terrain/tree/tile_tree.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_tiles = 1'000'000;
constexpr std::size_t max_index_bytes = std::size_t{1} << 30;

constexpr std::array<std::string_view, 18> side_extensions{
    ".xml", ".prj", ".hdr",  ".ovr", ".msk", ".tfw", ".wld", ".txt",     ".toml",
    ".md",  ".csv", ".json", ".gpx", ".kml", ".log", ".pdf", ".geojson", ".html"};
constexpr std::array<std::string_view, 18> raster_extensions{
    ".tif", ".tiff", ".vrt", ".hgt", ".dem", ".asc", ".dt0", ".dt1", ".dt2",
    ".img", ".bil",  ".ter", ".hf2", ".flt", ".adf", ".xyz", ".zip", ".gz"};

template <class List> bool has_extension_in(const List& extensions, const fs::path& path) {
    const std::string extension = extension_of(path);
    return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

/// By extension, even if the content is damaged.
bool is_named_raster(const fs::path& path) {
    return has_extension_in(raster_extensions, path);
}

/// Sidecar files and other files that are no rasters.
bool is_named_side_file(const fs::path& path) {
    return has_extension_in(side_extensions, path);
}

/// Checksums of sidecar files by the stem of their names.
class SidecarHashes {
public:
    void add(const IndexedFile& file) {
        const fs::path path = lowercase(file.path);
        const std::uint64_t hash =
            fnv_hash(fmt::format("{}\n{}\n{}\n", file.path, file.bytes, file.modified));
        if (path.extension() == ".adf") {
            add_to(grid_in(path), hash);
        } else if (!is_named_raster(path)) {
            add_by_name(path.string(), hash);
        }
    }
    [[nodiscard]] std::uint64_t of(const IndexedFile& file) const {
        const fs::path path = lowercase(file.path);
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

/// Sets `sidecar_hash` of all files. The sidecar files of "a.tif" are named "a.…" and are no
/// rasters ("a.prj", "a.tif.aux.xml"); those of an .adf are all .adf files of its folder. Ignores
/// case.
void set_sidecar_hashes(std::span<IndexedFile> files) {
    SidecarHashes families;
    for (const IndexedFile& file : files) {
        families.add(file);
    }
    for (IndexedFile& file : files) {
        file.sidecar_hash = families.of(file);
    }
}

bool may_be_raster(const fs::path& path) {
    if (is_named_side_file(path) || path.filename().string().starts_with('.')) {
        return false;
    }
    return is_named_raster(path) || has_format(path.string());
}

/// A file with its size and time only.
IndexedFile found_file(const fs::path& path, std::string name) {
    IndexedFile file;
    std::error_code ignored;
    file.path = std::move(name);
    file.bytes = fs::file_size(path, ignored);
    file.modified = fs::last_write_time(path, ignored).time_since_epoch().count();
    return file;
}

Result<std::vector<IndexedFile>> list_files(const fs::path& folder, const std::stop_token& stop) {
    std::vector<IndexedFile> files;
    std::error_code code;
    static_cast<void>(fs::directory_iterator(folder, code)); // the folder itself is not skipped
    fs::recursive_directory_iterator entry;
    if (!code) {
        entry = {folder, fs::directory_options::skip_permission_denied, code};
    }
    for (; !code && entry != fs::recursive_directory_iterator(); entry.increment(code)) {
        std::error_code gone;
        if (stop.stop_requested() || files.size() > max_tiles) {
            return Error{fmt::format("{}: reading was stopped", folder.string())};
        }
        if (entry->is_regular_file(gone)) {
            files.push_back(found_file(entry->path(),
                                       entry->path().lexically_relative(folder).generic_string()));
        }
    }
    if (code) {
        return Error{fmt::format("{}: cannot be read ({}), a folder of rasters was expected",
                                 folder.string(), code.message())};
    }
    std::sort(files.begin(), files.end(),
              [](const IndexedFile& a, const IndexedFile& b) { return a.path < b.path; });
    set_sidecar_hashes(files);
    return files;
}

/// A file's entry and the WKT of its coordinate system.
struct Described {
    IndexedFile file;
    std::string wkt;
    std::vector<std::string> notes; ///< of place_of()
    bool is_spacing_assumed = false;
};

Described with_error(Described described, std::string message) {
    described.file.use = FileKind::error;
    described.file.error = std::move(message);
    return described;
}

/// Of all samples, from the first one's corner; col runs east unless flipped, and row south.
geo::PixelAffine affine_on_plane(const Place& place) {
    const double x = place.flipped_cols ? -place.spacing.x : place.spacing.x;
    const double y = place.flipped_rows ? place.spacing.y : -place.spacing.y;
    return {0.0, x, 0.0, 0.0, 0.0, y};
}

/// Puts a raster on a plane, or returns why it cannot be put there.
std::string set_plane(GDALDataset& dataset, const std::string& name,
                      const std::optional<double>& spacing, Described& described) {
    RasterOptions options;
    options.spacing = spacing;
    const SampleGrid all{glm::dvec2(0.5), glm::dvec2(1.0), described.file.cols,
                         described.file.rows};
    const auto place = place_of(dataset, all, name, options, described.notes);
    if (!place) {
        return place.error().message;
    }
    described.is_spacing_assumed = place->spacing_assumed;
    described.file.crs_from_pixel = affine_on_plane(*place);
    described.wkt = plane_metres;
    return {};
}

/// Sets a tile's place, or returns why it cannot be a tile.
std::string set_place(GDALDataset& dataset, const std::string& name,
                      const FileIndexOptions& options, Described& described) {
    IndexedFile& file = described.file;
    if (file.cols < 2 || file.rows < 2) {
        return fmt::format("{}: has {}×{} samples, at least 2×2 were expected", name, file.cols,
                           file.rows);
    }
    if (std::max(file.cols, file.rows) > terrain::max_tree_samples) {
        return fmt::format("{}: has {}×{} samples, at most {} a side were expected", name,
                           file.cols, file.rows, terrain::max_tree_samples);
    }
    if (auto good = check_affine(dataset, name); !good) {
        return good.error().message;
    }
    std::vector<std::string> ignored;
    const auto affine = affine_of(dataset);
    const auto crs = affine ? horizontal_crs(dataset, ignored) : std::nullopt;
    if (options.allows_planes && (options.spacing || !crs || crs->IsLocal() != 0)) {
        return set_plane(dataset, name, options.spacing, described);
    }
    if (!crs || crs->IsLocal() != 0) {
        return name + ": names no place on Earth, a coordinate system and a position in it were "
                      "expected of a tile";
    }
    file.crs_from_pixel = *affine;
    described.wkt = wkt_of(*crs);
    return {};
}

Described describe_dataset(GDALDataset& dataset, const std::string& name,
                           const FileIndexOptions& options, Described described) {
    IndexedFile& file = described.file;
    file.opened = true;
    GDALRasterBand& band = *dataset.GetRasterBand(1);
    file.cols = dataset.GetRasterXSize();
    file.rows = dataset.GetRasterYSize();
    file.format = dataset.GetDriver()->GetDescription();
    file.type = GDALGetDataTypeName(band.GetRasterDataType());
    file.vertical_datum = vertical_datum_of(dataset);
    int declares = 0;
    band.GetNoDataValue(&declares);
    file.declares_voids = declares != 0;
    std::string error = set_place(dataset, name, options, described);
    if (kind_of_values(dataset) != ValueKind::plain) {
        file.use = FileKind::picture;
        file.error = std::move(error); // matters only if used as heights
        return described;
    }
    file.use = FileKind::heights;
    return error.empty() ? described : with_error(std::move(described), std::move(error));
}

Described describe_file(const fs::path& path, const FileIndexOptions& options, IndexedFile file) {
    Described described{std::move(file), {}, {}};
    const GdalMessages messages;
    const auto dataset = open_raster(path, messages);
    return dataset ? describe_dataset(**dataset, path.string(), options, std::move(described))
                   : with_error(std::move(described), dataset.error().message);
}

std::optional<Described> describe_if_raster(const fs::path& path, IndexedFile file) {
    const GdalMessages ignored_messages;
    return may_be_raster(path) ? std::optional(describe_file(path, {}, std::move(file)))
                               : std::nullopt;
}

/// Numbers the distinct WKTs.
FileIndex numbered(std::vector<std::optional<Described>> all) {
    FileIndex index;
    std::map<std::string, int> numbers;
    for (auto& described : all) {
        if (!described) {
            continue;
        }
        if (described->file.use == FileKind::heights) {
            const auto [entry, is_new] =
                numbers.try_emplace(described->wkt, static_cast<int>(index.crs.size()));
            if (is_new) {
                index.crs.push_back(described->wkt);
            }
            described->file.crs = entry->second;
        }
        index.files.push_back(std::move(described->file));
    }
    return index;
}

fs::path cache_file(const fs::path& folder, const FileIndexOptions& options) {
    std::error_code ignored;
    const std::string whole = fs::weakly_canonical(folder, ignored).string();
    return options.cache_folder / fmt::format("tiles-{:016x}.index", fnv_hash(whole));
}

std::string indexed_anew(const std::string& why) {
    return why + ": the source files are indexed anew";
}

FileIndex read_cache(const fs::path& file, std::vector<std::string>& notes) {
    const auto bytes = read_cache_file(file, max_index_bytes);
    if (!bytes) {
        notes.push_back(indexed_anew(bytes.error().message));
        return {};
    }
    if (!*bytes) {
        return {};
    }
    auto index = index_from_bytes(**bytes);
    if (!index) {
        notes.push_back(indexed_anew(file.string() + " " + index.error().message));
        return {};
    }
    return std::move(*index);
}

/// A failure only costs time on the next start.
Result<void> write_cache(const fs::path& file, const FileIndex& index) {
    const std::string bytes = bytes_of(index);
    return write_cache_file(file, {std::as_bytes(std::span(bytes))});
}

/// The entry of an unchanged file; absent for others.
std::optional<Described> find_unchanged(const FileIndex& index, const IndexedFile& now) {
    const auto found = std::lower_bound(
        index.files.begin(), index.files.end(), now.path,
        [](const IndexedFile& file, const std::string& path) { return file.path < path; });
    if (found == index.files.end() || found->path != now.path || !found->opened ||
        found->bytes != now.bytes || found->modified != now.modified ||
        found->sidecar_hash != now.sidecar_hash) {
        return std::nullopt;
    }
    const bool placed = found->use == FileKind::heights;
    return Described{*found, placed ? index.crs[static_cast<std::size_t>(found->crs)] : "", {}};
}

/// Whether two entries agree on what places a source file and decodes it.
bool is_same_file(const Described& a, const Described& b) {
    const auto key = [](const IndexedFile& file) {
        return std::tie(file.use, file.cols, file.rows, file.crs_from_pixel, file.declares_voids);
    };
    const bool is_placed = a.file.use == FileKind::heights;
    return key(a.file) == key(b.file) && a.file.error.empty() == b.file.error.empty() &&
           (!is_placed || is_same_crs(a.wkt, b.wkt));
}

/// Opens a few of the files whose entries are known, spread over all; `seed` chooses them. Whether
/// the entries are right; files that cannot be opened tell nothing.
bool are_right(const std::vector<std::optional<Described>>& known, const fs::path& folder,
               std::uint64_t seed) {
    constexpr std::size_t opened_files = 4;
    std::vector<const Described*> all;
    for (const auto& described : known) {
        if (described) {
            all.push_back(&*described);
        }
    }
    const std::size_t count = std::min(opened_files, all.size());
    const GdalMessages ignored_messages;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t first = i * all.size() / count;
        const std::size_t end = (i + 1) * all.size() / count;
        const Described& old = *all[first + fnv_hash(fmt::format("{}", i), seed) % (end - first)];
        IndexedFile file;
        file.path = old.file.path;
        const auto found = describe_if_raster(folder / old.file.path, std::move(file));
        if (found && found->file.opened && !is_same_file(*found, old)) {
            return false;
        }
    }
    return true;
}

Result<FileIndex> index_folder(const fs::path& folder, const FileIndexOptions& options,
                               std::vector<std::string>& notes) {
    auto files = list_files(folder, options.stop);
    if (!files) {
        return files.error();
    }
    const bool cached = !options.cache_folder.empty();
    const std::size_t notes_before = notes.size();
    const FileIndex old = cached ? read_cache(cache_file(folder, options), notes) : FileIndex{};
    std::vector<std::optional<Described>> all(files->size());
    std::transform(files->begin(), files->end(), all.begin(),
                   [&](const IndexedFile& file) { return find_unchanged(old, file); });
    // Chosen by the content: other files are opened once the index has changed.
    if (!are_right(all, folder, fnv_hash(bytes_of(old)))) {
        notes.push_back(
            indexed_anew(cache_file(folder, options).string() + " holds nonsense of the files"));
        std::fill(all.begin(), all.end(), std::nullopt);
    }
    const auto describe = [&](int i) {
        const ReadScope scope(options.stop);
        IndexedFile& file = (*files)[static_cast<std::size_t>(i)];
        auto& described = all[static_cast<std::size_t>(i)];
        if (!described) {
            const fs::path path = folder / file.path;
            described = describe_if_raster(path, std::move(file));
        }
    };
    if (!parallel_for(static_cast<int>(files->size()), describe,
                      {.threads = options.threads, .stop = options.stop, .progress = {}})) {
        return Error{fmt::format("{}: reading was stopped", folder.string())};
    }
    FileIndex index = numbered(std::move(all));
    if (cached && !(index == old)) {
        const auto written = write_cache(cache_file(folder, options), index);
        if (!written && notes.size() == notes_before) { // else a note names the cache already
            notes.push_back(written.error().message +
                            ": the source files are indexed anew at each start");
        }
    }
    return index;
}

} // namespace

Result<FileIndex> index_files(const fs::path& path, const FileIndexOptions& options,
                              std::vector<std::string>& notes) {
    register_drivers();
    const ReadScope scope(options.stop);
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
        return index_folder(path, options, notes);
    }
    Described only = describe_file(path, options, found_file(path, path.string()));
    if (!only.file.error.empty()) {
        return Error{only.file.error};
    }
    only.file.use = FileKind::heights; // the luminance of a single picture
    notes.insert(notes.end(), only.notes.begin(), only.notes.end());
    const bool is_spacing_assumed = only.is_spacing_assumed;
    FileIndex index = numbered({std::move(only)});
    index.is_spacing_assumed = is_spacing_assumed;
    return index;
}

} // namespace reljef::io

#include "engine/io/raster/references.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <string_view>
#include <system_error>
#include <vector>

#include <cpl_minixml.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>

#include "engine/io/raster/crs_transform.h"
#include "engine/io/raster/gdal_drivers.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 3> archive_systems{"/vsizip", "/vsigzip", "/vsitar"};
constexpr std::array<std::string_view, 1> server_systems{"/vsicurl"};
// GDAL's own readers, which have no deadline and no rule for redirects.
constexpr std::array<std::string_view, 3> cloud_systems{"/vsis3", "/vsigs", "/vsiaz"};

// 30,000 sources of half a kilobyte; GDAL's tree of the text takes ten times as much: 160 MB.
constexpr vsi_l_offset max_virtual_raster_bytes = vsi_l_offset{1} << 24U;
constexpr std::size_t identified_bytes = 1024; // GDAL looks for "<VRTDataset" in these

template <class List> bool is_in(const List& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// The virtual file systems that a name uses: "/vsizip" and "/vsicurl" of "/vsizip//vsicurl/a".
std::vector<std::string> systems_in(const std::string& name) {
    std::vector<std::string> systems;
    for (auto at = name.find("/vsi"); at != std::string::npos; at = name.find("/vsi", at + 1)) {
        const auto end =
            std::find_if(name.begin() + static_cast<std::ptrdiff_t>(at) + 1, name.end(),
                         [](unsigned char c) { return std::isalnum(c) == 0 && c != '_'; });
        systems.emplace_back(name.begin() + static_cast<std::ptrdiff_t>(at), end);
    }
    return systems;
}

bool is_virtual(const std::string& name) {
    return name.starts_with("/vsi");
}

/// What a file may refer to: everything in or below these folders.
class Scope {
public:
    explicit Scope(const std::string& name) : is_virtual_(is_virtual(name)) {
        if (is_virtual_) {
            base_ = fs::path(name).parent_path().lexically_normal();
            roots_ = {base_};
            return;
        }
        std::error_code ignored;
        const fs::path absolute = fs::absolute(name, ignored);
        base_ = fs::weakly_canonical(absolute, ignored).parent_path(); // a link's target, as GDAL
        roots_ = {base_, fs::weakly_canonical(absolute.parent_path(), ignored)};
    }

    [[nodiscard]] const fs::path& base() const { return base_; }

    [[nodiscard]] fs::path resolved(const std::string& text, bool is_relative_to_file) const {
        return is_relative_to_file ? base_ / text : fs::path(text);
    }

    /// Whether a name in the file, as GDAL resolves it, stays inside.
    [[nodiscard]] bool has(const std::string& text, bool is_relative_to_file) {
        const bool is_absolute = text.starts_with('/');
        // GDAL takes other names for the text of a file, or for a part of a file: "GTIFF_DIR:1:a".
        if (text.find('<') != std::string::npos ||
            (!is_absolute && text.find(':') != std::string::npos) ||
            (is_virtual(text) && !is_virtual_)) {
            return false;
        }
        std::error_code code;
        const fs::path path = is_relative_to_file ? base_ / text : fs::absolute(text, code);
        return !code && (is_virtual_ ? is_below(path.lexically_normal()) : is_file_below(path));
    }

private:
    [[nodiscard]] bool is_below(const fs::path& path) const {
        return std::any_of(roots_.begin(), roots_.end(), [&](const fs::path& root) {
            return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first ==
                   root.end();
        });
    }
    /// Follows links. Sources of a large raster share few folders. A pipe would block its reader.
    bool is_file_below(const fs::path& path) {
        std::error_code code;
        if (fs::is_other(path, code)) {
            return false;
        }
        if (path.filename() == ".." || path.filename() == "." || fs::is_symlink(path, code)) {
            const fs::path target = fs::weakly_canonical(path, code);
            return !code && is_below(target);
        }
        const auto [known, is_new] = known_folders_.try_emplace(path.parent_path(), false);
        if (is_new) {
            const fs::path folder = fs::weakly_canonical(path.parent_path(), code);
            known->second = !code && is_below(folder);
        }
        return known->second;
    }

    bool is_virtual_;
    fs::path base_;
    std::vector<fs::path> roots_;
    std::map<fs::path, bool> known_folders_;
};

Error outside(const std::string& name, const std::string& text, const Scope& scope) {
    return {fmt::format("{}: refers to {}, only files in or below {} were expected "
                        "(--allow-external lifts this)",
                        name, text, scope.base().string())};
}

/// Whether a coordinate system names a grid by the path of a file, which PROJ opens.
bool names_grid(const std::string& crs) {
    for (const std::string_view key : {"grids=", "PROJ4_GRIDS\",\""}) {
        for (auto at = crs.find(key); at != std::string::npos; at = crs.find(key, at + 1)) {
            const auto begin = at + key.size();
            const std::string grids = crs.substr(begin, crs.find_first_of(" \"", begin) - begin);
            if (grids.find_first_of("/\\~") != std::string::npos) {
                return true;
            }
        }
    }
    return false;
}

/// Whether GDAL takes the text for well-known text, a PROJ string without the path of a file, or
/// AUTHORITY:code. It takes other text for an address or the name of a file, which it reads.
bool is_plain_crs(const std::string& text) {
    constexpr std::array<std::string_view, 6> authorities{
        "EPSG:", "EPSGA:", "ESRI:", "OGC:", "IGNF:", "urn:ogc:def:"};
    constexpr std::array<std::string_view, 5> names{"", "WGS84", "WGS72", "NAD83", "NAD27"};
    const std::string crs = CPLString(text).Trim();
    if (names_grid(crs)) {
        return false;
    }
    const auto is_word = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
    const auto word_end = std::find_if_not(crs.begin(), crs.end(), is_word);
    const auto bracket =
        std::find_if(word_end, crs.end(), [](unsigned char c) { return std::isspace(c) == 0; });
    if (word_end != crs.begin() && bracket != crs.end() && (*bracket == '[' || *bracket == '(')) {
        return true;
    }
    const bool begins_well =
        (crs.starts_with('+') && crs.find("+init") == std::string::npos) || is_in(names, crs) ||
        std::any_of(authorities.begin(), authorities.end(), [&](std::string_view authority) {
            return EQUALN(crs.c_str(), authority.data(), authority.size());
        });
    return begins_well && crs.find('/') == std::string::npos;
}

Result<void> check_codes(GDALDataset& dataset) {
    for (const OGRSpatialReference* const crs :
         {dataset.GetSpatialRef(), dataset.GetGCPSpatialRef()}) {
        if (const auto code = crs != nullptr ? false_code_of(*crs) : std::nullopt) {
            return Error{fmt::format("{}: its coordinate system has the code {} of a geocentric "
                                     "one, its own or none was expected",
                                     dataset.GetDescription(), *code)};
        }
    }
    return {};
}

Error unknown_crs(const std::string& name, const std::string& text) {
    return {
        fmt::format("{}: has the coordinate system '{}', well-known text, a PROJ string without "
                    "files or AUTHORITY:code was expected (--allow-external lifts this)",
                    name, text.substr(0, 100))};
}

bool is_virtual_raster(const std::string& name) {
    const std::unique_ptr<VSILFILE, decltype(&VSIFCloseL)> file(VSIFOpenL(name.c_str(), "rb"),
                                                                &VSIFCloseL);
    std::string head(identified_bytes, '\0');
    head.resize(file != nullptr ? VSIFReadL(head.data(), 1, head.size(), file.get()) : 0);
    return head.find("<VRTDataset") != std::string::npos;
}

bool is_relative(const CPLXMLNode* node) {
    return std::atoi(CPLGetXMLValue(node, "relativeToVRT", "0")) != 0;
}

/// Walks the text of a virtual raster. GDAL's parser limits its depth to 1024.
class NameCheck {
public:
    explicit NameCheck(const std::string& name) : name_(name), scope_(name) {}

    Result<void> check(const CPLXMLNode* first) { // NOLINT(misc-no-recursion)
        for (const CPLXMLNode* node = first; node != nullptr; node = node->psNext) {
            const bool has_name = node->eType == CXT_Element || node->eType == CXT_Attribute;
            auto good = has_name ? check_node(node) : Result<void>();
            good = good ? check(node->psChild) : good;
            if (!good) {
                return good;
            }
        }
        return {};
    }

private:
    Result<void> check_node(const CPLXMLNode* node) {
        constexpr std::array names{"SourceFilename", "SourceDataset", "DEMPath"};
        constexpr std::array keys{"X_DATASET", "Y_DATASET", "OVERVIEW_FILE"};
        // They read the whole window of their source at once, whatever its size.
        constexpr std::array whole_windows{"AveragedSource", "KernelFilteredSource"};
        const char* const key = CPLGetXMLValue(node, "key", "");
        const auto equals = [](const char* word) {
            return [word](const char* other) { return EQUAL(word, other); };
        };
        if (auto good = check_class(CPLGetXMLValue(node, "subClass", "")); !good) {
            return good;
        }
        if (is_crs(node->pszValue) || is_crs(key) || is_crs(CPLGetXMLValue(node, "name", ""))) {
            const std::string crs = CPLGetXMLValue(node, "", "");
            return is_plain_crs(crs) ? Result<void>() : unknown_crs(name_, crs);
        }
        if (EQUAL(key, "ROOT_PATH")) { // of the names in another virtual raster
            return outside(name_, CPLGetXMLValue(node, "", ""), scope_);
        }
        if (std::any_of(whole_windows.begin(), whole_windows.end(), equals(node->pszValue))) {
            return Error{
                fmt::format("{}: has an {}, a SimpleSource or a ComplexSource was expected "
                            "(--allow-external lifts this)",
                            name_, node->pszValue)};
        }
        const bool is_name = std::any_of(names.begin(), names.end(), equals(node->pszValue)) ||
                             std::any_of(keys.begin(), keys.end(), equals(key));
        const std::string text = is_name ? CPLGetXMLValue(node, "", "") : "";
        return !is_name || scope_.has(text, is_relative(node)) ? Result<void>()
                                                               : outside(name_, text, scope_);
    }

    Result<void> check_class(const char* band_class) const {
        if (EQUAL(band_class, "VRTRawRasterBand")) {
            return Error{fmt::format("{}: describes raw bytes of a file, a file in a raster format "
                                     "was expected (--allow-external lifts this)",
                                     name_)};
        }
        if (EQUAL(band_class, "VRTDerivedRasterBand")) { // holds the samples of all sources at once
            return Error{fmt::format("{}: has a band that is computed from others, a band of a "
                                     "file was expected (--allow-external lifts this)",
                                     name_)};
        }
        return {};
    }
    /// Whether an element, an attribute or an option describes a coordinate system or operation.
    static bool is_crs(std::string_view word) {
        return word.ends_with("SRS") || word.ends_with("srs") || word == "Projection" ||
               word == "GCPProjection" || word == "COORDINATE_OPERATION";
    }

    const std::string& name_;
    Scope scope_;
};

struct WarpedSource {
    std::string name; ///< empty: none
    int sample_bytes = 0;
};

WarpedSource warped_source(const std::string& name, const CPLXMLNode* text) {
    const CPLXMLNode* const options = CPLGetXMLNode(text, "=VRTDataset.GDALWarpOptions");
    const CPLXMLNode* const source = CPLGetXMLNode(options, "SourceDataset");
    if (source == nullptr) {
        return {};
    }
    const char* const type = CPLGetXMLValue(options, "WorkingDataType", "Byte");
    return {Scope(name).resolved(CPLGetXMLValue(source, "", ""), is_relative(source)).string(),
            GDALGetDataTypeSizeBytes(GDALGetDataTypeByName(type))};
}

/// GDAL holds all samples of the source that a block needs at once. A file may place all of them
/// in one block.
Result<void> check_warp(const std::string& name, const WarpedSource& source) {
    const Dataset dataset(
        source.name.empty() ? nullptr : GDALDataset::Open(source.name.c_str(), GDAL_OF_RASTER));
    if (dataset == nullptr || dataset->GetRasterCount() == 0) {
        return {}; // nothing will be read
    }
    const int stored = GDALGetDataTypeSizeBytes(dataset->GetRasterBand(1)->GetRasterDataType());
    const double bytes = static_cast<double>(dataset->GetRasterXSize()) *
                         dataset->GetRasterYSize() * dataset->GetRasterCount() *
                         std::max(stored, source.sample_bytes);
    if (bytes > static_cast<double>(max_block_bytes)) {
        return Error{fmt::format("{}: reprojects a source of {}, which may be read at once, at "
                                 "most {} were expected (--allow-external lifts this)",
                                 name, size_text(bytes),
                                 size_text(static_cast<double>(max_block_bytes)))};
    }
    return {};
}

Result<void> check_virtual_raster(const std::string& name) {
    VSIStatBufL status{};
    if (VSIStatL(name.c_str(), &status) == 0 &&
        static_cast<vsi_l_offset>(status.st_size) > max_virtual_raster_bytes) {
        return Error{fmt::format("{}: is a virtual raster of {} bytes, at most {} were expected",
                                 name, status.st_size, max_virtual_raster_bytes)};
    }
    WarpedSource source;
    { // frees the text before a source is opened
        const CPLXMLTreeCloser text(CPLParseXMLFile(name.c_str()));
        if (auto good = NameCheck(name).check(text.get()); !good) {
            return good;
        }
        source = warped_source(name, text.get());
    }
    return check_warp(name, source);
}

/// The files beside a raster that formats may read with it.
std::vector<fs::path> sidecars(const fs::path& path) {
    std::vector<fs::path> all;
    for (const std::string extension :
         {".ovr", ".msk", ".aux.xml", ".aux", ".hdr", ".prj", ".tfw", ".wld",  ".rrd",  ".rdc",
          ".ref", ".smp", ".clr",     ".stx", ".sta", ".tab", ".ige", ".sgrd", ".mgrd", ".jgw",
          ".pgw", ".bpw", ".blw",     ".j2w", ".gfw", ".imd", ".rpb", ".xml"}) {
        for (const std::string& cased : {extension, std::string(CPLString(extension).toupper())}) {
            all.emplace_back(path.string() + cased);
            all.emplace_back(fs::path(path).replace_extension(cased));
        }
    }
    return all;
}

Result<void> check_sidecars(const std::string& name) {
    Scope scope(name);
    for (const fs::path& sidecar : sidecars(name)) {
        std::error_code ignored;
        if (fs::is_other(sidecar, ignored)) { // a pipe would block its reader
            return Error{fmt::format("{}: is no regular file, one was expected beside {}",
                                     sidecar.string(), name)};
        }
        if (fs::is_symlink(sidecar, ignored) &&
            !scope.has(fs::absolute(sidecar, ignored).string(), false)) {
            return outside(name, fs::read_symlink(sidecar, ignored).string(), scope);
        }
    }
    return {};
}

/// An Idrisi raster names the file of its coordinate system.
Result<void> check_idrisi(const std::string& name) {
    for (const char* const extension : {"rdc", "RDC"}) {
        const CPLStringList lines(
            CSLLoad2(CPLResetExtension(name.c_str(), extension), -1, -1, nullptr));
        for (int i = 0; i < lines.size(); ++i) {
            if (STARTS_WITH_CI(lines[i], "ref. system") &&
                std::strpbrk(lines[i], "/\\") != nullptr) {
                return unknown_crs(name, lines[i]);
            }
        }
    }
    return {};
}

} // namespace

bool is_on_server(const std::string& name) {
    const auto systems = systems_in(name);
    return is_virtual(name) &&
           std::any_of(systems.begin(), systems.end(), [](const std::string& system) {
               return is_in(server_systems, system) || is_in(cloud_systems, system);
           });
}

Result<void> check_typed_name(const std::string& name) {
    const auto systems = systems_in(name);
    const auto unknown =
        std::find_if(systems.begin(), systems.end(), [](const std::string& system) {
            return !is_in(archive_systems, system) && !is_in(server_systems, system) &&
                   !(allows_external() && is_in(cloud_systems, system));
        });
    if (is_virtual(name) && unknown != systems.end()) {
        return Error{
            fmt::format("{}: uses {}, one of {}, {} was expected{}", name, *unknown,
                        fmt::join(archive_systems, ", "), fmt::join(server_systems, ", "),
                        is_in(cloud_systems, *unknown) ? " (--allow-external lifts this)" : "")};
    }
    // GDAL's own reader takes "/vsicurl?url=".
    if (is_virtual(name) && name.find("/vsicurl?") != std::string::npos) {
        return Error{fmt::format("{}: uses /vsicurl?, /vsicurl/ was expected", name)};
    }
    if (name.find('<') != std::string::npos) {
        return Error{fmt::format("{}: its name holds '<', one without was expected", name)};
    }
    return {};
}

Result<void> check_references(const std::string& name) {
    if (allows_external() || is_on_server(name)) {
        return {};
    }
    if (!is_virtual(name)) {
        if (auto good = check_sidecars(name); !good) {
            return good;
        }
    }
    if (EQUAL(CPLGetExtension(name.c_str()), "rst")) {
        if (auto good = check_idrisi(name); !good) {
            return good;
        }
    }
    return is_virtual_raster(name) ? check_virtual_raster(name) : Result<void>();
}

Result<void> check_named_files(GDALDataset& dataset) {
    const std::string name = dataset.GetDescription();
    if (auto good = check_codes(dataset); !good) {
        return good;
    }
    if (allows_external()) {
        return {};
    }
    if (const std::string crs = dataset.GetProjectionRef(); names_grid(crs)) {
        return unknown_crs(name, crs);
    }
    constexpr std::array<std::array<const char*, 2>, 3> items{{{"OVERVIEW_FILE", "OVERVIEWS"},
                                                               {"X_DATASET", "GEOLOCATION"},
                                                               {"Y_DATASET", "GEOLOCATION"}}};
    for (const auto& [key, domain] : items) {
        const char* const text = dataset.GetMetadataItem(key, domain);
        if (text != nullptr && is_on_server(name)) {
            return Error{fmt::format("{}: refers to {}, one file without others was expected of a "
                                     "server (--allow-external lifts this)",
                                     name, text)};
        }
        if (text != nullptr) {
            Scope scope(name);
            if (!scope.has(text, false)) {
                return outside(name, text, scope);
            }
        }
    }
    const char* const crs = dataset.GetMetadataItem("SRS", "GEOLOCATION");
    return crs == nullptr || is_plain_crs(crs) ? Result<void>() : unknown_crs(name, crs);
}

Result<void> check_parts(GDALDataset& dataset) {
    const std::string name = dataset.GetDescription();
    if (allows_external()) {
        return {};
    }
    Scope scope(name);
    const CPLStringList files(dataset.GetFileList());
    for (int i = 0; i < files.size(); ++i) {
        if (!scope.has(files[i], false)) {
            return outside(name, files[i], scope);
        }
    }
    return {};
}

} // namespace reljef::io

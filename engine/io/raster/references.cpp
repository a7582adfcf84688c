#include "engine/io/raster/references.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
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

#include "engine/io/raster/gdal_drivers.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 3> archive_systems{"/vsizip", "/vsigzip", "/vsitar"};
constexpr std::array<std::string_view, 4> server_systems{"/vsicurl", "/vsis3", "/vsigs", "/vsiaz"};

// 60,000 sources of about a kilobyte; GDAL's tree of the text takes about ten times as much memory.
constexpr vsi_l_offset max_virtual_raster_bytes = vsi_l_offset{1} << 26U;
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

bool is_on_server(const std::string& name) {
    const auto systems = systems_in(name);
    return is_virtual(name) &&
           std::any_of(systems.begin(), systems.end(),
                       [](const std::string& system) { return is_in(server_systems, system); });
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
    /// Follows links. Sources of a large raster share few folders.
    bool is_file_below(const fs::path& path) {
        std::error_code code;
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
            auto good = node->eType == CXT_Element ? check_element(node) : Result<void>();
            good = good ? check(node->psChild) : good;
            if (!good) {
                return good;
            }
        }
        return {};
    }

private:
    Result<void> check_element(const CPLXMLNode* node) {
        constexpr std::array names{"SourceFilename", "SourceDataset", "DEMPath"};
        constexpr std::array keys{"X_DATASET", "Y_DATASET", "OVERVIEW_FILE"};
        const char* const key = CPLGetXMLValue(node, "key", "");
        const auto equals = [](const char* word) {
            return [word](const char* other) { return EQUAL(word, other); };
        };
        if (EQUAL(CPLGetXMLValue(node, "subClass", ""), "VRTRawRasterBand")) {
            return Error{fmt::format("{}: describes raw bytes of a file, a file in a raster format "
                                     "was expected (--allow-external lifts this)",
                                     name_)};
        }
        if (EQUAL(key, "ROOT_PATH")) { // of the names in another virtual raster
            return outside(name_, CPLGetXMLValue(node, "", ""), scope_);
        }
        const bool is_name = std::any_of(names.begin(), names.end(), equals(node->pszValue)) ||
                             std::any_of(keys.begin(), keys.end(), equals(key));
        const std::string text = is_name ? CPLGetXMLValue(node, "", "") : "";
        return !is_name || scope_.has(text, is_relative(node)) ? Result<void>()
                                                               : outside(name_, text, scope_);
    }

    const std::string& name_;
    Scope scope_;
};

/// GDAL warps block by block, and holds all samples of the source that a block may need at once:
/// about the block's share of the source.
Result<void> check_warp(const std::string& name, const CPLXMLNode* text) {
    const CPLXMLNode* const root = CPLGetXMLNode(text, "=VRTDataset");
    const CPLXMLNode* const source = CPLGetXMLNode(root, "GDALWarpOptions.SourceDataset");
    if (source == nullptr) {
        return {};
    }
    CPLStringList options; // the level of the source's overviews
    const CPLXMLNode* const list = CPLGetXMLNode(root, "GDALWarpOptions.OpenOptions");
    for (const CPLXMLNode* node = list != nullptr ? list->psChild : nullptr; node != nullptr;
         node = node->psNext) {
        options.SetNameValue(CPLGetXMLValue(node, "key", ""), CPLGetXMLValue(node, "", ""));
    }
    const Dataset dataset(GDALDataset::Open(
        Scope(name).resolved(CPLGetXMLValue(source, "", ""), is_relative(source)).c_str(),
        GDAL_OF_RASTER, nullptr, options.List()));
    if (dataset == nullptr || dataset->GetRasterCount() == 0) {
        return {}; // nothing will be read
    }
    const auto number = [root](const char* key, const char* otherwise) {
        return std::max(1.0, CPLAtof(CPLGetXMLValue(root, key, otherwise)));
    };
    const double share = std::min(1.0, number("BlockXSize", "512") / number("rasterXSize", "1")) *
                         std::min(1.0, number("BlockYSize", "128") / number("rasterYSize", "1"));
    const double samples =
        share * dataset->GetRasterXSize() * dataset->GetRasterYSize() * dataset->GetRasterCount();
    const double bytes =
        samples * GDALGetDataTypeSizeBytes(dataset->GetRasterBand(1)->GetRasterDataType());
    if (bytes > static_cast<double>(max_block_bytes)) {
        return Error{fmt::format("{}: reprojects {} of its source at once, at most {} were "
                                 "expected",
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
    const CPLXMLTreeCloser text(CPLParseXMLFile(name.c_str()));
    auto good = NameCheck(name).check(text.get());
    return good ? check_warp(name, text.get()) : good;
}

Result<void> check_sidecar_links(const std::string& name) {
    for (const char* const extension : {".ovr", ".msk", ".aux.xml"}) {
        const std::string sidecar = name + extension;
        std::error_code ignored;
        if (fs::is_symlink(sidecar, ignored)) {
            Scope scope(name);
            if (!scope.has(fs::absolute(sidecar, ignored).string(), false)) {
                return outside(name, fs::read_symlink(sidecar, ignored).string(), scope);
            }
        }
    }
    return {};
}

} // namespace

Result<void> check_typed_name(const std::string& name) {
    const auto systems = systems_in(name);
    const auto unknown =
        std::find_if(systems.begin(), systems.end(), [](const std::string& system) {
            return !is_in(archive_systems, system) && !is_in(server_systems, system);
        });
    if (is_virtual(name) && unknown != systems.end()) {
        return Error{fmt::format("{}: uses {}, one of {}, {} was expected", name, *unknown,
                                 fmt::join(archive_systems, ", "),
                                 fmt::join(server_systems, ", "))};
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
        if (auto good = check_sidecar_links(name); !good) {
            return good;
        }
    }
    return is_virtual_raster(name) ? check_virtual_raster(name) : Result<void>();
}

Result<void> check_named_files(GDALDataset& dataset) {
    const std::string name = dataset.GetDescription();
    if (allows_external() || is_on_server(name)) {
        return {};
    }
    constexpr std::array<std::array<const char*, 2>, 3> items{{{"OVERVIEW_FILE", "OVERVIEWS"},
                                                               {"X_DATASET", "GEOLOCATION"},
                                                               {"Y_DATASET", "GEOLOCATION"}}};
    for (const auto& [key, domain] : items) {
        const char* const text = dataset.GetMetadataItem(key, domain);
        if (text != nullptr) {
            Scope scope(name);
            if (!scope.has(text, false)) {
                return outside(name, text, scope);
            }
        }
    }
    return {};
}

Result<void> check_parts(GDALDataset& dataset) {
    const std::string name = dataset.GetDescription();
    if (allows_external() || is_on_server(name)) {
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

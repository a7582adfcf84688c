#include "engine/io/imagery/image_files.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/io/files/file_index.h"
#include "engine/io/imagery/rgb_image.h"
#include "engine/io/raster/sample_decoder.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

void add_folder(const fs::path& folder, std::vector<fs::path>& paths,
                std::vector<std::string>& errors) {
    std::vector<std::string> ignored;
    const auto index = index_files(folder, {}, ignored);
    if (!index) {
        errors.push_back(index.error().message);
        return;
    }
    const std::size_t before = paths.size();
    for (const IndexedFile& file : index->files) {
        if (file.use == FileKind::error) {
            errors.push_back(file.error);
        } else if (file.use == FileKind::picture || file.type == "Byte" || file.type == "UInt16") {
            paths.push_back(folder / file.path);
        }
    }
    if (paths.size() == before) {
        errors.push_back(
            fmt::format("{}: holds no image, at least one was expected", folder.string()));
    }
}

/// Fails for a single band of a type other than Byte and UInt16: it holds heights.
Result<void> check_is_image(const fs::path& path, GDALDataset& dataset) {
    const GDALDataType type = dataset.GetRasterBand(1)->GetRasterDataType();
    if (dataset.GetRasterCount() >= 3 || kind_of_values(dataset) != ValueKind::plain ||
        type == GDT_Byte || type == GDT_UInt16) {
        return {};
    }
    return Error{
        fmt::format("{}: holds {}, as heights are stored, an image (grey of Byte or UInt16, "
                    "palette or RGB(A)) was expected",
                    path.string(), GDALGetDataTypeName(type))};
}

} // namespace

ImageFiles image_files(std::span<const fs::path> names, std::vector<std::string>& errors,
                       const std::stop_token& stop, std::optional<double> white) {
    register_drivers();
    std::vector<fs::path> paths;
    for (const fs::path& name : names) {
        std::error_code ignored;
        if (fs::is_directory(name, ignored)) {
            add_folder(name, paths, errors);
        } else {
            paths.push_back(name);
        }
    }
    ImageFiles files;
    files.white = white.value_or(0.0);
    for (fs::path& path : paths) {
        if (stop.stop_requested()) {
            break;
        }
        const GdalMessages messages;
        const auto image = open_raster(path, messages);
        if (!image) {
            errors.push_back(image.error().message);
        } else if (auto good = check_is_image(path, **image); !good) {
            errors.push_back(good.error().message);
        } else {
            if (!white) {
                files.white = std::max(files.white, white_of(**image, stop));
            }
            files.paths.push_back(std::move(path));
        }
    }
    std::stable_sort(files.paths.begin(), files.paths.end(),
                     [](const fs::path& a, const fs::path& b) {
                         std::error_code ignored;
                         return fs::last_write_time(a, ignored) > fs::last_write_time(b, ignored);
                     });
    return files;
}

} // namespace reljef::io

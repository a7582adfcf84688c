#include "engine/io/texture_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/io/channels.h"
#include "engine/io/image.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

void take_heights(const Channels& channels, int channel, const TextureOptions& options,
                  terrain::TextureSet& set) {
    set.heights = channel_of(channels, channel);
    if (channels.bits == 8) {
        const double range = static_cast<double>(options.scale) * options.width;
        set.notes.push_back(
            fmt::format("{}: heights of 8 bits; over a range of {:.4g} m they come in steps of "
                        "{:.2g} m",
                        set.name, range, range / 255.0));
    }
}

glm::vec3 decoded_normal(const Channels& channels, int col, int row) {
    const glm::vec3 stored(channels.at(col, row, 0), channels.at(col, row, 1),
                           channels.at(col, row, 2));
    return 2.0F * stored - 1.0F;
}

// The two conventions differ in the sign of y, and files do not say which is theirs.
bool is_against_rows(const Grid<glm::vec3>& normals, const terrain::TextureSet& set,
                     terrain::TileBorder border) {
    const auto from_heights = terrain::tile_normals(set.heights.view(), set.scale, border);
    if (normals.cols() != from_heights.cols() || normals.rows() != from_heights.rows()) {
        return false;
    }
    double agreement = 0.0;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        agreement += static_cast<double>(normals.samples()[i].y) * from_heights.samples()[i].y;
    }
    return agreement < 0.0;
}

void take_normals(const Channels& channels, const TextureOptions& options,
                  terrain::TextureSet& set) {
    set.normals = Grid<glm::vec3>(channels.cols, channels.rows);
    for (int row = 0; row < channels.rows; ++row) {
        for (int col = 0; col < channels.cols; ++col) {
            set.normals(col, row) = decoded_normal(channels, col, row);
        }
    }
    if (!set.heights.empty() && is_against_rows(set.normals, set, options.border)) {
        for (glm::vec3& normal : set.normals.samples()) {
            normal.y = -normal.y;
        }
    }
}

Result<void> read_heights_and_normals(const TextureFiles& files, const TextureOptions& options,
                                      terrain::TextureSet& set) {
    std::optional<Channels> normals;
    if (!files.normals.empty()) {
        auto channels = read_channels(files.normals);
        if (!channels) {
            return channels.error();
        }
        normals = std::move(*channels);
        const int needed = files.heights.empty() ? 4 : 3;
        if (normals->count < needed) {
            return Error{fmt::format("{}: {} channels found, {} were expected: {}",
                                     files.normals.string(), normals->count, needed,
                                     needed == 4 ? "a normal and a height" : "a normal")};
        }
    }
    if (!files.heights.empty()) {
        const auto heights = read_channels(files.heights);
        if (!heights) {
            return heights.error();
        }
        take_heights(*heights, 0, options, set);
    } else if (normals) {
        take_heights(*normals, 3, options, set);
    }
    if (normals) {
        take_normals(*normals, options, set);
    }
    return {};
}

Result<void> read_layers(const fs::path& path, terrain::TextureSet& set) {
    const auto channels = read_channels(path);
    if (!channels) {
        return channels.error();
    }
    if (channels->count != 4) {
        return Error{fmt::format("{}: {} channels found, 4 were expected: the depths of the layers",
                                 path.string(), channels->count)};
    }
    Grid<glm::vec4> heights(channels->cols, channels->rows);
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            for (int layer = 0; layer < 4; ++layer) {
                heights(col, row)[layer] = 1.0F - channels->at(col, row, layer);
            }
        }
    }
    auto layers = terrain::LayerMap::create(std::move(heights));
    if (!layers) {
        return Error{fmt::format("{}: {} (a height is 1 less its depth)", path.string(),
                                 layers.error().message)};
    }
    set.layers = std::move(*layers);
    return {};
}

Result<void> punch_holes(const fs::path& path, terrain::TextureSet& set) {
    const auto mask = read_channels(path);
    if (!mask) {
        return mask.error();
    }
    if (mask->cols != set.heights.cols() || mask->rows != set.heights.rows()) {
        return Error{fmt::format("{}: {} x {} texels found, {} x {} were expected, as many as of "
                                 "the heights",
                                 path.string(), mask->cols, mask->rows, set.heights.cols(),
                                 set.heights.rows())};
    }
    for (int row = 0; row < mask->rows; ++row) {
        for (int col = 0; col < mask->cols; ++col) {
            set.heights(col, row) *= mask->at(col, row, 0) < 0.5F ? 0.0F : 1.0F;
        }
    }
    return {};
}

// What sheets and layers have besides.
Result<void> read_sides(const TextureFiles& files, terrain::TextureSet& set) {
    if (!files.layers.empty()) {
        if (auto read = read_layers(files.layers, set); !read) {
            return read;
        }
        if (set.heights.empty()) {
            set.heights = terrain::top_heights(*set.layers);
        }
    }
    if (!files.back_heights.empty()) {
        const auto back = read_channels(files.back_heights);
        if (!back) {
            return back.error();
        }
        set.back_heights = channel_of(*back, 0);
    }
    return files.mask.empty() || set.heights.empty() ? Result<void>()
                                                     : punch_holes(files.mask, set);
}

std::string lower_stem(const fs::path& file) {
    std::string stem = file.stem().string();
    std::transform(stem.begin(), stem.end(), stem.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return stem;
}

bool names_any(const std::string& stem, std::span<const std::string_view> words) {
    return std::any_of(words.begin(), words.end(),
                       [&](std::string_view word) { return stem.find(word) != std::string::npos; });
}

void sort_in(const fs::path& file, TextureFiles& files, std::vector<fs::path>& others) {
    constexpr std::array<std::string_view, 1> layer_words{"layers"};
    constexpr std::array<std::string_view, 3> mask_words{"mask", "alpha", "opacity"};
    constexpr std::array<std::string_view, 1> back_words{"back"};
    constexpr std::array<std::string_view, 1> normal_words{"norm"};
    constexpr std::array<std::string_view, 2> height_words{"height", "disp"};
    constexpr std::array<std::string_view, 4> color_words{"col", "clr", "diff", "albedo"};
    const std::string stem = lower_stem(file);
    if (names_any(stem, layer_words)) {
        files.layers = file;
    } else if (names_any(stem, mask_words)) {
        files.mask = file;
    } else if (names_any(stem, back_words)) {
        files.back_heights = file;
    } else if (names_any(stem, normal_words)) {
        files.normals = file;
    } else if (names_any(stem, height_words)) {
        files.heights = file;
    } else if (names_any(stem, color_words)) {
        files.color = file;
    } else {
        others.push_back(file);
    }
}

bool is_picture(const fs::path& file) {
    constexpr std::array<std::string_view, 9> extensions{".png", ".jpg", ".jpeg", ".bmp", ".dds",
                                                         ".tga", ".tif", ".tiff", ".exr"};
    return std::find(extensions.begin(), extensions.end(), file.extension()) != extensions.end();
}

Result<std::vector<fs::path>> pictures_in(const fs::path& folder) {
    std::error_code code;
    std::vector<fs::path> pictures;
    for (const auto& entry : fs::directory_iterator(folder, code)) {
        if (is_picture(entry.path())) {
            pictures.push_back(entry.path());
        }
    }
    if (code) {
        return Error{fmt::format("{}: cannot be read ({}), a folder of pictures was expected",
                                 folder.string(), code.message())};
    }
    std::sort(pictures.begin(), pictures.end());
    return pictures;
}

} // namespace

Result<TextureFiles> find_texture_files(const fs::path& folder) {
    const auto pictures = pictures_in(folder);
    if (!pictures) {
        return pictures.error();
    }
    TextureFiles files;
    std::vector<fs::path> others;
    for (const fs::path& file : *pictures) {
        sort_in(file, files, others);
    }
    if (files.color.empty() && others.size() == 1) {
        files.color = others.front();
    }
    const bool has_heights =
        !files.heights.empty() || !files.normals.empty() || !files.layers.empty();
    if (files.color.empty() || !has_heights) {
        return Error{fmt::format("{}: {} found among {} pictures, files of colours and of heights "
                                 "were expected, named so",
                                 folder.string(), files.color.empty() ? "no colours" : "no heights",
                                 pictures->size())};
    }
    return files;
}

Result<terrain::TextureSet> read_texture_set(const TextureFiles& files,
                                             const TextureOptions& options) {
    terrain::TextureSet set;
    set.name = files.color.parent_path().filename().string();
    set.scale = options.scale;
    auto color = read_image(files.color);
    if (!color) {
        return color.error();
    }
    set.color = std::move(*color);
    if (auto read = read_heights_and_normals(files, options, set); !read) {
        return read.error();
    }
    if (auto read = read_sides(files, set); !read) {
        return read.error();
    }
    return terrain::completed(std::move(set), options.border);
}

} // namespace reljef::io

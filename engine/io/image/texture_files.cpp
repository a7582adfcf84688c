#include "engine/io/image/texture_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "engine/io/checks/lowercase.h"
#include "engine/io/image/channels.h"
#include "engine/io/image/image.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

// At most one note per set.
void note_quantum(const Channels& channels, const TextureOptions& options,
                  material::ReliefMaterial& set) {
    if (channels.bits == 8 && set.notes.empty()) {
        const double range = static_cast<double>(options.scale) * options.width;
        set.notes.push_back(
            fmt::format("{}: heights of 8 bits; over a range of {:.4g} m they come in steps of "
                        "{:.2g} m",
                        set.name, range, range / 255.0));
    }
}

Result<void> take_heights(const Channels& channels, int channel, const fs::path& path,
                          const TextureOptions& options, material::ReliefMaterial& set) {
    auto heights = unit_channel(channels, channel, path);
    if (!heights) {
        return heights.error();
    }
    set.heights = std::move(*heights);
    note_quantum(channels, options, set);
    return {};
}

// Files do not declare the sign of y; the heights decide.
bool is_against_rows(const Grid<glm::vec3>& normals, const material::ReliefMaterial& set,
                     material::WrapMode border) {
    const auto from_heights = material::tile_normals(set.heights.view(), set.scale, border);
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
                  material::ReliefMaterial& set) {
    set.normals = decoded_normals(channels);
    if (!set.heights.empty() && is_against_rows(set.normals, set, options.border)) {
        for (glm::vec3& normal : set.normals.samples()) {
            normal.y = -normal.y;
        }
    }
}

// Needs a fourth channel if there is no other file of heights.
Result<Channels> read_normal_file(const TextureFiles& files) {
    auto normals = read_channels(files.normals);
    const int needed = files.heights.empty() ? 4 : 3;
    if (normals && normals->count < needed) {
        return Error{fmt::format("{}: {} channels found, {} were expected: {}",
                                 files.normals.string(), normals->count, needed,
                                 needed == 4 ? "a normal and a height" : "a normal")};
    }
    return normals;
}

Result<void> read_height_file(const TextureFiles& files, const TextureOptions& options,
                              material::ReliefMaterial& set) {
    const auto heights = read_channels(files.heights);
    return heights ? take_heights(*heights, 0, files.heights, options, set) : heights.error();
}

Result<void> read_heights_and_normals(const TextureFiles& files, const TextureOptions& options,
                                      material::ReliefMaterial& set) {
    if (files.normals.empty()) {
        return files.heights.empty() ? Result<void>() : read_height_file(files, options, set);
    }
    const auto normals = read_normal_file(files);
    if (!normals) {
        return normals.error();
    }
    auto taken = files.heights.empty() ? take_heights(*normals, 3, files.normals, options, set)
                                       : read_height_file(files, options, set);
    if (taken) {
        take_normals(*normals, options, set);
    }
    return taken;
}

Result<void> read_layers(const fs::path& path, material::ReliefMaterial& set) {
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
    auto layers = material::LayerMap::create(std::move(heights));
    if (!layers) {
        return Error{fmt::format("{}: {} (a height is 1 less its depth)", path.string(),
                                 layers.error().message)};
    }
    set.layers = std::move(*layers);
    return {};
}

Result<void> punch_holes(const fs::path& path, material::ReliefMaterial& set) {
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
    if (auto finite = check_finite(*mask, 1, path, "a mask"); !finite) {
        return finite;
    }
    for (int row = 0; row < mask->rows; ++row) {
        for (int col = 0; col < mask->cols; ++col) {
            set.heights(col, row) *= mask->at(col, row, 0) < 0.5F ? 0.0F : 1.0F;
        }
    }
    return {};
}

// Layers, back of a sheet and mask.
Result<void> read_sides(const TextureFiles& files, const TextureOptions& options,
                        material::ReliefMaterial& set) {
    if (!files.layers.empty()) {
        if (auto read = read_layers(files.layers, set); !read) {
            return read;
        }
        if (set.heights.empty()) {
            set.heights = material::top_heights(*set.layers);
        }
    }
    if (!files.back_heights.empty()) {
        const auto back = read_channels(files.back_heights);
        if (!back) {
            return back.error();
        }
        auto heights = unit_channel(*back, 0, files.back_heights);
        if (!heights) {
            return heights.error();
        }
        set.back_heights = std::move(*heights);
        note_quantum(*back, options, set);
    }
    return files.mask.empty() || set.heights.empty() ? Result<void>()
                                                     : punch_holes(files.mask, set);
}

bool is_letter(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

bool is_capital(char c) {
    return std::isupper(static_cast<unsigned char>(c)) != 0;
}

// Lower-case words. A word ends at a non-letter and before a capital after a small letter.
std::vector<std::string> name_words(std::string_view stem) {
    std::vector<std::string> words;
    char last = ' ';
    for (const char c : stem) {
        const bool starts_word = !is_letter(last) || (is_capital(c) && !is_capital(last));
        if (is_letter(c) && starts_word) {
            words.emplace_back();
        }
        if (is_letter(c)) {
            words.back() += c;
        }
        last = c;
    }
    std::transform(words.begin(), words.end(), words.begin(), lowercase);
    return words;
}

using Words = std::span<const std::string>;

bool is_one_of(std::string_view word, std::span<const std::string_view> known) {
    return std::find(known.begin(), known.end(), word) != known.end();
}

bool has_one_of(Words words, std::span<const std::string_view> known) {
    return std::any_of(words.begin(), words.end(),
                       [&](const std::string& word) { return is_one_of(word, known); });
}

constexpr std::array<std::string_view, 1> layer_words{"layers"};
constexpr std::array<std::string_view, 3> mask_words{"mask", "alpha", "opacity"};
constexpr std::array<std::string_view, 7> normal_words{"normal", "normals",   "norm",      "nor",
                                                       "nrm",    "normalmap", "normheight"};
constexpr std::array<std::string_view, 5> height_words{"height", "heights", "heightmap", "disp",
                                                       "displacement"};
constexpr std::array<std::string_view, 8> color_words{"color", "colour",  "col",      "clr",
                                                      "diff",  "diffuse", "diffspec", "albedo"};

// "sheet_back", "sheet_back_height", "height_back_1", but not "back_wall".
bool is_back(Words words) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        const bool is_last = i + 1 == words.size();
        if (words[i] == "back" && (is_last || is_one_of(words[i + 1], height_words) ||
                                   (i > 0 && is_one_of(words[i - 1], height_words)))) {
            return true;
        }
    }
    return false;
}

// By TextureRole.
constexpr std::array files_by_role{&TextureFiles::color,        &TextureFiles::heights,
                                   &TextureFiles::normals,      &TextureFiles::layers,
                                   &TextureFiles::back_heights, &TextureFiles::mask};

Result<void> sort_in(const fs::path& file, TextureFiles& files, std::vector<fs::path>& others) {
    const auto role = texture_role(file.stem().string());
    if (!role) {
        others.push_back(file);
        return {};
    }
    fs::path& place = files.*files_by_role[static_cast<std::size_t>(*role)];
    if (!place.empty()) {
        return Error{fmt::format("{}: {} and {} found, which both name {}, one was expected",
                                 file.parent_path().string(), place.filename().string(),
                                 file.filename().string(), to_string(*role))};
    }
    place = file;
    return {};
}

bool is_picture(const fs::path& file) {
    constexpr std::array<std::string_view, 9> extensions{".png", ".jpg", ".jpeg", ".bmp", ".dds",
                                                         ".tga", ".tif", ".tiff", ".exr"};
    return is_one_of(extension_of(file), extensions);
}

// Rejects floats that are not finite; 8-bit colours would hide them.
Result<Image> read_color(const fs::path& path) {
    auto image = read_image(path);
    if (!image) {
        return image;
    }
    const auto channels = read_channels(path);
    if (!channels) {
        return channels.error();
    }
    const auto finite = check_finite(*channels, 3, path, "a colour");
    return finite ? std::move(image) : finite.error();
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

std::string_view to_string(TextureRole role) {
    constexpr std::array<std::string_view, 6> names{
        "colours", "heights", "normals", "layers", "heights of the back", "a mask"};
    return names[static_cast<std::size_t>(role)];
}

std::optional<TextureRole> texture_role(std::string_view stem) {
    const std::vector<std::string> words = name_words(stem);
    if (has_one_of(words, layer_words)) {
        return TextureRole::layers;
    }
    if (has_one_of(words, mask_words)) {
        return TextureRole::mask;
    }
    if (is_back(words)) {
        return TextureRole::back_heights;
    }
    if (has_one_of(words, normal_words)) {
        return TextureRole::normals;
    }
    if (has_one_of(words, height_words)) {
        return TextureRole::heights;
    }
    return has_one_of(words, color_words) ? std::optional(TextureRole::color) : std::nullopt;
}

Result<TextureFiles> find_texture_files(const fs::path& folder) {
    const auto pictures = pictures_in(folder);
    if (!pictures) {
        return pictures.error();
    }
    TextureFiles files;
    std::vector<fs::path> others;
    for (const fs::path& file : *pictures) {
        if (auto sorted = sort_in(file, files, others); !sorted) {
            return sorted.error();
        }
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

Result<material::ReliefMaterial> read_texture_set(const TextureFiles& files,
                                                  const TextureOptions& options) {
    material::ReliefMaterial set;
    set.name = files.color.parent_path().filename().string();
    set.scale = options.scale;
    auto color = read_color(files.color);
    if (!color) {
        return color.error();
    }
    set.color = std::move(*color);
    if (auto read = read_heights_and_normals(files, options, set); !read) {
        return read.error();
    }
    if (auto read = read_sides(files, options, set); !read) {
        return read.error();
    }
    auto whole = material::completed(std::move(set), options.border);
    return whole ? std::move(whole)
                 : Error{fmt::format("{}: {}", files.color.parent_path().string(),
                                     whole.error().message)};
}

} // namespace reljef::io

#include "engine/io/image/sky_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "engine/io/checks/lowercase.h"
#include "engine/io/image/image.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;
using material::SkyFaces;

bool has_ratio(const Image& picture, double expected) {
    const double ratio = static_cast<double>(picture.cols()) / picture.rows();
    return std::abs(ratio / expected - 1.0) <= 0.01;
}

Image cut_out(const Image& picture, glm::ivec2 first, glm::ivec2 end) {
    Image part(end.x - first.x, end.y - first.y);
    for (int row = 0; row < part.rows(); ++row) {
        const auto from =
            picture.row(first.y + row)
                .subspan(static_cast<std::size_t>(first.x), static_cast<std::size_t>(part.cols()));
        std::copy(from.begin(), from.end(), part.row(row).begin());
    }
    return part;
}

// Columns and rows of the faces in a cross, in the order of SkyFaces::Face.
constexpr std::array<glm::ivec2, material::SkyPicture::face_count> places_in_cross{
    glm::ivec2(1, 1), glm::ivec2(2, 1), glm::ivec2(3, 1),
    glm::ivec2(0, 1), glm::ivec2(1, 0), glm::ivec2(1, 2)};

Image part_of_cross(const Image& picture, glm::ivec2 place) {
    const auto corner = [&](glm::ivec2 part) {
        return glm::ivec2(picture.cols() * part.x / 4, picture.rows() * part.y / 3);
    };
    return cut_out(picture, corner(place), corner(place + 1));
}

// Whether it has one colour: compression changes it a little.
bool is_even(const Image& picture) {
    constexpr int tolerance = 16; // of 255
    const Rgba8 first = picture(0, 0);
    return std::ranges::all_of(picture.samples(), [&](Rgba8 texel) {
        return std::abs(texel.r - first.r) <= tolerance &&
               std::abs(texel.g - first.g) <= tolerance && std::abs(texel.b - first.b) <= tolerance;
    });
}

// A photo of the same shape has content in its corners.
bool is_cross(const Image& picture) {
    constexpr double ratio = 4.0 / 3.0;
    return has_ratio(picture, ratio) && picture.rows() >= 3 &&
           std::ranges::all_of(std::array{0, 2, 3}, [&](int col) {
               return is_even(part_of_cross(picture, {col, 0})) &&
                      is_even(part_of_cross(picture, {col, 2}));
           });
}

SkyFaces faces_of_cross(const Image& picture) {
    SkyFaces faces;
    for (std::size_t i = 0; i < faces.pictures.size(); ++i) {
        faces.pictures[i] = part_of_cross(picture, places_in_cross[i]);
    }
    return faces;
}

struct FaceName {
    std::string_view word;
    std::string_view letters;
};
constexpr std::array<FaceName, material::SkyPicture::face_count> face_names{{{"front", "ft"},
                                                                             {"right", "rt"},
                                                                             {"back", "bk"},
                                                                             {"left", "lf"},
                                                                             {"up", "up"},
                                                                             {"down", "dn"}}};

// In small letters. No letter may stand before two letters: cup is not up.
bool names_face(const std::string& stem, const FaceName& face) {
    const auto ends_in = [&](std::string_view word) {
        const bool ends = stem.ends_with(word);
        const char before =
            ends && stem.size() > word.size() ? stem[stem.size() - word.size() - 1] : '_';
        return ends && (word.size() > 2 || before < 'a' || before > 'z');
    };
    return ends_in(face.word) || ends_in(face.letters);
}

// Visible files, by name.
std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code failed;
    for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end;
         entry.increment(failed)) {
        std::error_code ignored;
        if (entry->is_regular_file(ignored) &&
            !entry->path().filename().string().starts_with('.')) {
            files.push_back(entry->path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

Result<fs::path> face_file(const fs::path& folder, const std::vector<fs::path>& files,
                           const FaceName& face) {
    std::vector<fs::path> found;
    std::copy_if(files.begin(), files.end(), std::back_inserter(found), [&](const fs::path& file) {
        return names_face(lowercase(file.stem().string()), face);
    });
    if (found.empty()) {
        return Error{
            fmt::format("{}: no face {} found, files whose names end in front, right, back, "
                        "left, up and down (or _ft, _rt, _bk, _lf, _up, _dn) were expected",
                        folder.string(), face.word)};
    }
    if (found.size() > 1) {
        return Error{fmt::format("{}: {} and {} found, one face {} was expected", folder.string(),
                                 found[0].filename().string(), found[1].filename().string(),
                                 face.word)};
    }
    return found.front();
}

Result<material::SkyPicture> read_faces(const fs::path& folder, double turn) {
    const std::vector<fs::path> files = files_in(folder);
    SkyFaces faces;
    for (std::size_t i = 0; i < face_names.size(); ++i) {
        const auto file = face_file(folder, files, face_names[i]);
        if (!file) {
            return file.error();
        }
        auto picture = read_image(*file);
        if (!picture) {
            return picture.error();
        }
        if (!has_ratio(*picture, 1.0)) {
            return Error{
                fmt::format("{}: {} x {} pixels found, a square face of a sky was expected",
                            file->string(), picture->cols(), picture->rows())};
        }
        faces.pictures[i] = std::move(*picture);
    }
    return material::sky_from_faces(std::move(faces), turn);
}

} // namespace

Result<material::SkyPicture> read_sky(const fs::path& path, double turn) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
        return read_faces(path, turn);
    }
    const auto picture = read_image(path);
    if (!picture) {
        return picture.error();
    }
    constexpr double whole = 2.0;
    constexpr double dome = 4.0;
    if (has_ratio(*picture, whole) || has_ratio(*picture, dome)) {
        return material::sky_from_panorama(*picture, {turn, has_ratio(*picture, dome)});
    }
    if (is_cross(*picture)) {
        return material::sky_from_faces(faces_of_cross(*picture), turn);
    }
    return Error{
        fmt::format("{}: {} x {} pixels found, a sky was expected: all directions twice as "
                    "wide as high, the upper half four times, or a cross of six faces, 4:3, "
                    "with empty corners",
                    path.string(), picture->cols(), picture->rows())};
}

} // namespace reljef::io

#include "engine/material/sky_picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include "engine/core/check.h"
#include "engine/core/parallel_for.h"

namespace reljef::material {
namespace {

struct FacePlace {
    int face = 0;
    glm::dvec2 across{0.0}; // [-1, 1]
};

FacePlace place_of(glm::dvec3 direction) {
    const glm::dvec3 size = glm::abs(direction);
    int axis = size.x >= size.y ? 0 : 1;
    axis = size[axis] >= size.z ? axis : 2;
    const int first = axis == 0 ? 1 : 0;
    const int second = axis == 2 ? 1 : 2;
    return {2 * axis + (direction[axis] < 0.0 ? 1 : 0),
            glm::dvec2(direction[first], direction[second]) / size[axis]};
}

glm::dvec3 direction_of(const FacePlace& place) {
    const int axis = place.face / 2;
    glm::dvec3 direction(0.0);
    direction[axis] = place.face % 2 == 0 ? 1.0 : -1.0;
    direction[axis == 0 ? 1 : 0] = place.across.x;
    direction[axis == 2 ? 1 : 2] = place.across.y;
    return direction;
}

// Divides only outside.
int wrapped(int col, int cols) {
    return col >= 0 && col < cols ? col : (col % cols + cols) % cols;
}

// Middles of texels are at whole columns and rows.
glm::vec3 bilinear_color(const Image& picture, glm::dvec2 texel, bool wraps) {
    const glm::dvec2 low = glm::floor(texel);
    const glm::vec2 part(texel - low);
    const glm::ivec2 first(low);
    const int left = wraps ? wrapped(first.x, picture.cols()) : first.x;
    const int right = wraps ? wrapped(first.x + 1, picture.cols()) : first.x + 1;
    const auto line = [&](int row) {
        return glm::mix(linear_from_rgba8(picture.clamped(left, row)),
                        linear_from_rgba8(picture.clamped(right, row)), part.x);
    };
    return glm::mix(line(first.y), line(first.y + 1), part.y);
}

// `color(direction)` at the middles of all texels, also of the border.
template <class Color> SkyPicture::Level level_of(int side, const Color& color) {
    const int whole = side + 2 * SkyPicture::border;
    SkyPicture::Level level{side, Image(whole, SkyPicture::face_count * whole)};
    const auto fill = [&](int col, int row) {
        const glm::dvec2 texel(col - SkyPicture::border, row % whole - SkyPicture::border);
        level.faces(col, row) = rgba8_from_linear(color(row / whole, texel));
    };
    for_each_cell(whole, level.faces.rows(), {}, fill);
    return level;
}

glm::dvec3 direction_at(int face, glm::dvec2 texel, int side) {
    return direction_of({face, (2.0 * texel + 1.0) / double(side) - 1.0});
}

// The mean of four places in each texel.
SkyPicture::Level halved(const SkyPicture& sky, std::size_t finer, int side) {
    return level_of(side, [&](int face, glm::dvec2 texel) {
        glm::vec3 sum(0.0F);
        for (const glm::dvec2 part : {glm::dvec2(-0.25, -0.25), glm::dvec2(0.25, -0.25),
                                      glm::dvec2(-0.25, 0.25), glm::dvec2(0.25, 0.25)}) {
            sum += sky.color(direction_at(face, texel + part, side), finer);
        }
        return 0.25F * sum;
    });
}

glm::dvec3 direction_from(double azimuth, double altitude) {
    return {std::sin(azimuth) * std::cos(altitude), std::cos(azimuth) * std::cos(altitude),
            std::sin(altitude)};
}

// In the lowest three degrees.
glm::vec3 color_of_horizon(const SkyPicture& sky) {
    constexpr int azimuths = 90;
    glm::vec3 sum(0.0F);
    for (int col = 0; col < azimuths; ++col) {
        const double azimuth = 2.0 * std::numbers::pi * col / azimuths;
        for (const double altitude : {0.5, 1.5, 2.5}) {
            sum += sky.color(direction_from(azimuth, glm::radians(altitude)));
        }
    }
    return sum / (3.0F * azimuths);
}

glm::dvec3 turned_back(glm::dvec3 direction, double turn) {
    const double cosine = std::cos(glm::radians(turn));
    const double sine = std::sin(glm::radians(turn));
    return {cosine * direction.x - sine * direction.y, sine * direction.x + cosine * direction.y,
            direction.z};
}

// A face of that many texels has them as wide at its middle as a picture has at its own.
int side_for(double texels_a_radian) {
    return std::clamp(static_cast<int>(std::lround(2.0 * texels_a_radian)), 1,
                      SkyPicture::max_side);
}

// Means of two by two.
Image halved(const Image& fine) {
    Image coarse(std::max(fine.cols() / 2, 1), std::max(fine.rows() / 2, 1));
    for_each_cell(coarse.cols(), coarse.rows(), {}, [&](int col, int row) {
        glm::vec3 sum(0.0F);
        for (const int right : {0, 1}) {
            for (const int down : {0, 1}) {
                sum += linear_from_rgba8(fine.clamped(2 * col + right, 2 * row + down));
            }
        }
        coarse(col, row) = rgba8_from_linear(0.25F * sum);
    });
    return coarse;
}

// With texels that are not much narrower than those of the largest faces.
Image reduced(Image picture, double texels_a_radian) {
    constexpr double reach = 1.5; // of bilinear texels
    while (2.0 * texels_a_radian > reach * SkyPicture::max_side) {
        picture = halved(picture);
        texels_a_radian /= 2.0;
    }
    return picture;
}

// Columns get narrow towards the zenith and the nadir: the mean of those that a texel is as wide
// as.
glm::vec3 color_across(const Image& picture, glm::dvec2 texel, double columns) {
    constexpr double max_columns = 64.0;
    const int count = static_cast<int>(std::ceil(std::clamp(columns, 1.0, max_columns)));
    glm::vec3 sum(0.0F);
    for (int i = 0; i < count; ++i) {
        const double part = (i + 0.5) / count - 0.5;
        sum += bilinear_color(picture, texel + glm::dvec2(part * (columns - 1.0), 0.0), true);
    }
    return sum / static_cast<float>(count);
}

struct SeenFace {
    SkyFaces::Face face = SkyFaces::front;
    glm::dvec2 place{0.0}; // [-1, 1], to the right and down
};

SeenFace seen_face(glm::dvec3 to) {
    const glm::dvec3 size = glm::abs(to);
    if (size.z > std::max(size.x, size.y)) {
        return to.z > 0.0 ? SeenFace{SkyFaces::up, {to.x / size.z, to.y / size.z}}
                          : SeenFace{SkyFaces::down, {to.x / size.z, -to.y / size.z}};
    }
    if (size.y >= size.x) {
        return to.y > 0.0 ? SeenFace{SkyFaces::front, {to.x / size.y, -to.z / size.y}}
                          : SeenFace{SkyFaces::back, {-to.x / size.y, -to.z / size.y}};
    }
    return to.x > 0.0 ? SeenFace{SkyFaces::right, {-to.y / size.x, -to.z / size.x}}
                      : SeenFace{SkyFaces::left, {to.y / size.x, -to.z / size.x}};
}

} // namespace

SkyPicture::SkyPicture(int side, const ColorAt& color_at) {
    check(side >= 1 && side <= max_side, "a face of another side was expected");
    levels_.push_back(level_of(side, [&](int face, glm::dvec2 texel) {
        return color_at(direction_at(face, texel, side));
    }));
    while (levels_.back().side > 1) {
        const std::size_t finer = levels_.size() - 1;
        levels_.push_back(halved(*this, finer, levels_.back().side / 2));
    }
    horizon_ = color_of_horizon(*this);
}

std::size_t SkyPicture::level_for(double radians_a_pixel) const {
    const double texels = radians_a_pixel * levels_.front().side / 2.0;
    const double level = texels > 1.0 ? std::round(std::log2(texels)) : 0.0;
    return std::min(static_cast<std::size_t>(level), levels_.size() - 1);
}

glm::vec3 SkyPicture::color(glm::dvec3 direction, std::size_t level) const {
    const auto& [side, faces] = levels_[level];
    const FacePlace place = place_of(direction);
    const glm::dvec2 texel = 0.5 * (place.across + 1.0) * double(side) - 0.5 + double(border);
    return bilinear_color(faces, texel + glm::dvec2(0.0, place.face * (side + 2 * border)), false);
}

SkyPicture sky_from_panorama(const Image& whole, const SkyPlacement& placement) {
    const auto texels_a_radian = [](const Image& image) {
        return image.cols() / (2.0 * std::numbers::pi);
    };
    const Image picture = reduced(whole, texels_a_radian(whole));
    const glm::dvec2 size(picture.cols(), picture.rows());
    const double seen = placement.is_dome ? std::numbers::pi / 2.0
                                          : std::numbers::pi; // radians from the upper row on
    return {side_for(texels_a_radian(picture)), [&](glm::dvec3 direction) {
                const glm::dvec3 to = turned_back(glm::normalize(direction), placement.turn);
                const double azimuth = std::atan2(to.x, to.y);
                const double below_zenith = std::acos(std::clamp(to.z, -1.0, 1.0));
                const glm::dvec2 share(0.5 + azimuth / (2.0 * std::numbers::pi),
                                       std::min(below_zenith / seen, 1.0));
                const double level = std::hypot(to.x, to.y);
                const double columns = level * size.x > 1.0 ? 1.0 / level : size.x;
                return color_across(picture, share * size - 0.5, columns);
            }};
}

SkyPicture sky_from_faces(SkyFaces faces, double turn) {
    int widest = 1;
    for (Image& picture : faces.pictures) {
        const double texels_a_radian = picture.cols() / 2.0;
        picture = reduced(std::move(picture), texels_a_radian);
        widest = std::max(widest, picture.cols());
    }
    return {std::min(widest, SkyPicture::max_side), [&](glm::dvec3 direction) {
                const SeenFace seen = seen_face(turned_back(direction, turn));
                const Image& picture = faces.pictures[seen.face];
                const glm::dvec2 size(picture.cols(), picture.rows());
                return bilinear_color(picture, 0.5 * (seen.place + 1.0) * size - 0.5, false);
            }};
}

} // namespace reljef::material

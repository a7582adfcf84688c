#include "app/viewer/panels/toolkit/panel_rasterizer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "engine/core/check.h"

namespace reljef::app {
namespace {

using Texels = GridView<const std::uint8_t>;

constexpr std::int64_t subpixels = 256; // places are rounded to them, as software renderers do
constexpr std::int64_t half_pixel = subpixels / 2;

// Rounded down. Precondition: divisor > 0.
std::int64_t quotient(std::int64_t value, std::int64_t divisor) {
    return value >= 0 ? value / divisor : -((divisor - 1 - value) / divisor);
}

std::int64_t in_subpixels(float place) {
    constexpr int max = 1 << 28; // a million pixels
    return clamped_int(std::round(double(place) * double(subpixels)), -max, max);
}

// The first pixel whose centre is not before a place in subpixels.
int first_pixel(std::int64_t place) {
    constexpr std::int64_t max = 1 << 30; // beyond all pictures
    return static_cast<int>(std::clamp(quotient(place + half_pixel - 1, subpixels), -max, max));
}

// What is drawn: its colour, 0 to 255, and its place in the font atlas, texels.
struct Shade {
    glm::vec4 color{0.0F};
    glm::vec2 texel{0.0F};
};

Shade shade_of(const ImDrawVert& vertex, Texels letters) {
    const auto byte = [&](int shift) { return static_cast<float>(vertex.col >> shift & 0xFFU); };
    return {{byte(IM_COL32_R_SHIFT), byte(IM_COL32_G_SHIFT), byte(IM_COL32_B_SHIFT),
             byte(IM_COL32_A_SHIFT)},
            {vertex.uv.x * static_cast<float>(letters.cols()),
             vertex.uv.y * static_cast<float>(letters.rows())}};
}

// value / 255, rounded. Precondition: value <= 255 * 255.
unsigned share(unsigned value) {
    const unsigned raised = value + 128U;
    return (raised + (raised >> 8U)) >> 8U;
}

struct Ink {
    std::array<unsigned, 3> color{};
    unsigned alpha = 0;

    [[nodiscard]] Ink covering(unsigned coverage) const { return {color, share(alpha * coverage)}; }
};

Ink ink_of(const glm::vec4& color) {
    const auto byte = [](float value) {
        return static_cast<unsigned>(clamped_int(double(value) + 0.5, 0, 255));
    };
    return {{byte(color.r), byte(color.g), byte(color.b)}, byte(color.a)};
}

unsigned coverage_at(glm::vec2 texel, Texels letters) {
    return letters(clamped_int(texel.x, 0, letters.cols() - 1),
                   clamped_int(texel.y, 0, letters.rows() - 1));
}

void blend(const Ink& ink, Rgba8& below) {
    const unsigned rest = 255U - ink.alpha;
    const auto mixed = [&](unsigned color, unsigned under) {
        return static_cast<std::uint8_t>(share(color * ink.alpha + under * rest));
    };
    below = {mixed(ink.color[0], below.r), mixed(ink.color[1], below.g),
             mixed(ink.color[2], below.b), 255};
}

Ink ink_of(const Shade& shade, Texels letters) {
    return ink_of(shade.color).covering(coverage_at(shade.texel, letters));
}

void fill(std::span<Rgba8> pixels, const Ink& ink) {
    if (ink.alpha == 255U) {
        Rgba8 opaque;
        blend(ink, opaque);
        std::fill(pixels.begin(), pixels.end(), opaque);
    } else if (ink.alpha > 0) {
        for (Rgba8& pixel : pixels) {
            blend(ink, pixel);
        }
    }
}

struct Corner {
    glm::i64vec2 place{0}; // subpixels
    Shade shade;
};
using Corners = std::array<Corner, 3>;

// Twice the signed area, square subpixels.
std::int64_t area_of(const Corners& corners) {
    const glm::i64vec2 a = corners[1].place - corners[0].place;
    const glm::i64vec2 b = corners[2].place - corners[0].place;
    return a.x * b.y - a.y * b.x;
}

bool have_one_shade(const Corners& corners) {
    return std::ranges::all_of(corners, [&](const Corner& corner) {
        return corner.shade.color == corners[0].shade.color &&
               corner.shade.texel == corners[0].shade.texel;
    });
}

// At the centre of a pixel in the triangle, whose area is not 0.
Shade shade_at(glm::i64vec2 pixel, const Corners& corners) {
    const glm::i64vec2 centre = subpixels * pixel + half_pixel;
    Shade shade;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Corners part = corners;
        part.at(i).place = centre;
        const auto share = static_cast<float>(double(area_of(part)) / double(area_of(corners)));
        shade.color += share * corners.at(i).shade.color;
        shade.texel += share * corners.at(i).shade.texel;
    }
    return shade;
}

// What lies at the inner side of an edge: x by_x + y by_y + rest >= 0, subpixels.
struct Edge {
    std::int64_t by_x = 0;
    std::int64_t by_y = 0;
    std::int64_t rest = 0;

    // Of two triangles with a common edge, the one to its right or above has the pixels on it.
    Edge(glm::i64vec2 from, glm::i64vec2 to) : by_x(from.y - to.y), by_y(to.x - from.x) {
        const bool has_pixels = by_x > 0 || (by_x == 0 && by_y < 0);
        rest = -(by_x * from.x + by_y * from.y) - (has_pixels ? 0 : 1);
    }

    // Shortens a row of pixels, of which the first and the end are given, to those inside.
    void clip(int y, std::pair<int, int>& row) const {
        const std::int64_t value = by_y * (y * subpixels + half_pixel) + rest;
        if (by_x > 0) {
            row.first = std::max(row.first, first_pixel(-quotient(value, by_x)));
        } else if (by_x < 0) {
            row.second = std::min(row.second, first_pixel(quotient(value, -by_x) + 1));
        } else if (value < 0) {
            row.second = row.first;
        }
    }
};

// Draws into the pixels of a clip rectangle.
class Pen {
public:
    Pen(Texels letters, const PixelArea& clip, Image& picture)
        : letters_(letters), clip_(clip), picture_(picture) {}

    void draw(const ImDrawVert* vertices, std::span<const ImDrawIdx> indices) const {
        constexpr std::size_t corners = 3;
        for (std::size_t i = 0; i + corners <= indices.size();) {
            if (indices.size() - i >= 2 * corners &&
                draw_rectangle(vertices, indices.subspan(i).first<2 * corners>())) {
                i += 2 * corners;
            } else {
                draw_triangle(vertices, indices.subspan(i).first<corners>());
                i += corners;
            }
        }
    }

private:
    [[nodiscard]] bool is_outside(glm::vec2 low, glm::vec2 high) const {
        const glm::vec2 begin(clip_.low);
        const glm::vec2 end(clip_.high());
        return high.x < begin.x || high.y < begin.y || low.x > end.x || low.y > end.y;
    }

    // Two triangles as ImGui makes them of letters and areas with sides along the axes and one
    // colour. Returns false if they are others.
    bool draw_rectangle(const ImDrawVert* vertices, std::span<const ImDrawIdx, 6> indices) const {
        const ImDrawVert& low = vertices[indices[0]];
        const ImDrawVert& right = vertices[indices[1]];
        const ImDrawVert& high = vertices[indices[2]];
        const ImDrawVert& left = vertices[indices[5]];
        const bool is_rectangle =
            indices[3] == indices[0] && indices[4] == indices[2] && right.pos.x == high.pos.x &&
            right.pos.y == low.pos.y && left.pos.x == low.pos.x && left.pos.y == high.pos.y &&
            low.pos.x < high.pos.x && low.pos.y < high.pos.y && low.col == right.col &&
            low.col == high.col && low.col == left.col && right.uv.x == high.uv.x &&
            right.uv.y == low.uv.y && left.uv.x == low.uv.x && left.uv.y == high.uv.y;
        if (is_rectangle && !is_outside({low.pos.x, low.pos.y}, {high.pos.x, high.pos.y})) {
            fill_rectangle(low, high);
        }
        return is_rectangle;
    }

    void fill_rectangle(const ImDrawVert& low, const ImDrawVert& high) const {
        const Shade first = shade_of(low, letters_);
        const glm::vec2 size(high.pos.x - low.pos.x, high.pos.y - low.pos.y);
        const glm::vec2 step = (shade_of(high, letters_).texel - first.texel) / size;
        const int left = std::max(first_pixel(in_subpixels(low.pos.x)), clip_.low.x);
        const int right = std::min(first_pixel(in_subpixels(high.pos.x)), clip_.high().x);
        const int top = std::max(first_pixel(in_subpixels(low.pos.y) + 1), clip_.low.y);
        const int bottom = std::min(first_pixel(in_subpixels(high.pos.y) + 1), clip_.high().y);
        const Ink ink = ink_of(first.color);
        for (int y = top; y < bottom && left < right; ++y) {
            const auto row = pixels(y, left, right);
            if (step == glm::vec2(0.0F)) {
                fill(row, ink.covering(coverage_at(first.texel, letters_)));
                continue;
            }
            for (int x = left; x < right; ++x) {
                const glm::vec2 from_low = glm::vec2(x, y) + 0.5F - glm::vec2(low.pos.x, low.pos.y);
                const unsigned coverage = coverage_at(first.texel + from_low * step, letters_);
                if (coverage > 0) {
                    blend(ink.covering(coverage), row[static_cast<std::size_t>(x - left)]);
                }
            }
        }
    }

    void draw_triangle(const ImDrawVert* vertices, std::span<const ImDrawIdx, 3> indices) const {
        Corners corners;
        glm::vec2 low(1e9F);
        glm::vec2 high(-1e9F);
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const ImDrawVert& vertex = vertices[indices[i]];
            low = glm::min(low, glm::vec2(vertex.pos.x, vertex.pos.y));
            high = glm::max(high, glm::vec2(vertex.pos.x, vertex.pos.y));
            corners.at(i) = {{in_subpixels(vertex.pos.x), in_subpixels(vertex.pos.y)},
                             shade_of(vertex, letters_)};
        }
        const std::int64_t area = area_of(corners);
        if (area == 0 || is_outside(low, high)) {
            return;
        }
        if (area < 0) {
            std::swap(corners[1], corners[2]);
        }
        fill_triangle(corners, std::max(first_pixel(in_subpixels(low.y)), clip_.low.y),
                      std::min(first_pixel(in_subpixels(high.y)) + 1, clip_.high().y));
    }

    void fill_triangle(const Corners& corners, int top, int bottom) const {
        const std::array edges{Edge(corners[0].place, corners[1].place),
                               Edge(corners[1].place, corners[2].place),
                               Edge(corners[2].place, corners[0].place)};
        const bool is_constant = have_one_shade(corners);
        for (int y = top; y < bottom; ++y) {
            std::pair<int, int> row(clip_.low.x, clip_.high().x);
            for (const Edge& edge : edges) {
                edge.clip(y, row);
            }
            if (row.first >= row.second) {
                continue;
            }
            const auto inside = pixels(y, row.first, row.second);
            if (is_constant) {
                fill(inside, ink_of(corners[0].shade, letters_));
                continue;
            }
            for (int x = row.first; x < row.second; ++x) {
                blend(ink_of(shade_at({x, y}, corners), letters_),
                      inside[static_cast<std::size_t>(x - row.first)]);
            }
        }
    }

    [[nodiscard]] std::span<Rgba8> pixels(int y, int begin, int end) const {
        return picture_.row(y).subspan(static_cast<std::size_t>(begin),
                                       static_cast<std::size_t>(end - begin));
    }

    Texels letters_;
    PixelArea clip_;
    Image& picture_;
};

PixelArea common(const PixelArea& area, const ImVec4& clip) {
    const glm::ivec2 low = glm::max(area.low, glm::ivec2(glm::floor(glm::vec2(clip.x, clip.y))));
    const glm::ivec2 high =
        glm::min(area.high(), glm::ivec2(glm::floor(glm::vec2(clip.z, clip.w))));
    return {low, high - low};
}

} // namespace

void rasterize(const ImDrawData& panels, GridView<const std::uint8_t> letters,
               const PixelArea& area, Image& picture) {
    for (const ImDrawList* const list :
         std::span(panels.CmdLists, static_cast<std::size_t>(panels.CmdListsCount))) {
        for (const ImDrawCmd& command : list->CmdBuffer) {
            const PixelArea clip = common(area, command.ClipRect);
            if (!clip.is_empty()) {
                Pen(letters, clip, picture)
                    .draw(list->VtxBuffer.Data + command.VtxOffset,
                          {list->IdxBuffer.Data + command.IdxOffset, command.ElemCount});
            }
        }
    }
}

} // namespace reljef::app

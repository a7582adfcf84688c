#include "engine/material/relief_material.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "engine/material/normal_map.h"

namespace reljef::material {
namespace {

template <class T> std::string size_text(const Grid<T>& grid) {
    return fmt::format("{} x {}", grid.cols(), grid.rows());
}

std::optional<Error> error_of(const ReliefMaterial& set) {
    const auto error = [&](const std::string& found, const char* expected) {
        return Error{
            fmt::format("texture set {}: {} found, {} expected", set.name, found, expected)};
    };
    if (set.color.empty()) {
        return error("no colours", "a map of colours was");
    }
    if (set.heights.empty()) {
        return error("no heights", "a map of heights was");
    }
    if (!(std::isfinite(set.scale) && set.scale > 0.0F)) {
        return error(fmt::format("a scale of {}", set.scale), "a number above 0 was");
    }
    for (const Grid<float>* const heights : {&set.heights, &set.back_heights}) {
        for (const float height : heights->samples()) {
            if (!(height >= 0.0F && height <= 1.0F)) {
                return error(fmt::format("a height of {}", height), "heights in [0, 1] were");
            }
        }
    }
    if (!set.back_heights.empty() && size_text(set.back_heights) != size_text(set.heights)) {
        return error(fmt::format("heights of {} and of the back of {} texels",
                                 size_text(set.heights), size_text(set.back_heights)),
                     "one size was");
    }
    return std::nullopt;
}

void note_sizes(ReliefMaterial& set) {
    const auto note = [&](const char* what, const auto& map) {
        if (map.cols() != set.heights.cols() || map.rows() != set.heights.rows()) {
            set.notes.push_back(fmt::format("{}: {} of {} and heights of {} texels; each is used "
                                            "as it is",
                                            set.name, what, size_text(map),
                                            size_text(set.heights)));
        }
    };
    note("colours", set.color);
    note("normals", set.normals);
}

// Unit vectors in 8 bits have errors of a few hundredths.
bool is_normal(glm::vec3 normal) {
    constexpr float min_length = 0.5F;
    const float length = glm::length(normal);
    return length >= min_length && std::isfinite(length) && normal.z > 0.0F;
}

void repair_normals(ReliefMaterial& set) {
    std::size_t repaired = 0;
    std::size_t first = 0;
    for (std::size_t i = 0; i < set.normals.size(); ++i) {
        glm::vec3& normal = set.normals.samples()[i];
        const bool is_good = is_normal(normal);
        first = repaired == 0 && !is_good ? i : first;
        repaired += is_good ? 0U : 1U;
        normal = is_good ? glm::normalize(normal) : glm::vec3(0.0F, 0.0F, 1.0F);
    }
    if (repaired > 0) {
        const auto cols = static_cast<std::size_t>(set.normals.cols());
        set.notes.push_back(fmt::format("{}: {} of {} normals are zero or point into the surface, "
                                        "the first at column {}, row {}; they stand upright now",
                                        set.name, repaired, set.normals.size(), first % cols,
                                        first / cols));
    }
}

// Between the last and the first line. `at(line, i)` is a height.
template <class At> bool has_seam_along(int lines, int length, const At& at) {
    double within = 0.0;
    for (int line = 0; line + 1 < lines; ++line) {
        for (int i = 0; i < length; ++i) {
            within += std::abs(static_cast<double>(at(line, i)) - at(line + 1, i));
        }
    }
    double across = 0.0;
    for (int i = 0; i < length; ++i) {
        across += std::abs(static_cast<double>(at(lines - 1, i)) - at(0, i));
    }
    return lines > 1 && across * (lines - 1) > seam_limit * within;
}

} // namespace

Grid<glm::vec3> tile_normals(GridView<const float> heights, float scale, WrapMode border) {
    check(!heights.empty(), "normals of an empty tile");
    NormalOptions options;
    options.spacing =
        1.0 / (static_cast<double>(scale) * glm::dvec2(heights.cols(), heights.rows()));
    options.border = border;
    Grid<glm::vec3> normals = normals_from_heights(heights, options);
    for (glm::vec3& normal : normals.samples()) {
        normal.y = -normal.y; // v points south
    }
    return normals;
}

Grid<float> visible_heights(const Grid<float>& heights, bool from_behind) {
    Grid<float> seen = heights;
    if (from_behind) {
        for (float& height : seen.samples()) {
            height = 1.0F - height;
        }
    }
    return seen;
}

bool has_seam(GridView<const float> heights) {
    check(!heights.empty(), "seam of an empty tile");
    return has_seam_along(heights.cols(), heights.rows(),
                          [&](int line, int i) { return heights(line, i); }) ||
           has_seam_along(heights.rows(), heights.cols(),
                          [&](int line, int i) { return heights(i, line); });
}

Result<ReliefMaterial> completed(ReliefMaterial set, WrapMode border) {
    if (auto error = error_of(set)) {
        return *error;
    }
    if (set.normals.empty()) {
        set.normals = tile_normals(set.heights.view(), set.scale, border);
    }
    repair_normals(set);
    note_sizes(set);
    if (border == WrapMode::wrap && has_seam(set.heights.view())) {
        set.notes.push_back(fmt::format("{}: opposite borders do not fit together; where the tile "
                                        "repeats, a seam shows",
                                        set.name));
    }
    return set;
}

LayerMap layers_of(const ReliefMaterial& set, LayerKind kind) {
    switch (kind) {
    case LayerKind::symmetric:
        return symmetric_layers(set.heights.view());
    case LayerKind::dual: {
        const Grid<float> flat(set.heights.cols(), set.heights.rows(), 0.0F);
        const Grid<float>& back = set.back_heights.empty() ? flat : set.back_heights;
        return dual_layers(set.heights.view(), back.view()).value();
    }
    case LayerKind::multi:
        return set.layers ? *set.layers : filled_layers(set.heights.view());
    }
    abort_with("an unknown kind of layers");
}

} // namespace reljef::material

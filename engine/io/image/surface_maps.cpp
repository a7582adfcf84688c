#include "engine/io/image/surface_maps.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/io/image/image.h"
#include "engine/material/height_integration.h"
#include "engine/material/layer_map.h"
#include "engine/material/tile_cones.h"

namespace reljef::io {
namespace {

// Distance between texels, in units of the maximum height.
glm::dvec2 texel_spacing(const SurfaceMapOptions& options, int cols, int rows) {
    return 1.0 / (options.scale * glm::dvec2(cols, rows));
}

// Precondition: at least 3 channels.
bool is_grey(const Channels& channels) {
    const Grid<float> first = channel_of(channels, 0);
    return first == channel_of(channels, 1) && first == channel_of(channels, 2);
}

std::vector<std::string> notes_on(const SurfaceMapOptions& options, const std::string& file,
                                  const Channels& channels, const Grid<float>& heights) {
    std::vector<std::string> notes;
    if (channels.count >= 3 && !is_grey(channels)) {
        notes.push_back(fmt::format("{}: colours found, of which the first channel is taken for "
                                    "heights; --from normals or colors reads all",
                                    file));
    }
    if (channels.bits == 8) {
        notes.push_back(fmt::format("{}: heights of 8 bits; over a picture a metre wide, at "
                                    "--scale {}, they come in steps of {:.2g} m",
                                    file, options.scale, options.scale / 255.0));
    }
    if (options.border == material::WrapMode::wrap && material::has_seam(heights.view())) {
        notes.push_back(fmt::format("{}: opposite borders do not fit together; where the tile "
                                    "repeats, a seam shows",
                                    file));
    }
    return notes;
}

Result<PictureHeights> read_heights(const SurfaceMapOptions& options, const std::string& file) {
    const auto channels = read_channels(file);
    if (!channels) {
        return channels.error();
    }
    auto heights = unit_channel(*channels, 0, file);
    if (!heights) {
        return heights.error();
    }
    auto notes = notes_on(options, file, *channels, *heights);
    return PictureHeights{std::move(*heights), std::move(notes)};
}

// Reports invalid normals; integration replaces them with (0, 0, 1).
std::vector<std::string> notes_on(const std::string& file, const Grid<glm::vec3>& normals) {
    const auto is_bad = [](const glm::vec3& normal) {
        const float length = glm::length(normal);
        return !(length > 0.0F && std::isfinite(length) && normal.z > 0.0F);
    };
    const auto samples = normals.samples();
    const auto count = std::count_if(samples.begin(), samples.end(), is_bad);
    if (count == 0) {
        return {};
    }
    const auto first = std::find_if(samples.begin(), samples.end(), is_bad) - samples.begin();
    return {fmt::format("{}: {} of {} normals are zero or point into the surface, the first "
                        "at column {}, row {}; they stand upright now",
                        file, count, samples.size(), first % normals.cols(),
                        first / normals.cols())};
}

Result<Grid<glm::vec3>> read_normals(const std::string& file) {
    const auto channels = read_channels(file);
    if (!channels) {
        return channels.error();
    }
    if (channels->count < 3) {
        return Error{
            fmt::format("{}: {} channels found, 3 were expected: a normal", file, channels->count)};
    }
    return decoded_normals(*channels);
}

// Scales heights to [0,1]; constant heights become 0.
void spread_heights(Grid<float>& heights) {
    const auto samples = heights.samples();
    const auto [low, high] = std::minmax_element(samples.begin(), samples.end());
    const float lowest = *low;
    const float range = *high - lowest;
    for (float& height : samples) {
        height = range > 0.0F ? std::clamp((height - lowest) / range, 0.0F, 1.0F) : 0.0F;
    }
}

Result<PictureHeights> integrated(const SurfaceMapOptions& options, const std::string& file) {
    auto normals = read_normals(file);
    if (!normals) {
        return normals.error();
    }
    auto notes = notes_on(file, *normals);
    for (glm::vec3& normal : normals->samples()) {
        normal.y *= options.green_up ? 1.0F : -1.0F; // north is against the row order
    }
    material::IntegrationOptions integration;
    integration.spacing = texel_spacing(options, normals->cols(), normals->rows());
    integration.border = options.border;
    integration.stop = options.parallel.stop;
    auto made = material::heights_from_normals(normals->view(), integration);
    if (options.parallel.stop.stop_requested()) {
        return Error{"interrupted"};
    }
    spread_heights(made.heights);
    return PictureHeights{std::move(made.heights), std::move(notes)};
}

Channels height_channels(const Grid<float>& heights) {
    Channels channels = make_channels(heights.cols(), heights.rows(), 1);
    std::copy(heights.samples().begin(), heights.samples().end(), channels.values.begin());
    return channels;
}

// Normals as (n + 1) / 2; `combined` adds the heights.
Channels normal_channels(const SurfaceMapOptions& options, const Grid<float>& heights,
                         bool combined) {
    material::NormalOptions filter;
    filter.spacing = texel_spacing(options, heights.cols(), heights.rows());
    filter.border = options.border;
    filter.filter =
        options.sobel ? material::NormalFilter::sobel : material::NormalFilter::bilinear;
    const Grid<glm::vec3> normals = material::normals_from_heights(heights.view(), filter);
    Channels channels = make_channels(heights.cols(), heights.rows(), combined ? 4 : 3);
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            const glm::vec3 normal =
                normals(col, row) * glm::vec3(1.0F, options.green_up ? 1.0F : -1.0F, 1.0F);
            for (int i = 0; i < 3; ++i) {
                channels.at(col, row, i) = 0.5F + 0.5F * normal[i];
            }
            if (combined) {
                channels.at(col, row, 3) = heights(col, row);
            }
        }
    }
    return channels;
}

// Floats store ratios; integers store sqrt(ratio / widest cone), rounded down.
Channels cone_channels(const Grid<float>& cones, bool as_floats) {
    constexpr int highest = 65535;
    if (as_floats) {
        return height_channels(cones);
    }
    const auto codes = material::cone_codes(cones, material::max_cone_ratio, highest);
    Grid<float> shares(cones.cols(), cones.rows());
    std::transform(codes.samples().begin(), codes.samples().end(), shares.samples().begin(),
                   [](std::uint16_t code) { return static_cast<float>(code) / highest; });
    return height_channels(shares);
}

Result<Channels> made_cones(const Grid<float>& heights, material::ConeKind kind, bool as_floats,
                            const SurfaceMapOptions& options) {
    const Grid<float> field = material::cone_field(heights.view(), options.border);
    auto cones = material::cone_map(field.view(), kind, options.parallel);
    if (!cones) {
        return Error{"interrupted"};
    }
    const Grid<float> at_samples = material::cones_at_samples(*cones);
    const bool wraps = options.border == material::WrapMode::wrap;
    return cone_channels(
        wraps ? material::tile_cones(at_samples, heights.cols(), heights.rows(), options.border)
              : at_samples,
        as_floats);
}

Channels layer_channels(const Grid<float>& heights, const Grid<float>& back) {
    const auto layers = back.empty()
                            ? Result<material::LayerMap>(material::symmetric_layers(heights.view()))
                            : material::dual_layers(heights.view(), back.view());
    check(layers.has_value(), "a back of another size");
    Channels channels = make_channels(heights.cols(), heights.rows(), 4);
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            for (int i = 0; i < 4; ++i) {
                channels.at(col, row, i) = 1.0F - layers->heights()(col, row)[i];
            }
        }
    }
    return channels;
}

} // namespace

Result<PictureHeights> heights_of_picture(const std::filesystem::path& picture,
                                          const SurfaceMapOptions& options) {
    const std::string file = picture.string();
    if (options.input == MapInput::heights) {
        return read_heights(options, file);
    }
    if (options.input == MapInput::normals) {
        return integrated(options, file);
    }
    const auto image = read_image(picture);
    if (!image) {
        return image.error();
    }
    const auto channels = read_channels(picture);
    if (!channels) {
        return channels.error();
    }
    if (auto finite = check_finite(*channels, 3, file, "a colour"); !finite) {
        return finite.error();
    }
    return PictureHeights{material::heights_from_colors(
                              *image, {.octaves = options.octaves,
                                       .dark_is_high = options.dark_is_high,
                                       .wraps = options.border == material::WrapMode::wrap}),
                          {}};
}

Result<Channels> make_map(const Grid<float>& heights, MapKind kind, const Grid<float>& back,
                          bool as_floats, const SurfaceMapOptions& options) {
    switch (kind) {
    case MapKind::heights:
        return height_channels(heights);
    case MapKind::normals:
    case MapKind::combined:
        return normal_channels(options, heights, kind == MapKind::combined);
    case MapKind::cones:
        return made_cones(heights, material::ConeKind::plain, as_floats, options);
    case MapKind::relaxed_cones:
        return made_cones(heights, material::ConeKind::relaxed, as_floats, options);
    case MapKind::layers:
        return layer_channels(heights, back);
    }
    abort_with("an unknown kind of map");
}

} // namespace reljef::io

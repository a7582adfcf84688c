#include "app/surface_maps.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "app/cli/message.h"
#include "app/cli/progress_line.h"
#include "engine/io/image/image.h"
#include "engine/material/height_integration.h"
#include "engine/material/layer_map.h"
#include "engine/material/tile_cones.h"

namespace reljef::app {
namespace {

// Steps between texels, of a height of 1.
glm::dvec2 texel_spacing(const MapChoice& choice, int cols, int rows) {
    return 1.0 / (choice.scale * glm::dvec2(cols, rows));
}

void tell_note(const MapChoice& choice, const std::string& note) {
    if (!choice.quiet) {
        cli::tell(fmt::format("reljef: note: {}\n", note));
    }
}

bool is_grey(const io::Channels& channels) {
    for (int row = 0; row < channels.rows; ++row) {
        for (int col = 0; col < channels.cols; ++col) {
            for (int i = 1; i < std::min(channels.count, 3); ++i) {
                if (channels.at(col, row, i) != channels.at(col, row, 0)) {
                    return false;
                }
            }
        }
    }
    return true;
}

// What is known of a file of heights that are all in [0,1].
void tell_heights(const MapChoice& choice, const std::string& file, const io::Channels& channels,
                  const Grid<float>& heights) {
    if (channels.count >= 3 && !is_grey(channels)) {
        tell_note(choice, fmt::format("{}: colours found, of which the first channel is taken for "
                                      "heights; --from normals or colors reads all",
                                      file));
    }
    if (channels.bits == 8) {
        tell_note(choice, fmt::format("{}: heights of 8 bits; over a picture a metre wide, at "
                                      "--scale {}, they come in steps of {:.2g} m",
                                      file, choice.scale, choice.scale / 255.0));
    }
    if (choice.border == material::TileBorder::wrap && material::has_seam(heights.view())) {
        tell_note(choice, fmt::format("{}: opposite borders do not fit together; where the tile "
                                      "repeats, a seam shows",
                                      file));
    }
}

Result<Grid<float>> read_heights(const MapChoice& choice, const std::string& file) {
    const auto channels = io::read_channels(file);
    if (!channels) {
        return channels.error();
    }
    Grid<float> heights = io::channel_of(*channels, 0);
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            if (!(heights(col, row) >= 0.0F && heights(col, row) <= 1.0F)) {
                return Error{fmt::format("{}: a height of {} found at column {}, row {}, heights "
                                         "in [0, 1] were expected",
                                         file, heights(col, row), col, row)};
            }
        }
    }
    tell_heights(choice, file, *channels, heights);
    return heights;
}

// Zero, infinite or away from the surface: what is integrated as if it stood upright.
void tell_bad_normals(const MapChoice& choice, const Grid<glm::vec3>& normals) {
    const auto is_bad = [](const glm::vec3& normal) {
        const float length = glm::length(normal);
        return !(length > 0.0F && std::isfinite(length) && normal.z > 0.0F);
    };
    const auto samples = normals.samples();
    const auto count = std::count_if(samples.begin(), samples.end(), is_bad);
    if (count > 0) {
        const auto first = std::find_if(samples.begin(), samples.end(), is_bad) - samples.begin();
        tell_note(choice,
                  fmt::format("{}: {} of {} normals are zero or point into the surface, the first "
                              "at column {}, row {}; they stand upright now",
                              choice.picture, count, samples.size(), first % normals.cols(),
                              first / normals.cols()));
    }
}

// y as it is stored: along the rows. What is none stands upright.
Result<Grid<glm::vec3>> read_normals(const std::string& file) {
    const auto channels = io::read_channels(file);
    if (!channels) {
        return channels.error();
    }
    if (channels->count < 3) {
        return Error{
            fmt::format("{}: {} channels found, 3 were expected: a normal", file, channels->count)};
    }
    Grid<glm::vec3> normals(channels->cols, channels->rows);
    for (int row = 0; row < normals.rows(); ++row) {
        for (int col = 0; col < normals.cols(); ++col) {
            const glm::vec3 stored(channels->at(col, row, 0), channels->at(col, row, 1),
                                   channels->at(col, row, 2));
            normals(col, row) = 2.0F * stored - 1.0F;
        }
    }
    return normals;
}

// Lowest 0, highest 1; level ones 0.
void spread_heights(Grid<float>& heights) {
    const auto samples = heights.samples();
    const auto [low, high] = std::minmax_element(samples.begin(), samples.end());
    const float lowest = *low;
    const float range = *high - lowest;
    for (float& height : samples) {
        height = range > 0.0F ? std::clamp((height - lowest) / range, 0.0F, 1.0F) : 0.0F;
    }
}

Result<Grid<float>> integrated(const MapChoice& choice, const std::stop_token& stop) {
    auto normals = read_normals(choice.picture);
    if (!normals) {
        return normals.error();
    }
    tell_bad_normals(choice, *normals);
    for (glm::vec3& normal : normals->samples()) {
        normal.y *= choice.green_up ? 1.0F : -1.0F; // north is against the rows
    }
    material::IntegrationOptions options;
    options.spacing = texel_spacing(choice, normals->cols(), normals->rows());
    options.border = choice.border;
    options.stop = stop;
    auto made = material::heights_from_normals(normals->view(), options);
    if (stop.stop_requested()) {
        return Error{"interrupted"};
    }
    spread_heights(made.heights);
    return std::move(made.heights);
}

io::Channels height_channels(const Grid<float>& heights) {
    io::Channels channels = io::make_channels(heights.cols(), heights.rows(), 1);
    std::copy(heights.samples().begin(), heights.samples().end(), channels.values.begin());
    return channels;
}

// Normals as (n + 1) / 2, y along the rows or against them; and the heights.
io::Channels normal_channels(const MapChoice& choice, const Grid<float>& heights, bool combined) {
    material::NormalOptions options;
    options.spacing = texel_spacing(choice, heights.cols(), heights.rows());
    options.border = choice.border;
    options.filter =
        choice.sobel ? material::NormalFilter::sobel : material::NormalFilter::bilinear;
    const Grid<glm::vec3> normals = material::normals_from_heights(heights.view(), options);
    io::Channels channels = io::make_channels(heights.cols(), heights.rows(), combined ? 4 : 3);
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            const glm::vec3 normal =
                normals(col, row) * glm::vec3(1.0F, choice.green_up ? 1.0F : -1.0F, 1.0F);
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

// Floats hold the ratios, whole numbers the root of their share of the widest, rounded down.
io::Channels cone_channels(const Grid<float>& cones, const std::string& file) {
    constexpr int highest = 65535;
    if (file.ends_with(".exr")) {
        return height_channels(cones);
    }
    const auto codes = material::cone_codes(cones, material::widest_cone, highest);
    Grid<float> shares(cones.cols(), cones.rows());
    std::transform(codes.samples().begin(), codes.samples().end(), shares.samples().begin(),
                   [](std::uint16_t code) { return static_cast<float>(code) / highest; });
    return height_channels(shares);
}

Result<io::Channels> made_cones(const MapChoice& choice, const Grid<float>& heights,
                                const MapOutput& output, const std::stop_token& stop) {
    const bool relaxed = output.kind == MapKind::relaxed_cones;
    cli::ProgressLine line(relaxed ? "relaxed cones" : "cones", choice.quiet);
    material::ConeOptions options;
    options.parallel = {static_cast<unsigned>(choice.threads), stop, line.callback()};
    const Grid<float> field = material::cone_field(heights.view(), choice.border);
    auto cones = material::cone_map(
        field.view(), relaxed ? material::ConeKind::relaxed : material::ConeKind::plain, options);
    if (!cones) {
        return Error{"interrupted"};
    }
    const Grid<float> at_samples = material::cones_at_samples(*cones);
    return cone_channels(
        choice.border == material::TileBorder::wrap
            ? material::tile_cones(at_samples, heights.cols(), heights.rows(), choice.border)
            : at_samples,
        output.file);
}

// Depths of the layers of a sheet.
Result<io::Channels> layer_channels(const MapChoice& choice, const Grid<float>& heights) {
    material::LayerMap layers = material::symmetric_layers(heights.view());
    if (!choice.back.empty()) {
        const auto back = read_heights(choice, choice.back);
        if (!back) {
            return back.error();
        }
        auto both = material::dual_layers(heights.view(), back->view());
        if (!both) {
            return Error{fmt::format("--back: {}: {} x {} texels found, {} x {} were expected: one "
                                     "size, that of {}",
                                     choice.back, back->cols(), back->rows(), heights.cols(),
                                     heights.rows(), choice.picture)};
        }
        layers = std::move(*both);
    }
    io::Channels channels = io::make_channels(heights.cols(), heights.rows(), 4);
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            for (int i = 0; i < 4; ++i) {
                channels.at(col, row, i) = 1.0F - layers.heights()(col, row)[i];
            }
        }
    }
    return channels;
}

} // namespace

Result<Grid<float>> heights_of_picture(const MapChoice& choice, const std::stop_token& stop) {
    if (choice.input == MapInput::heights) {
        return read_heights(choice, choice.picture);
    }
    if (choice.input == MapInput::normals) {
        return integrated(choice, stop);
    }
    const auto picture = io::read_image(choice.picture);
    if (!picture) {
        return picture.error();
    }
    const auto channels = io::read_channels(choice.picture);
    if (!channels) {
        return channels.error();
    }
    if (auto finite = io::check_finite(*channels, 3, choice.picture, "a colour"); !finite) {
        return finite.error();
    }
    return material::heights_from_colors(*picture,
                                         {.octaves = choice.octaves,
                                          .dark_is_high = choice.dark_is_high,
                                          .wraps = choice.border == material::TileBorder::wrap});
}

Result<io::Channels> make_map(const MapChoice& choice, const Grid<float>& heights,
                              const MapOutput& output, const std::stop_token& stop) {
    switch (output.kind) {
    case MapKind::heights:
        return height_channels(heights);
    case MapKind::normals:
    case MapKind::combined:
        return normal_channels(choice, heights, output.kind == MapKind::combined);
    case MapKind::cones:
    case MapKind::relaxed_cones:
        return made_cones(choice, heights, output, stop);
    case MapKind::layers:
        return layer_channels(choice, heights);
    }
    abort_with("an unknown kind of map");
}

} // namespace reljef::app

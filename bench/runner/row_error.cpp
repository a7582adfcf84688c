#include "bench/runner/row_error.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/truth/image_error.h"

namespace reljef::bench {
namespace {

struct ShownFrame {
    HitBuffer hits;
    Image image;
};

Result<ShownFrame> draw_shown(const scene::Scene& scene, session::SceneRenderer& driver) {
    const auto stats = driver.draw(scene);
    if (!stats) {
        return stats.error();
    }
    Image image = driver.read_color();
    auto hits = driver.draw_hits(scene);
    if (!hits) {
        return hits.error();
    }
    return ShownFrame{std::move(*hits), std::move(image)};
}

bool has_terrain(const HitBuffer& hits) {
    const auto pixels = hits.samples();
    return std::any_of(pixels.begin(), pixels.end(), truth::shows_terrain);
}

std::optional<RowError::Geometric> geometric_of(const truth::PixelErrors& errors) {
    if (!errors.distribution) {
        return std::nullopt;
    }
    return RowError::Geometric{*errors.distribution, errors.unbounded};
}

RowError row_error_of(const truth::GeometricErrors& geometric, const truth::ImageErrors& image) {
    return {.reprojection_px = geometric_of(geometric.reprojection),
            .hit_texels = geometric_of(geometric.hit),
            .wrong_percent = geometric.wrong_percent,
            .holes = geometric.holes,
            .rmse = image.rmse,
            .psnr = std::isfinite(image.psnr) ? std::optional(image.psnr) : std::nullopt,
            .ssim = image.ssim,
            .flip = image.flip.mean};
}

} // namespace

Result<Judgement> judge(BenchmarkScene& scene, const scene::Technique& technique,
                        session::SceneRenderer& driver, const JudgeOptions& options) {
    scene.set_technique(technique);
    auto shown = draw_shown(scene.scene(), driver);
    if (!shown) {
        return shown.error();
    }
    const auto truth = scene.truth(options.stop);
    if (!truth) {
        return truth.error();
    }
    if (!has_terrain(shown->hits) && !has_terrain(truth->get().hits)) {
        return Error{fmt::format("{}, {}: no pixel of terrain found in the picture, some were "
                                 "expected",
                                 scene.name(), scene::to_string(truth->get().pose))};
    }
    auto geometric = scene.errors(shown->hits, truth->get().hits, options.threads);
    if (!geometric) {
        return geometric.error();
    }
    const auto image =
        truth::image_errors(shown->image, *truth->get().image, {.threads = options.threads});
    if (!image) {
        return image.error();
    }
    Judgement judgement{row_error_of(*geometric, *image), {}};
    if (options.keep_view) {
        judgement.view = ShownView{std::move(shown->image), truth->get().image,
                                   std::move(geometric->reprojection.map)};
    }
    return judgement;
}

} // namespace reljef::bench

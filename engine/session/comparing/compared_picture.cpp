#include "engine/session/comparing/compared_picture.h"

#include <utility>

#include <fmt/format.h>

#include "engine/session/comparing/error_map.h"
#include "engine/session/comparing/scene_truth.h"
#include "engine/session/comparing/wipe.h"
#include "engine/session/prepared_maps.h"
#include "engine/truth/geometric_error.h"

namespace reljef::session {
namespace {

constexpr int fine_rays = 2; // along a pixel's side, as smooth as the usual samples

struct DrawnFrame {
    Image picture;
    HitBuffer hits;
};

Result<void> set_technique(TerrainScene& scene, const scene::Technique& technique,
                           const ParallelOptions& parallel, Log& log) {
    if (auto good = scene.check(technique); !good) {
        return good;
    }
    const auto maps = prepare_maps(missing_maps(scene, technique),
                                   static_cast<int>(parallel.threads), log, parallel.stop);
    if (!maps) {
        return maps.error();
    }
    apply_maps(scene, *maps);
    for (scene::Material* const material : scene.materials()) {
        material->technique = technique;
    }
    return {};
}

// The frame of another technique, which the scene has meanwhile.
Result<DrawnFrame> other_frame(TerrainScene& scene, FrameMaker& maker,
                               const scene::Technique& technique, const ParallelOptions& parallel,
                               Log& log) {
    const scene::Technique before = scene.materials().front()->technique;
    if (auto set = set_technique(scene, technique, parallel, log); !set) {
        return set.error();
    }
    auto picture = maker.draw(scene.scene, parallel);
    auto hits = picture ? maker.draw_hits(scene.scene, parallel) : picture.error();
    for (scene::Material* const material : scene.materials()) {
        material->technique = before;
    }
    return hits ? Result<DrawnFrame>(DrawnFrame{std::move(*picture), std::move(*hits)})
                : hits.error();
}

class Errors {
public:
    Errors(SceneTruth& truth, const truth::Picture& exact, const scene::Camera& camera,
           const ParallelOptions& parallel)
        : truth_(truth), exact_(exact), camera_(camera), parallel_(parallel) {}

    // Adds the figures of a frame; returns its error map.
    Result<Image> add(const Image& picture, const HitBuffer& hits) {
        if (!truth::has_terrain(hits) && !truth::has_terrain(exact_.hits)) {
            figures_.emplace_back().has_terrain = false;
            return exact_.image;
        }
        const auto errors = truth_.errors(camera_, hits, exact_.hits, parallel_);
        if (!errors) {
            return errors.error();
        }
        const auto figures = error_figures(*errors, picture, exact_.image, parallel_.threads);
        if (!figures) {
            return figures.error();
        }
        figures_.push_back(*figures);
        return error_map(*errors, exact_.image);
    }
    [[nodiscard]] const std::vector<ErrorFigures>& figures() const { return figures_; }

private:
    SceneTruth& truth_;
    const truth::Picture& exact_;
    scene::Camera camera_;
    ParallelOptions parallel_;
    std::vector<ErrorFigures> figures_;
};

} // namespace

Result<CompareRequest> parse_compare_request(const std::string& text) {
    CompareRequest request;
    if (text == "truth") {
        return request;
    }
    if (text == "errors") {
        request.errors = true;
        return request;
    }
    const auto technique = scene::parse_technique(text);
    if (!technique) {
        return Error{fmt::format("--compare: '{}' found, truth, errors or a technique was "
                                 "expected: {}",
                                 text, technique.error().message)};
    }
    request.technique = *technique;
    return request;
}

Result<ComparedPicture> compared_picture(TerrainScene& scene, FrameMaker& maker, const Image& left,
                                         const CompareRequest& request,
                                         const ParallelOptions& parallel, Log& log) {
    auto truth = SceneTruth::create(scene.scene);
    const ParallelOptions rest{parallel.threads, parallel.stop, {}}; // takes far less time
    const auto hits = truth ? maker.draw_hits(scene.scene, rest) : truth.error();
    if (!hits) {
        return hits.error();
    }
    const scene::Camera camera = scene.scene.camera();
    const auto exact = truth->draw(camera, {left.cols(), left.rows()},
                                   {.rays_per_side = fine_rays, .parallel = parallel});
    if (!exact) {
        return exact.error();
    }
    Errors errors(*truth, *exact, camera, rest);
    auto map = errors.add(left, *hits);
    if (!map) {
        return map.error();
    }
    Image right = request.errors ? *map : exact->image;
    if (request.technique) {
        auto other = other_frame(scene, maker, *request.technique, rest, log);
        const auto added = other ? errors.add(other->picture, other->hits) : other.error();
        if (!added) {
            return added.error();
        }
        right = std::move(other->picture);
    }
    return ComparedPicture{wiped(left, right, request.share), errors.figures()};
}

} // namespace reljef::session

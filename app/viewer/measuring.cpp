#include "app/viewer/measuring.h"

#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/core/atomic_file.h"
#include "engine/session/measuring/ground_measure.h"
#include "engine/terrain/measure/sight.h"

namespace reljef::app {
namespace {

// `rise`: from the first point to the last one, metres; they may be on objects. Empty: not known.
std::string distance_text(std::span<const terrain::ProfilePoint> profile,
                          std::optional<double> rise) {
    const terrain::ProfileSummary found = terrain::summarize(profile);
    std::string text = fmt::format("  distance {:.1f} m, over the ground {:.1f} m", found.distance,
                                   found.over_ground);
    if (rise) {
        text += fmt::format(", {} by {:.1f} m", *rise < 0.0 ? "lower" : "higher", std::abs(*rise));
    }
    return text + fmt::format(", climb {:.1f} m, descent {:.1f} m\n", found.climb, found.descent);
}

// What is seen shines green, what is hidden lies in blue shade; voids keep their colours.
Image colors_of(const Grid<std::uint8_t>& seen) {
    constexpr Rgba8 unknown{0, 0, 0, 0};
    Image colors(seen.cols(), seen.rows());
    for (int row = 0; row < seen.rows(); ++row) {
        for (int col = 0; col < seen.cols(); ++col) {
            const auto state = static_cast<terrain::SeenState>(seen(col, row));
            colors(col, row) = state == terrain::SeenState::visible  ? Measuring::visible_color
                               : state == terrain::SeenState::hidden ? Measuring::hidden_color
                                                                     : unknown;
        }
    }
    return colors;
}

} // namespace

Result<std::string> Measuring::pick(const std::optional<session::PickedPlace>& place) {
    if (!place) {
        return Error{"measuring: the sky found, a place on the ground was expected"};
    }
    const double height = session::height_of(terrain(), *place);
    const double rise = height - std::exchange(last_height_, height);
    const session::PickedPlace from = std::exchange(last_, *place);
    points_.push_back(place->world);
    texts_.push_back(session::point_text(terrain(), *place));
    std::string text = fmt::format("{}  {}\n", points_.size(), texts_.back());
    if (points_.size() < 2) {
        return text;
    }
    auto profile = session::ground_profile(terrain(), from.world, place->world);
    if (!profile) {
        return profile.error();
    }
    profile_ = std::move(*profile);
    const bool is_over_ground = std::isfinite(profile_.back().height - profile_.front().height);
    text += distance_text(profile_, is_over_ground ? std::optional(rise) : std::nullopt);
    const auto hidden = session::hidden_by(scene_, from, *place, eye_height);
    is_in_sight_ = !hidden;
    return text +
           (hidden ? fmt::format("  hidden from each other by {}\n",
                                 session::point_text(terrain(), *hidden))
                   : fmt::format("  in sight of each other, {} m above the ground\n", eye_height));
}

void Measuring::clear() {
    points_.clear();
    texts_.clear();
    profile_.clear();
}

Result<void> Measuring::save_profile(const std::filesystem::path& file) const {
    if (profile_.empty()) {
        return Error{
            "profile: fewer than two measured points found, two were expected; X measures"};
    }
    std::string text = "distance,height\n";
    for (const terrain::ProfilePoint& point : profile_) {
        text += std::isnan(point.height)
                    ? fmt::format("{:.3f},nan\n", point.distance)
                    : fmt::format("{:.3f},{:.3f}\n", point.distance, point.height);
    }
    return write_text_file(file, text);
}

Result<void> Measuring::begin_viewshed(const std::filesystem::path& file) {
    if (viewshed_ != nullptr) {
        return Error{"viewshed: an unfinished one found, none was expected; wait for it"};
    }
    if (points_.empty()) {
        return Error{"viewshed: no measured point found, one was expected; X measures"};
    }
    const auto place = terrain().surface->placement().geodetic_from_world(points_.back());
    if (!place || !terrain().surface->heightfield().georeference) {
        return Error{"viewshed: no place on Earth found, a georeferenced terrain was expected"};
    }
    session::ViewshedRequest request;
    request.from = {place->latitude, place->longitude};
    request.eye_height = eye_height;
    request.placement = terrain().surface->placement().kind();
    viewshed_ = std::make_unique<Viewshed>();
    viewshed_->file = file;
    viewshed_->surface = terrain().surface;
    viewshed_->work.emplace([made = viewshed_.get(), request](const std::stop_token& stop) {
        const auto task = made->log.start("viewshed");
        return session::viewshed_of(made->surface->terrain(), request,
                                    {.threads = 0, .stop = stop, .progress = task->callback()});
    });
    return {};
}

std::optional<Result<std::string>> Measuring::update() {
    if (viewshed_ == nullptr || !viewshed_->work->is_done()) {
        return std::nullopt;
    }
    const std::unique_ptr<Viewshed> done = std::move(viewshed_);
    const auto found = done->work->take();
    if (!found) {
        return Result<std::string>(found.error());
    }
    seen_ = std::make_shared<const Image>(colors_of(found->seen));
    const auto written = session::write_viewshed(done->file, *found, done->surface->heightfield());
    return written ? Result<std::string>(fmt::format("saved {}: {:.2f} % of the terrain is "
                                                     "visible\n",
                                                     done->file.filename().string(),
                                                     100.0 * found->visible_share))
                   : Result<std::string>(written.error());
}

session::RelayedLog::TaskProgress Measuring::progress() const {
    return viewshed_ != nullptr ? viewshed_->log.progress() : session::RelayedLog::TaskProgress{};
}

} // namespace reljef::app

#include "app/viewer/comparing/truth_search.h"

#include <utility>

#include "engine/core/stopwatch.h"
#include "engine/session/comparing/error_map.h"

namespace reljef::app {
namespace {

constexpr int fine_rays = 2; // along a pixel's side, for a smooth picture

glm::ivec2 size_of(const Image& picture) {
    return {picture.cols(), picture.rows()};
}

} // namespace

Result<void> TruthSearch::begin(const scene::Scene& scene, ComparedView view) {
    stop();
    if (scene_ == nullptr || !scene_->truth.is_of(scene)) {
        auto truth = session::SceneTruth::create(scene);
        if (!truth) {
            return truth.error();
        }
        scene_ = std::make_shared<LockedTruth>(std::move(*truth));
    }
    begin({std::make_shared<const ComparedView>(std::move(view)), scene_, 1, {}});
    return {};
}

bool TruthSearch::is_known(const Search& search) const {
    return last_ && last_->scene == search.scene && last_->camera == search.view->camera &&
           last_->rays_per_side >= search.rays_per_side &&
           size_of(last_->picture->image) == size_of(search.view->frames.front().picture);
}

void TruthSearch::begin(Search search) {
    if (is_known(search)) {
        search.known = last_;
    }
    work_ = std::make_unique<Work>();
    work_->search = std::move(search);
    work_->found.emplace([work = work_.get(), threads = threads_](const std::stop_token& stop) {
        const std::lock_guard lock(work->search.scene->mutex);
        const auto task = work->log.start("finding the truth");
        return find(work->search, {static_cast<unsigned>(threads), stop, task->callback()});
    });
}

Result<TruePicture> TruthSearch::draw_truth(const Search& search, const ParallelOptions& parallel) {
    if (search.known) {
        return *search.known;
    }
    const ComparedView& view = *search.view;
    const Stopwatch watch;
    auto picture =
        search.scene->truth.draw(view.camera, size_of(view.frames.front().picture),
                                 {.rays_per_side = search.rays_per_side, .parallel = parallel});
    if (!picture) {
        return picture.error();
    }
    return TruePicture{search.scene, view.camera, search.rays_per_side, watch.milliseconds(),
                       std::make_shared<const truth::Picture>(std::move(*picture))};
}

Result<FoundErrors> TruthSearch::find(const Search& search, const ParallelOptions& parallel) {
    auto truth = draw_truth(search, parallel);
    if (!truth) {
        return truth.error();
    }
    FoundErrors found{std::move(*truth), {}, {}};
    const truth::Picture& exact = *found.truth.picture;
    for (const ComparedFrame& frame : search.view->frames) {
        const auto errors = search.scene->truth.errors(search.view->camera, frame.hits, exact.hits,
                                                       {parallel.threads, parallel.stop, {}});
        if (!errors) {
            return errors.error();
        }
        const auto figures =
            session::error_figures(*errors, frame.picture, exact.image, parallel.threads);
        if (!figures) {
            return figures.error();
        }
        found.figures.push_back(*figures);
        if (found.map.empty()) {
            found.map = session::error_map(*errors, exact.image);
        }
    }
    return found;
}

void TruthSearch::stop() {
    found_.reset();
    if (work_ != nullptr) {
        work_->found->request_stop();
        retired_.push_back(std::move(work_));
    }
}

void TruthSearch::forget() {
    stop();
    last_.reset();
    scene_.reset();
}

bool TruthSearch::update() {
    std::erase_if(retired_, [](const auto& work) { return work->found->is_done(); });
    if (work_ == nullptr || !work_->found->is_done()) {
        return false;
    }
    auto found = work_->found->take();
    const std::unique_ptr<Work> done = std::move(work_);
    if (!found) {
        log_.note(found.error().message);
        return true;
    }
    found_ = std::move(*found);
    last_ = found_->truth;
    if (last_->rays_per_side < fine_rays) {
        Search finer = done->search;
        finer.rays_per_side = fine_rays;
        finer.known.reset();
        begin(std::move(finer));
    }
    return true;
}

double TruthSearch::progress() const {
    return work_ != nullptr ? work_->log.progress().fraction : 0.0;
}

} // namespace reljef::app

#include "app/viewer/comparing/compared_frames.h"

#include <utility>

#include "engine/core/stopwatch.h"
#include "engine/session/comparing/wipe.h"

namespace reljef::app {
namespace {

// The scene's materials have another technique as long as this lives.
class OtherTechnique {
public:
    OtherTechnique(const session::TerrainScene& scene, const scene::Technique& technique)
        : materials_(scene.materials()) {
        for (scene::Material* const material : materials_) {
            before_.push_back(std::exchange(material->technique, technique));
        }
    }
    ~OtherTechnique() {
        for (std::size_t i = 0; i < materials_.size(); ++i) {
            materials_[i]->technique = before_[i];
        }
    }
    OtherTechnique(const OtherTechnique&) = delete;
    OtherTechnique& operator=(const OtherTechnique&) = delete;

private:
    std::vector<scene::Material*> materials_;
    std::vector<scene::Technique> before_;
};

} // namespace

Result<void> ComparedFrames::prepare_right(int samples) {
    if (!right_) {
        auto made = make_renderer_();
        if (!made) {
            return made.error();
        }
        right_.emplace(std::move(*made));
        if (light_ != nullptr) {
            right_->add_light(light_);
        }
    }
    if (auto light = comparison_.take_light()) {
        right_->add_light(std::move(light));
    }
    if (right_->size() != left_.size()) {
        if (auto resized = right_->resize(left_.size()); !resized) {
            return resized;
        }
    }
    right_->set_samples(samples);
    return {};
}

std::vector<view::TileRequests> ComparedFrames::select(int samples) {
    is_selected_ = false;
    if (!comparison_.draws_technique()) {
        right_.reset();
        right_ms_.reset();
        right_drawn_ = Image();
        return {};
    }
    if (!prepare_right(samples)) {
        return {}; // draw() fails
    }
    const OtherTechnique on_the_right(scene_, comparison_.technique());
    is_selected_ = true;
    return right_->select(scene_.scene).requests;
}

Result<void> ComparedFrames::draw() {
    comparison_.forget_view();
    if (!comparison_.is_on()) {
        left_picture_ = Image();
        return {};
    }
    left_picture_ = left_.read_color();
    return comparison_.draws_technique() ? draw_right() : Result<void>();
}

Result<void> ComparedFrames::draw_right() {
    if (!right_ || !is_selected_) {
        return Error{"the technique on the right: its renderer cannot be made"};
    }
    const Stopwatch watch;
    const OtherTechnique on_the_right(scene_, comparison_.technique());
    if (const auto drawn = right_->draw_selected(true); !drawn) {
        return drawn.error();
    }
    right_ms_ = watch.milliseconds();
    right_drawn_ = right_->read_color();
    return {};
}

Result<void> ComparedFrames::find_errors() {
    ComparedView view{scene_.scene.camera(), {}};
    left_.select(scene_.scene);
    auto left = left_.draw_selected_hits();
    if (!left) {
        return left.error();
    }
    view.frames.push_back({left_picture_, std::move(left->hits)});
    if (comparison_.draws_technique() && right_) {
        const OtherTechnique on_the_right(scene_, comparison_.technique());
        right_->select(scene_.scene);
        auto right = right_->draw_selected_hits();
        if (!right) {
            return right.error();
        }
        view.frames.push_back({right_drawn_, std::move(right->hits)});
    }
    comparison_.find_errors(std::move(view));
    return {};
}

const Image* ComparedFrames::right_picture() const {
    const Image* const right = comparison_.draws_technique() ? &right_drawn_ : comparison_.right();
    const bool fits = right != nullptr && right->cols() == left_picture_.cols() &&
                      right->rows() == left_picture_.rows();
    return fits ? right : nullptr;
}

Image ComparedFrames::picture() const {
    if (left_picture_.empty() || !comparison_.is_on()) {
        return left_.read_color();
    }
    const Image* const right = right_picture();
    return session::wiped(left_picture_, right != nullptr ? *right : left_picture_,
                          comparison_.share());
}

Result<void> ComparedFrames::show(glm::ivec2 window_size) {
    return left_picture_.empty() || !comparison_.is_on()
               ? left_.show_in_window(window_size)
               : left_.show_in_window(picture(), window_size);
}

void ComparedFrames::add_light(const std::shared_ptr<const view::PreparedLight>& light) {
    light_ = light;
    if (right_) {
        right_->add_light(light);
    }
}

} // namespace reljef::app

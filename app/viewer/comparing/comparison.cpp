#include "app/viewer/comparing/comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "app/viewer/comparing/figure_rows.h"
#include "engine/session/comparing/wipe.h"

namespace reljef::app {
namespace {

constexpr double reach = 7.0;         // of the line, pixels
constexpr double share_a_step = 0.05; // of a key

std::string name_of(CompareWith with, const scene::Technique& technique) {
    switch (with) {
    case CompareWith::nothing:
        return {};
    case CompareWith::truth:
        return "truth";
    case CompareWith::errors:
        return "errors";
    case CompareWith::technique:
        return scene::to_string(technique);
    }
    return {};
}

} // namespace

Comparison::Comparison(session::TerrainScene& scene, const AppearanceSwitchOptions& options)
    : scene_(scene), options_(options), truth_(options.threads) {
    if (const auto truth = session::SceneTruth::create(scene.scene); !truth) {
        obstacle_ = truth.error().message;
    }
    for (const scene::TechniqueInfo& info : scene::technique_catalogue()) {
        const bool is_polygons = info.id == scene::TechniqueId::polygons;
        const scene::Technique technique =
            is_polygons ? session::technique_of({}) : scene::make_technique(info.id);
        if (scene.check(technique)) {
            techniques_.push_back(technique);
        }
    }
    // The classic texture is the baseline that most are compared with.
    const auto texture =
        std::find_if(techniques_.begin(), techniques_.end(), [](const scene::Technique& technique) {
            return technique.id() == scene::TechniqueId::texture;
        });
    technique_ = texture != techniques_.end() ? *texture : scene.materials().front()->technique;
    last_ = obstacle_.empty() ? CompareWith::truth : CompareWith::technique;
}

// Requests the stop of all work before it waits.
Comparison::~Comparison() {
    truth_.stop();
    if (preparing_ != nullptr) {
        preparing_->maps->request_stop();
    }
}

Result<void> Comparison::set(CompareWith with) {
    const bool needs_truth = with == CompareWith::truth || with == CompareWith::errors;
    if (needs_truth && !obstacle_.empty()) {
        return Error{obstacle_};
    }
    last_ = with == CompareWith::nothing ? last_ : with;
    if (std::exchange(with_, with) == with) {
        return {};
    }
    redraw_ = true;
    is_dragged_ = false;
    forget_view();
    if (with == CompareWith::technique) {
        prepare_technique();
    }
    if (with == CompareWith::nothing) {
        truth_.forget(); // its maps take memory
    }
    return {};
}

Result<void> Comparison::next() {
    if (!is_on()) {
        return toggle();
    }
    switch (with_) {
    case CompareWith::truth:
        return set(CompareWith::errors);
    case CompareWith::errors:
        return set(CompareWith::technique);
    case CompareWith::technique:
    case CompareWith::nothing:
        return obstacle_.empty() ? set(CompareWith::truth) : Result<void>();
    }
    return {};
}

Result<void> Comparison::choose(const scene::Technique& technique) {
    if (auto good = scene_.check(technique); !good) {
        return good;
    }
    const auto known =
        std::find_if(techniques_.begin(), techniques_.end(),
                     [&](const scene::Technique& other) { return other.id() == technique.id(); });
    if (known != techniques_.end()) {
        *known = technique;
    }
    technique_ = technique;
    forget_view();
    with_ = CompareWith::technique;
    last_ = with_;
    prepare_technique();
    redraw_ = true;
    return {};
}

void Comparison::choose_next() {
    const auto found =
        std::find_if(techniques_.begin(), techniques_.end(),
                     [&](const auto& technique) { return technique.id() == technique_.id(); });
    const auto index = static_cast<std::size_t>(found - techniques_.begin());
    if (!techniques_.empty()) {
        static_cast<void>(choose(techniques_[(index + 1) % techniques_.size()])); // it draws it
    }
}

std::string Comparison::option() const {
    return name_of(with_, technique_);
}

void Comparison::set_share(double share) {
    share_ = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : share_;
    is_new_ = true;
}

void Comparison::move_line(int steps) {
    set_share(std::round(share_ / share_a_step + steps) * share_a_step);
}

bool Comparison::receive(const Event& event, glm::ivec2 size) {
    if (!is_on()) {
        return false;
    }
    if (const auto* button = std::get_if<MouseButtonEvent>(&event);
        button != nullptr && button->button == MouseButton::left) {
        const double line = session::wipe_column(share_, size.x);
        const bool was_dragged = is_dragged_;
        is_dragged_ = button->pressed && std::abs(button->position.x - line) <= reach;
        return is_dragged_ || was_dragged;
    }
    const auto* move = std::get_if<MouseMoveEvent>(&event);
    if (move == nullptr || !is_dragged_) {
        return false;
    }
    set_share(move->position.x / std::max(size.x, 1));
    return true;
}

void Comparison::forget_view() {
    asked_ = false;
    truth_.stop();
}

void Comparison::find_errors(ComparedView view) {
    asked_ = true;
    if (const auto begun = truth_.begin(scene_.scene, std::move(view)); !begun) {
        log_.note(begun.error().message);
    }
}

bool Comparison::update() {
    std::erase_if(retired_maps_, [](const auto& work) { return work->maps->is_done(); });
    const bool has_technique = update_technique();
    const bool has_truth = truth_.update();
    return std::exchange(is_new_, false) || has_technique || has_truth;
}

void Comparison::relay_to(session::Log& log) {
    log_.relay_to(log);
    truth_.relay_to(log);
}

void Comparison::prepare_technique() {
    if (preparing_ != nullptr) {
        preparing_->maps->request_stop();
        retired_maps_.push_back(std::move(preparing_));
    }
    session::MissingMaps missing = session::missing_maps(scene_, technique_);
    missing.light = session::light_request(scene_, *scene_.light->get<scene::Light>(), technique_,
                                           options_.largest_side);
    if (missing.empty()) {
        return;
    }
    preparing_ = std::make_unique<Preparing>();
    preparing_->maps.emplace([missing = std::move(missing), &log = preparing_->log,
                              threads = options_.threads](const std::stop_token& stop) {
        return session::prepare_maps(missing, threads, log, stop);
    });
}

bool Comparison::update_technique() {
    if (preparing_ == nullptr || !preparing_->maps->is_done()) {
        return false;
    }
    const auto maps = preparing_->maps->take();
    preparing_->log.relay_to(log_);
    preparing_.reset();
    if (!maps) {
        log_.note(maps.error().message);
        with_ = CompareWith::nothing;
    } else {
        session::apply_maps(scene_, *maps);
        light_ = maps->light;
    }
    redraw_ = true;
    return true;
}

const Image* Comparison::right() const {
    const auto& found = truth_.found();
    if (!found) {
        return nullptr;
    }
    return with_ == CompareWith::truth    ? &found->truth.picture->image
           : with_ == CompareWith::errors ? &found->map
                                          : nullptr;
}

std::string Comparison::state() const {
    if (!is_on() || !obstacle_.empty()) {
        return {};
    }
    if (preparing_ != nullptr) {
        return "preparing the technique on the right";
    }
    if (truth_.found()) {
        return {};
    }
    return asked_ ? "finding the truth" : "the truth is found when the view rests";
}

CompareContent Comparison::content(const scene::Technique& left) const {
    CompareContent content;
    content.with = with_;
    content.obstacle = obstacle_;
    content.technique = technique_;
    content.share = share_;
    content.left_name = scene::to_string(left);
    content.right_name = name_of(with_, technique_);
    content.state = state();
    content.progress =
        preparing_ != nullptr ? preparing_->log.progress().fraction : truth_.progress();
    if (const auto& found = truth_.found()) {
        content.figures = figure_rows(found->figures);
        if (with_ == CompareWith::truth) {
            content.right_ms = found->truth.milliseconds;
        }
    }
    content.colors = error_colors();
    return content;
}

} // namespace reljef::app

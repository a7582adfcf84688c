#include "bench/baselines/baseline_suite.h"

#include <array>
#include <functional>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "app/cli/console_log.h"
#include "app/cli/progress_line.h"
#include "bench/baselines/baseline_entry.h"
#include "bench/baselines/own_entries.h"
#include "bench/runner/benchmark_scene.h"
#include "engine/truth/draw.h"

namespace reljef::bench {
namespace {

constexpr int default_rounds = 30;
constexpr int quick_rounds = 5;
constexpr int warm_up = 2;              // rounds
constexpr double frames_across = 500.0; // of a moving camera; 20 s at 25 frames per second

struct OtherProgram {
    std::string_view name;
    BaselineEntries (*entries)(const BaselineView& view);
};
constexpr std::array other_programs{
    OtherProgram{"Irrlicht's terrain node", irrlicht_terrain_entries},
    OtherProgram{"Irrlicht's parallax material", irrlicht_relief_entries},
    OtherProgram{"OpenSceneGraph", openscenegraph_entries},
    OtherProgram{"Embree", embree_entries},
    OtherProgram{"POV-Ray", povray_entries},
};

class BaselineRun {
public:
    BaselineRun(BaselineResults& results, std::stop_token stop)
        : results_(results), options_(results.options), stop_(std::move(stop)) {}

    Result<void> run() {
        auto scene = open_baseline_scene(options_.terrain, options_.suite, stop_);
        if (!scene) {
            return scene.error();
        }
        view_.emplace(BaselineView{.scene = std::move(*scene),
                                   .size = options_.suite.size,
                                   .threads = static_cast<unsigned>(options_.suite.threads)});
        results_.side = view_->side();
        auto devices = OwnDevices::create(options_.suite);
        if (!devices) {
            return devices.error();
        }
        devices_.emplace(std::move(*devices));
        results_.environment = environment_of(devices_->device(), options_.suite.threads);
        make_groups();
        for (const scene::Pose pose : {scene::Pose::overview, scene::Pose::low}) {
            if (auto done = run_pose(pose); !done || stop_.stop_requested()) {
                return done;
            }
        }
        return {};
    }

private:
    void note(const std::string& sentence) {
        results_.notes.push_back(sentence);
        cli::ConsoleLog(options_.suite.quiet).note(sentence);
    }

    // Rows of one group are timed together.
    using Group = std::vector<BaselineEntry>;

    void make_groups() {
        std::vector<BaselineEntry> entries;
        const auto add = [&](std::vector<BaselineEntry> more) {
            std::move(more.begin(), more.end(), std::back_inserter(entries));
        };
        for (const OtherProgram& other : other_programs) {
            auto made = other.entries(*view_);
            made ? add(std::move(*made))
                 : note(fmt::format("{} left out: {}", other.name, made.error().message));
        }
        add(own_entries(*view_, *devices_));
        std::map<std::pair<BaselineWork, bool>, Group> groups;
        for (BaselineEntry& entry : entries) {
            groups[{entry.row.work, entry.row.moving}].push_back(std::move(entry));
        }
        for (auto& [kind, group] : groups) {
            groups_.push_back(std::move(group));
        }
    }

    Result<void> run_pose(scene::Pose pose) {
        if (auto placed = place_camera(pose); !placed) {
            return placed;
        }
        for (Group& group : groups_) {
            if (shows_no_square(group)) {
                note(fmt::format("{}: {} left out: the eye is below the square",
                                 scene::to_string(pose), to_string(BaselineWork::relief)));
                continue;
            }
            if (stop_.stop_requested()) {
                return {};
            }
            for (BaselineEntry& entry : group) {
                entry.row.pose = pose;
                entry.ms.clear();
            }
            auto measured = attempt(group, [&](auto& entry) { return measure_error(entry); });
            if (measured && !group.empty()) {
                measured = time_together(group);
            }
            if (!measured) {
                return measured;
            }
            for (const BaselineEntry& entry : group) {
                add_row(entry);
            }
        }
        return {};
    }

    // The square lies at the middle height.
    [[nodiscard]] bool shows_no_square(const Group& group) const {
        const Box bounds = view_->scene.terrain->world_bounds();
        return !group.empty() && group.front().row.work == BaselineWork::relief &&
               view_->scene.view().eye.z < bounds.center().z;
    }

    void add_row(const BaselineEntry& entry) {
        if (!entry.ms.empty()) {
            results_.rows.push_back(entry.row);
            results_.rows.back().frames = entry.ms.size();
            results_.rows.back().ms = summarize(entry.ms);
        }
    }

    // Another program that fails is left out from then on; reljef must not fail.
    Result<void> attempt(Group& group, const std::function<Result<void>(BaselineEntry&)>& step) {
        for (auto entry = group.begin(); entry != group.end();) {
            Result<void> done = step(*entry);
            if (!done && !entry->is_other) {
                return done;
            }
            if (!done) {
                note(fmt::format("{} left out: {}", entry->row.what, done.error().message));
                entry = group.erase(entry);
            } else {
                ++entry;
            }
        }
        return {};
    }

    Result<void> place_camera(scene::Pose pose) {
        scene::Camera& camera = *view_->scene.camera->get<scene::Camera>();
        camera =
            scene::pose_camera(pose, view_->scene.terrain->world_bounds(), [&](double x, double y) {
                return view_->scene.scene.height_at(x, y).value_or(0.0);
            });
        view_->set_technique(scene::Technique{scene::Polygons{.error = 1.0}});
        const auto shown = devices_->opengl().draw_hits(view_->scene.scene);
        if (!shown) {
            return shown.error();
        }
        view_->range = depth_range_of(*shown);
        if (view_->range.far == 0.0) {
            return Error{fmt::format("{}, {}: no pixel of terrain found, some were expected",
                                     options_.terrain, scene::to_string(pose))};
        }
        camera.near = view_->range.near;
        still_ = camera;
        auto truth = truth::draw_hits(view_->scene.scene, view_->size,
                                      {.threads = view_->threads, .stop = stop_, .progress = {}});
        if (!truth) {
            return truth.error();
        }
        truth_ = std::move(*truth);
        return {};
    }

    // The camera of the pose, moved to its right by `frame` steps if `moving`.
    void move_camera(bool moving, int frame) {
        const double step =
            moving ? frame * view_->scene.terrain->world_bounds().size().x / frames_across : 0.0;
        const glm::dvec3 offset = step * scene::view_axes(still_).right;
        scene::Camera& camera = *view_->scene.camera->get<scene::Camera>();
        camera = still_;
        camera.eye += offset;
        camera.target += offset;
    }

    Result<void> measure_error(BaselineEntry& entry) {
        if (entry.row.moving) {
            return {};
        }
        if (auto ready = entry.set_camera(); !ready) {
            return ready;
        }
        const auto hits = entry.hits();
        if (!hits) {
            return hits.error();
        }
        const auto errors = truth::geometric_errors(view_->surface(), *hits, truth_);
        if (!errors) {
            return errors.error();
        }
        entry.row.error = errors->reprojection.distribution;
        entry.row.hit_error = errors->hit.distribution;
        entry.row.wrong_percent = errors->wrong_percent;
        return {};
    }

    Result<void> time_together(Group& group) {
        const int rounds = options_.suite.rounds > 0 ? options_.suite.rounds
                           : options_.suite.quick    ? quick_rounds
                                                     : default_rounds;
        const bool moving = group.front().row.moving;
        cli::ProgressLine line("measuring peers", options_.suite.quiet);
        for (int round = -warm_up; round < rounds && !stop_.stop_requested(); ++round) {
            move_camera(moving, round);
            const auto time = [&](BaselineEntry& entry) {
                return round < entry.max_rounds ? time_one(entry, round >= 0) : Result<void>();
            };
            if (auto timed = attempt(group, time); !timed) {
                return timed;
            }
            line.update(static_cast<double>(round + warm_up) / (rounds + warm_up));
        }
        move_camera(false, 0);
        return {};
    }

    static Result<void> time_one(BaselineEntry& entry, bool counts) {
        if (auto ready = entry.set_camera(); !ready) {
            return ready;
        }
        const auto ms = entry.draw(entry.row);
        if (!ms) {
            return ms.error();
        }
        if (counts) {
            entry.ms.push_back(*ms);
        }
        return {};
    }

    BaselineResults& results_;
    const BaselineOptions& options_;
    std::stop_token stop_;
    std::optional<BaselineView> view_;
    std::optional<OwnDevices> devices_;
    std::vector<Group> groups_; // in the order of BaselineWork; still before moving
    HitBuffer truth_;           // of the pose
    scene::Camera still_;       // of the pose
};

} // namespace

BaselineResults run_baselines(const BaselineOptions& options, const std::stop_token& stop) {
    BaselineResults results{.options = options};
    const auto done = BaselineRun(results, stop).run();
    results.end = run_end(done, stop, !results.rows.empty());
    return results;
}

} // namespace reljef::bench

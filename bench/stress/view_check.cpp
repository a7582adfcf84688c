#include "bench/stress/view_check.h"

namespace reljef::bench {
namespace {

// Pixels that show another place than the exact hits by more than a sample, percent: of the
// picture, and of its terrain.
struct WrongPixels {
    double percent = 0.0;
    double of_terrain_percent = 0.0;
};

Result<WrongPixels> wrong_pixels(const StressStage& stage, const HitBuffer& shown,
                                 const HitBuffer& truth) {
    if (!truth::has_terrain(shown) && !truth::has_terrain(truth)) {
        return WrongPixels{};
    }
    const auto errors = truth::geometric_errors(stage.surface_view(), shown, truth);
    if (!errors) {
        return errors.error();
    }
    return WrongPixels{errors->wrong_percent, errors->wrong_of_terrain_percent};
}

// The rows of one technique.
class TechniqueRows {
public:
    TechniqueRows(const ViewCheck& check, std::string_view terrain, const StressStage& stage,
                  const scene::Technique& technique)
        : check_(check), technique_(technique),
          tolerance_(silhouette_tolerance(stage, technique)), row_{.stress = check.stress,
                                                                   .terrain = std::string(terrain),
                                                                   .technique =
                                                                       to_string(technique)} {}

    Result<void> add_view(StressRun& run, const StressStage& stage, const StressView& view,
                          const HitBuffer& truth) {
        const auto shown = stage.hits(run.renderer());
        if (!shown) {
            refusal_ = shown.error().message;
            return {};
        }
        const auto wrong = wrong_pixels(stage, *shown, truth);
        if (!wrong) {
            return wrong.error();
        }
        not_finite_.add(static_cast<double>(count_not_finite(*shown)), view.name);
        sky_.add(static_cast<double>(count_sky_over_ground(stage, *shown, truth, tolerance_)),
                 view.name);
        wrong_.add(wrong->percent, view.name);
        if (check_.has_row_per_view) {
            add(run, "% of pixels wrong", wrong->percent, wrong_limit(), view.name);
            add(run, "% of terrain wrong", wrong->of_terrain_percent, {}, view.name);
        }
        return {};
    }

    void add_to(StressRun& run) {
        if (!refusal_.empty()) {
            add(run, "refused", 1.0, check_.exceeds_textures ? std::nullopt : std::optional(0.0),
                refusal_);
            return;
        }
        add(run, "pixels not finite", not_finite_.value(), 0.0, not_finite_.at());
        add(run, "pixels of sky over ground", sky_.value(),
            covers_ground(technique_) ? std::optional(0.0) : std::nullopt, sky_.at());
        if (!check_.has_row_per_view) {
            add(run, "% of pixels wrong", wrong_.value(), wrong_limit(), wrong_.at());
        }
    }

private:
    [[nodiscard]] std::optional<double> wrong_limit() const {
        return technique_.id() == scene::TechniqueId::exact ? std::optional(max_wrong_percent)
                                                            : std::nullopt;
    }
    void add(StressRun& run, const char* figure, double value, std::optional<double> limit,
             const std::string& at) {
        row_.figure = figure;
        row_.value = value;
        row_.limit = limit;
        row_.at = at;
        run.add(row_);
    }

    const ViewCheck& check_;
    const scene::Technique& technique_;
    const SilhouetteTolerance tolerance_;
    StressRow row_;
    std::string refusal_; // why the driver cannot draw the surface; empty: it can
    Worst not_finite_;
    Worst sky_;
    Worst wrong_;
};

Result<std::vector<HitBuffer>> true_hits(StressRun& run, StressStage& stage,
                                         const std::vector<StressView>& views) {
    std::vector<HitBuffer> truths;
    for (const StressView& view : views) {
        stage.look(view.camera);
        auto truth = stage.true_hits(run.size(), run.parallel());
        if (!truth) {
            return truth.error();
        }
        truths.push_back(std::move(*truth));
    }
    return truths;
}

Result<void> add_views(StressRun& run, StressStage& stage, const std::vector<StressView>& views,
                       const std::vector<HitBuffer>& truths, TechniqueRows& rows) {
    for (std::size_t i = 0; i < views.size() && !run.stopped(); ++i) {
        stage.look(views[i].camera);
        if (auto done = rows.add_view(run, stage, views[i], truths[i]); !done) {
            return done;
        }
    }
    return {};
}

} // namespace

Result<void> check_views(StressRun& run, const ViewCheck& check, std::string_view terrain,
                         StressStage& stage, const std::vector<StressView>& views) {
    const auto truths = true_hits(run, stage, views);
    if (!truths) {
        return truths.error();
    }
    for (const scene::Technique& technique : stressed_techniques(run.options())) {
        if (!stage.set_technique(technique)) {
            continue;
        }
        TechniqueRows rows(check, terrain, stage, technique);
        auto done = add_views(run, stage, views, *truths, rows);
        if (!done || run.stopped()) {
            return done;
        }
        rows.add_to(run);
    }
    run.renderer().forget_scene();
    return {};
}

} // namespace reljef::bench

#include "bench/objects/objects_suite.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/progress_line.h"
#include "bench/objects/city_forms.h"
#include "bench/report/row_view.h"
#include "bench/runner/benchmark_scene.h"
#include "bench/runner/measure.h"
#include "bench/runner/problems.h"
#include "bench/runner/time_table.h"
#include "engine/core/stopwatch.h"
#include "engine/session/scene_renderer.h"
#include "engine/truth/draw.h"
#include "engine/truth/image_error.h"

namespace reljef::bench {
namespace {

using building::CityForm;

// What draws the city.
struct ObjectsVariant {
    CityForm form = CityForm::heights;
    scene::Technique technique;
    Row row;
    std::unique_ptr<session::SceneRenderer> renderer;
    view::FrameStats stats; // of the last frame
};

struct ObjectsView {
    double distance = 0.0; // metres
    double down = 0.0;     // degrees
};

std::string test_name(const ObjectsView& view) {
    return fmt::format("from {} m, {} degrees down", view.distance, view.down);
}

std::vector<CityChoice> cities_of(const ObjectsOptions& options) {
    std::vector<int> sizes = options.sizes;
    if (sizes.empty()) {
        sizes = options.suite.quick ? std::vector{512} : std::vector{256, 512, 1024};
    }
    std::vector<CityChoice> cities;
    for (const std::string& terrain :
         options.terrains.empty() ? std::vector<std::string>{"urban"} : options.terrains) {
        if (terrain != "urban") {
            cities.push_back({terrain});
            continue;
        }
        for (const int size : sizes) {
            cities.push_back({terrain, size});
        }
    }
    return cities;
}

std::vector<ObjectsView> views_of(const ObjectsOptions& options) {
    const bool quick = options.suite.quick;
    std::vector<double> distances = options.distances;
    std::vector<double> downs = options.downs;
    if (distances.empty()) {
        distances = quick ? std::vector{300.0} : std::vector{100.0, 300.0, 1000.0, 3000.0};
    }
    if (downs.empty()) {
        downs = quick ? std::vector{30.0} : std::vector{15.0, 45.0};
    }
    std::vector<ObjectsView> views;
    for (const double down : downs) {
        for (const double distance : distances) {
            views.push_back({distance, down});
        }
    }
    return views;
}

struct FormTechnique {
    CityForm form = CityForm::heights;
    scene::Technique technique;
    bool by_rays = false; // on the CPU
};

std::vector<FormTechnique> with_rays_beside(const std::vector<FormTechnique>& chosen) {
    std::vector<FormTechnique> all;
    for (const FormTechnique& each : chosen) {
        all.push_back(each);
        if (session::rays_draw(each.technique)) {
            all.push_back({each.form, each.technique, true});
        }
    }
    return all;
}

// The first is texture, to which ratios refer.
std::vector<FormTechnique> techniques_in(const CityForms& city, bool has_rays) {
    scene::Polygons bounded;
    bounded.error = session::default_max_error;
    std::vector<FormTechnique> found{{CityForm::heights, scene::Technique{scene::Texture{}}},
                                     {CityForm::heights, scene::Technique{scene::Parallax{}}},
                                     {CityForm::heights, scene::Technique{scene::Relief{}}},
                                     {CityForm::heights, scene::Technique{scene::Exact{}}},
                                     {CityForm::heights, scene::Technique{bounded}},
                                     {CityForm::heights, scene::Technique{scene::Automatic{
                                                             .error = session::default_max_error}}},
                                     {CityForm::meshes, scene::Technique{bounded}}};
    if (city.has(CityForm::meshes_only)) {
        found.push_back({CityForm::meshes_only, scene::Technique{bounded}});
    }
    return has_rays ? with_rays_beside(found) : found;
}

class ObjectsRun {
public:
    ObjectsRun(Results& results, const ObjectsOptions& options, std::stop_token stop)
        : results_(results), options_(options), stop_(std::move(stop)),
          line_("measuring objects", options.suite.quiet), views_(0) {}

    Result<void> run() {
        auto device = make_device(options_.suite);
        if (!device) {
            return device.error();
        }
        results_.environment = environment_of(*device, options_.suite.threads);
        results_.settings = run_settings(options_.suite);
        is_software_ = device->info().is_software;
        const auto cities = cities_of(options_);
        const auto views = views_of(options_);
        parts_ = cities.size() * views.size();
        for (const CityChoice& choice : cities) {
            auto city = CityForms::open(choice, options_.suite, stop_);
            if (!city) {
                note(city.error().message);
                problems_.add(city.error());
                parts_done_ += views.size();
                continue;
            }
            if (auto done = run_city(*city, views); !done || stop_.stop_requested()) {
                return done;
            }
        }
        return results_.rows.empty()
                   ? Result<void>(Error{
                         fmt::format("no city was measured: {}", fmt::join(results_.notes, "; "))})
                   : problems_.end();
    }

private:
    void note(const std::string& text) { results_.notes.push_back(text); }

    [[nodiscard]] Result<session::SceneRenderer> make_renderer(bool by_rays) const {
        session::SceneRendererOptions drivers;
        if (by_rays) {
            const auto target = session::simd_target_of(options_.suite.simd);
            if (!target) {
                return target.error();
            }
            drivers.rays.emplace();
            drivers.rays->size = options_.suite.size;
            drivers.rays->threads = static_cast<unsigned>(options_.suite.threads);
            drivers.rays->target = *target;
        } else {
            drivers.opengl.emplace();
            drivers.opengl->size = options_.suite.size;
            drivers.opengl->shader_dir = options_.suite.shader_dir;
            drivers.opengl->software = is_software_;
        }
        return session::SceneRenderer::create(drivers);
    }

    [[nodiscard]] Result<ObjectsVariant> variant_of(const CityForms& city, const ObjectsView& view,
                                                    const FormTechnique& chosen) const {
        auto renderer = make_renderer(chosen.by_rays);
        if (!renderer) {
            return renderer.error();
        }
        ObjectsVariant made;
        made.form = chosen.form;
        made.technique = chosen.technique;
        made.row.suite = "objects";
        made.row.test = test_name(view);
        made.row.scene = city.name();
        made.row.setting = setting_of(chosen.technique);
        const auto form_name = building::city_form_names[static_cast<std::size_t>(chosen.form)];
        made.row.setting.label = fmt::format("{}: {}{}", form_name, made.row.setting.label,
                                             chosen.by_rays ? " on cpu" : "");
        made.row.size = options_.suite.size;
        made.row.objects =
            RowObjects{std::string(form_name), city.buildings(), view.distance, view.down, 0};
        made.renderer = std::make_unique<session::SceneRenderer>(std::move(*renderer));
        return made;
    }

    Result<void> run_city(CityForms& city, const std::vector<ObjectsView>& views) {
        if (city.note()) {
            note(*city.note());
        }
        for (const ObjectsView& view : views) {
            if (stop_.stop_requested()) {
                return {};
            }
            if (auto done = run_view(city, view); !done) {
                return done;
            }
            line_.update(static_cast<double>(++parts_done_) / static_cast<double>(parts_));
        }
        return {};
    }

    Result<void> run_view(CityForms& city, const ObjectsView& view) {
        const Stopwatch since_begin;
        if (auto good = city.look_from(view.distance, view.down); !good) {
            note(good.error().message);
            return {};
        }
        std::vector<ObjectsVariant> variants;
        auto chosen = techniques_in(city, options_.suite.context == session::BackendKind::cpu);
        chosen.push_back(chosen.front());
        for (const FormTechnique& each : chosen) {
            auto made = variant_of(city, view, each);
            if (!made) {
                return made.error();
            }
            variants.push_back(std::move(*made));
        }
        variants.back().row.null_row = true;
        auto truth = city.draw_truth(stop_);
        if (!truth) {
            return stop_.stop_requested() ? Result<void>() : truth.error();
        }
        const auto exact = std::make_shared<const Image>(std::move(truth->image));
        for (ObjectsVariant& variant : variants) {
            if (auto measured = measure_error(city, truth->hits, exact, variant); !measured) {
                return measured;
            }
        }
        return time_all(city, std::move(variants), since_begin);
    }

    Result<void> measure_error(CityForms& city, const HitBuffer& truth,
                               const std::shared_ptr<const Image>& exact, ObjectsVariant& variant) {
        city.set_technique(variant.form, variant.technique);
        const auto stats = variant.renderer->draw(city.scene(variant.form), true);
        if (!stats) {
            return stats.error();
        }
        variant.row.objects->bytes = stats->upload_bytes; // the first frame of this renderer
        Image shown = variant.renderer->read_color();
        const auto hits = variant.renderer->draw_hits(city.scene(variant.form));
        if (!hits) {
            return hits.error();
        }
        auto geometric = city.errors(variant.form, *hits, truth);
        const auto image = truth::image_errors(
            shown, *exact, {.threads = static_cast<unsigned>(options_.suite.threads)});
        if (!geometric || !image) {
            return geometric ? image.error() : geometric.error();
        }
        variant.row.error = row_error_of(*geometric, *image);
        if (!options_.suite.keep_views || variant.row.null_row) {
            return {};
        }
        auto view = views_.make({std::move(shown), exact, std::move(geometric->reprojection.map)});
        if (!view) {
            return view.error();
        }
        variant.row.view = std::move(*view);
        return {};
    }

    DrawFrame frame_of(ObjectsVariant& variant, CityForms& city) const {
        return [&]() -> Result<void> {
            city.set_technique(variant.form, variant.technique);
            auto stats = variant.renderer->draw(city.scene(variant.form), true);
            if (!stats) {
                return stats.error();
            }
            variant.stats = *stats;
            return {};
        };
    }

    Result<void> time_all(CityForms& city, std::vector<ObjectsVariant> variants,
                          const Stopwatch& since_begin) {
        std::vector<DrawFrame> frames;
        frames.reserve(variants.size());
        for (ObjectsVariant& variant : variants) {
            frames.push_back(frame_of(variant, city));
        }
        const double share =
            group_seconds(options_.suite, since_run_.seconds(), parts_ - parts_done_);
        MeasureOptions timing = measuring(options_.suite, parts_, share - since_begin.seconds());
        timing.stop = stop_;
        timing.null_pair = {0, frames.size() - 1};
        const auto measurement = measure(frames, timing);
        if (!measurement) {
            return measurement.error();
        }
        const bool is_whole =
            std::none_of(measurement->ms.begin(), measurement->ms.end(),
                         [](const std::vector<double>& ms) { return ms.empty(); });
        if (!is_whole) {
            return {};
        }
        const double texture = median(measurement->ms.front());
        for (std::size_t i = 0; i < variants.size(); ++i) {
            Row& row = variants[i].row;
            row.timing = timed(measurement->ms[i], measurement->noise_floor);
            row.timing.ratio_to_texture = row.timing.ms.median / texture;
            row.timing.stats = variants[i].stats;
            results_.rows.push_back(std::move(row));
        }
        return {};
    }

    Results& results_;
    const ObjectsOptions& options_;
    std::stop_token stop_;
    cli::ProgressLine line_;
    RowViews views_;
    Stopwatch since_run_;
    bool is_software_ = true;
    Problems problems_;
    std::size_t parts_ = 1;
    std::size_t parts_done_ = 0;
};

} // namespace

Results run_objects(const ObjectsOptions& options, const std::stop_token& stop) {
    Results results;
    const auto done = ObjectsRun(results, options, stop).run();
    if (stop.stop_requested()) {
        results.stopped =
            Error{results.rows.empty() ? "interrupted before the first frame was timed"
                                       : "interrupted, the tables hold the views done until then"};
    } else if (!done) {
        results.stopped = done.error();
        results.failed = results.rows.empty();
    }
    return results;
}

} // namespace reljef::bench

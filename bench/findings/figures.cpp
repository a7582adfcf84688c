#include "bench/findings/figures.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "bench/suites/source_tests.h"
#include "engine/core/check.h"

namespace reljef::bench {
namespace {

double frames_per_second(const SourceMeasurement& measured, std::string_view technique) {
    const auto all = source_measurements();
    const auto found = std::find_if(all.begin(), all.end(), [&](const SourceMeasurement& other) {
        return other.test == measured.test && other.configuration == measured.configuration &&
               other.technique == technique;
    });
    check(found != all.end(), "a test of the sources without this technique");
    return found->fps;
}

double percent_lost(double fps, double texture_fps) {
    return 100.0 * (1.0 - fps / texture_fps);
}

} // namespace

Range at_least(double low) {
    Range range;
    range.low = low;
    return range;
}

Range at_most(double high) {
    Range range;
    range.high = high;
    return range;
}

Range between(double low, double high) {
    return {low, high};
}

RowName source_test(const std::string& test, const scene::Technique& technique) {
    return {"tables.json", {{"test", test}, {"label", scene::to_string(technique)}}};
}

RowName seen(const View& view, const scene::Technique& technique) {
    return {view.file,
            {{"scene", view.scene}, {"pose", view.pose}, {"label", scene::to_string(technique)}}};
}

View bricks() {
    return {"pareto.json", "tile brick", "oblique"};
}

View at_scale(const std::string& terrain, const std::string& scale) {
    return {"scales.json", fmt::format("{}, s = {}", terrain, scale), "oblique"};
}

RowName city(const CityView& view, const std::string& form, const scene::Technique& technique) {
    return {view.file,
            {{"scene", view.scene},
             {"test", fmt::format("from {} m, {} degrees down", view.distance, view.down)},
             {"label", fmt::format("{}: {}", form, scene::to_string(technique))}}};
}

RowName at_angle(const std::string& terrain, const std::string& angle,
                 const scene::Technique& technique) {
    return {"angles.json",
            {{"stress", "grazing view"},
             {"terrain", terrain},
             {"technique", scene::to_string(technique)},
             {"figure", "% of terrain wrong"},
             {"at", angle}}};
}

RowName irrlicht(int levels) {
    return {"peers.json",
            {{"pose", "overview"},
             {"what", fmt::format("irrlicht:lods={}", levels)},
             {"camera", "still"}}};
}

RowName peer(const std::string& work, const std::string& pose, const std::string& what) {
    return {"peers.json", {{"work", work}, {"pose", pose}, {"what", what}}};
}

Figure plain(const std::string& words, Quantity quantity, const RowName& row, const Range& range) {
    Figure figure;
    figure.words = words;
    figure.quantity = quantity;
    figure.row = row;
    figure.expected = range;
    return figure;
}

Figure ratio(const std::string& words, Quantity quantity, const RowName& row, const RowName& base,
             const Range& range) {
    Figure figure = plain(words, quantity, row, range);
    figure.form = Figure::Form::ratio;
    figure.base = base;
    return figure;
}

Figure drop(const std::string& words, const RowName& row, const RowName& base, const Range& range) {
    Figure figure = ratio(words, Quantity::ms, row, base, range);
    figure.form = Figure::Form::drop;
    return figure;
}

Figure frame_rate(const std::string& words, const RowName& row, const Range& range) {
    Figure figure = plain(words, Quantity::ms, row, range);
    figure.form = Figure::Form::rate;
    return figure;
}

std::vector<Figure> joined(std::vector<Figure> figures, const std::vector<Figure>& more) {
    figures.insert(figures.end(), more.begin(), more.end());
    return figures;
}

std::vector<Figure> named(const std::string& quantity, std::vector<Figure> figures) {
    for (Figure& figure : figures) {
        figure.words = fmt::format("{}, {}", quantity, figure.words);
    }
    return figures;
}

std::vector<Conclusion> joined(std::vector<Conclusion> conclusions,
                               const std::vector<Conclusion>& more) {
    conclusions.insert(conclusions.end(), more.begin(), more.end());
    return conclusions;
}

std::vector<Figure> on_gpu(std::vector<Figure> figures) {
    for (Figure& figure : figures) {
        figure.row.file = "h100/" + figure.row.file;
        if (figure.base) {
            figure.base->file = "h100/" + figure.base->file;
        }
    }
    return figures;
}

std::vector<Figure> and_on_gpu(const std::vector<Figure>& figures) {
    return joined(figures, on_gpu(figures));
}

std::vector<Figure> hidden_points(const std::string& file, const Technique& technique,
                                  const Range& range) {
    std::vector<Figure> figures;
    for (const auto& [words, scene, distance] : {std::tuple{"city", "urban", "300 m"},
                                                 {"city", "urban", "3 km"},
                                                 {"landscape", "natural", "3 km"},
                                                 {"landscape", "natural", "10 km"}}) {
        const RowName row{
            file, {{"scene", scene}, {"at", distance}, {"label", scene::to_string(technique)}}};
        figures.push_back(
            plain(fmt::format("{}, {}", words, distance), Quantity::hidden, row, range));
    }
    return figures;
}

ThesisDrop thesis_drop(const std::string& technique, const std::vector<std::string>& tests,
                       std::optional<int> machine) {
    ThesisDrop drop{.lowest = 100.0, .highest = -100.0};
    double count = 0.0;
    for (const SourceMeasurement& measured : source_measurements()) {
        const bool is_asked = std::find(tests.begin(), tests.end(), measured.test) != tests.end();
        if (!is_asked || measured.technique != technique ||
            (machine && measured.configuration != *machine)) {
            continue;
        }
        const double texture = frames_per_second(measured, "texture");
        const double lost = percent_lost(measured.fps, texture);
        // Each frame rate is within half a frame of the true one.
        drop.rounding += std::max(lost - percent_lost(measured.fps + 0.5, texture - 0.5),
                                  percent_lost(measured.fps - 0.5, texture + 0.5) - lost);
        drop.mean += lost;
        drop.lowest = std::min(drop.lowest, lost);
        drop.highest = std::max(drop.highest, lost);
        count += 1.0;
    }
    check(count > 0.0, "tests of the sources with this technique");
    drop.mean /= count;
    drop.rounding /= count;
    return drop;
}

Figure thesis_mean(const std::string& words, const ThesisDrop& drop, double text) {
    Figure figure;
    figure.words = words;
    figure.form = Figure::Form::constant;
    figure.constant = {drop.mean, 0.0};
    figure.expected = between(text - drop.rounding, text + drop.rounding);
    return figure;
}

} // namespace reljef::bench

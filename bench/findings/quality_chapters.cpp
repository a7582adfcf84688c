// What the steps of a search are worth, and what distance and angle change.
#include <fmt/format.h>

#include "bench/findings/conclusions.h"
#include "bench/findings/figures.h"

namespace reljef::bench {
namespace {

using scene::Interval;
using scene::Relief;
using scene::Steep;
using scene::Technique;

const char* const steps_file = "steps.json";

View steps_city() {
    return {steps_file, "urban, s = 0.05", "oblique"};
}

View steps_landscape() {
    return {steps_file, "natural", "oblique"};
}

View low_landscape() {
    return {"pareto-quick.json", "natural 257", "low"};
}

View small_city() {
    return {"pareto-quick.json", "urban 257", "oblique"};
}

// The quantity of a technique over that of another, in two views.
std::vector<Figure> in_views(const std::pair<View, View>& views, Quantity quantity,
                             const std::pair<Technique, Technique>& techniques,
                             const Range& range) {
    const auto& [first, second] = views;
    const auto& [technique, base] = techniques;
    return {ratio("city", quantity, seen(first, technique), seen(first, base), range),
            ratio("landscape", quantity, seen(second, technique), seen(second, base), range)};
}

std::vector<Figure> by_steps(Quantity quantity, const std::pair<Technique, Technique>& techniques,
                             const Range& range) {
    return in_views({steps_city(), steps_landscape()}, quantity, techniques, range);
}

std::vector<Figure> by_pareto(Quantity quantity, const std::pair<Technique, Technique>& techniques,
                              const Range& range) {
    return in_views({small_city(), low_landscape()}, quantity, techniques, range);
}

// "error, city" instead of "city".
std::vector<Figure> named(const std::string& quantity, std::vector<Figure> figures) {
    for (Figure& figure : figures) {
        figure.words = fmt::format("{}, {}", quantity, figure.words);
    }
    return figures;
}

std::vector<Figure> joined(std::vector<Figure> figures, std::vector<Figure> more) {
    for (Figure& figure : more) {
        figures.push_back(std::move(figure));
    }
    return figures;
}

std::vector<Conclusion> linear_search() {
    const Technique few{Steep{.linear_steps = 8}};
    const Technique many{Steep{.linear_steps = 64}};
    const Technique only_halving{Relief{.linear_steps = 1}};
    return {
        {"M 3.6.1", "More equal steps are more accurate.", "less error with 64 steps than with 8",
         by_pareto(Quantity::error_px, {many, few}, at_most(1.0))},
        {"M 3.6.1", "More equal steps are slower.", "more time with 64 steps than with 8",
         by_pareto(Quantity::ms, {many, few}, at_least(1.0))},
        {"J 2.4.7; M 3.6.2", "Halving alone jumps over the right hit: equal steps come first.",
         "at least twice as many wrong pixels as with 11 equal steps (our reading)",
         by_steps(Quantity::wrong, {only_halving, {Relief{}}}, at_least(2.0))},
        {"M 3.6.2", "20 steps and 4 halvings look better than 40 equal steps.",
         "fewer wrong pixels",
         by_steps(Quantity::wrong,
                  {{Relief{.linear_steps = 20, .bisection_steps = 4}}, {Steep{.linear_steps = 40}}},
                  at_most(1.0))},
        {"M 3.6.2", "They need less work, too.", "fewer taps (reads of maps)",
         by_steps(Quantity::taps,
                  {{Relief{.linear_steps = 20, .bisection_steps = 4}}, {Steep{.linear_steps = 40}}},
                  at_most(1.0))},
        {"J 2.4.7", "Eight halvings are enough.",
         "at most 1.05 times the wrong pixels of 16 halvings (our reading)",
         by_pareto(Quantity::wrong, {{Relief{}}, {Relief{.bisection_steps = 16}}}, at_most(1.05))},
        {"M 3.6.3",
         "The equal steps decide: refining afterwards cannot repair what they miss.",
         "with more refining, at least half of the wrong pixels stay (our reading)",
         {ratio("16 over 8 halvings, landscape", Quantity::wrong,
                seen(low_landscape(), {Relief{.bisection_steps = 16}}),
                seen(low_landscape(), {Relief{}}), at_least(0.5)),
          ratio("6 over 2 secants, landscape", Quantity::wrong,
                seen(low_landscape(), {Interval{.secant_steps = 6}}),
                seen(low_landscape(), {Interval{}}), at_least(0.5))}},
    };
}

std::vector<Conclusion> interval_search() {
    const Technique eight{Interval{.linear_steps = 8}};
    const std::pair against_relief{Technique{Interval{}}, Technique{Relief{}}};
    const View city{"oblique.json", "urban, s = 0.05", "oblique"};
    const View landscape{"oblique.json", "natural", "oblique"};
    return {
        {"M 3.6.3",
         "14 steps and 2 secants give a good picture.",
         "at most 10 % of the pixels wrong (our limit)",
         {plain("city", Quantity::wrong, seen(city, {Interval{}}), at_most(10.0)),
          plain("landscape", Quantity::wrong, seen(landscape, {Interval{}}), at_most(10.0)),
          plain("small city", Quantity::wrong, seen(small_city(), {Interval{}}), at_most(10.0)),
          plain("landscape, pose low", Quantity::wrong, seen(low_landscape(), {Interval{}}),
                at_most(10.0))}},
        {"M 3.6.3", "8 steps are too few for the secants.", "more wrong pixels than with 14 steps",
         by_pareto(Quantity::wrong, {eight, {Interval{}}}, at_least(1.0))},
        {"J 2.4.9", "Secants are faster than halvings.", "less time",
         in_views({city, landscape}, Quantity::ms, against_relief, at_most(1.0))},
        {"J 2.4.9", "Secants are more accurate than halvings.",
         "fewer wrong pixels, less error in pixels",
         joined(named("wrong",
                      in_views({city, landscape}, Quantity::wrong, against_relief, at_most(1.0))),
                named("error", in_views({city, landscape}, Quantity::error_px, against_relief,
                                        at_most(1.0))))},
    };
}

std::vector<Conclusion> steps_by_angle() {
    Technique by_angle{Relief{}};
    by_angle.options.steps = scene::StepRange{5, 25};
    Technique faded{Relief{}};
    faded.options.fade = scene::Fade{};
    const Technique everywhere{Relief{.linear_steps = 25}};
    const View bricks{"pareto-quick.json", "tile brick", "oblique"};
    return {
        {"M 3.6.4", "Steps by angle, 5 to 25, are as accurate as 25 everywhere.",
         "at most 1.25 times the wrong pixels (our reading)",
         by_steps(Quantity::wrong, {by_angle, everywhere}, at_most(1.25))},
        {"M 3.6.4", "They need less work than 25 everywhere.", "fewer taps",
         by_steps(Quantity::taps, {by_angle, everywhere}, at_most(1.0))},
        {"M 3.6.4",
         "Lower heights at flat angles remove errors.",
         "fewer wrong pixels",
         {ratio("bricks", Quantity::wrong, seen(bricks, faded), seen(bricks, {Relief{}}),
                at_most(1.0))}},
    };
}

// Wrong pixels of a technique over those of another, at an angle.
std::vector<Figure> at_one_angle(const std::string& angle, const Technique& technique,
                                 const Technique& base, const Range& range) {
    std::vector<Figure> figures;
    for (const auto& [words, terrain] : {std::pair{"city", "urban"}, {"landscape", "natural"}}) {
        figures.push_back(ratio(words, Quantity::percent, at_angle(terrain, angle, technique),
                                at_angle(terrain, angle, base), range));
    }
    return figures;
}

// Wrong pixels at one angle over those at another.
Figure over_angle(const std::string& words, const std::string& terrain,
                  const Technique& technique) {
    return ratio(words, Quantity::percent, at_angle(terrain, "10 degrees", technique),
                 at_angle(terrain, "90 degrees", technique), at_least(2.0));
}

std::vector<Conclusion> angle_conclusions() {
    const Technique parallax{scene::Parallax{}};
    return {
        {"J 2.3, 2.7.1; M 3.5; D", "At flat angles, parallax deforms and flattens the surface.",
         "at 1 degree, at least 0.9 times the wrong pixels of a plain texture (our reading)",
         at_one_angle("1 degrees", parallax, {scene::Texture{}}, at_least(0.9))},
        {"D",
         "Seen from straight above, the shift of parallax is acceptable.",
         "at 90 degrees, at most 10 % of the pixels wrong (our limit)",
         {plain("city", Quantity::percent, at_angle("urban", "90 degrees", parallax),
                at_most(10.0)),
          plain("landscape", Quantity::percent, at_angle("natural", "90 degrees", parallax),
                at_most(10.0))}},
        {"M 3.6.1, 3.6.3",
         "The accuracy of equal steps depends strongly on the angle.",
         "at 10 degrees, at least twice the wrong pixels of 90 degrees (our reading)",
         {over_angle("city", "urban", {Relief{}}), over_angle("landscape", "natural", {Relief{}}),
          over_angle("city, no halving", "urban", {Steep{}}),
          over_angle("landscape, no halving", "natural", {Steep{}})}},
    };
}

RowName at_distance(const std::string& scene, const std::string& distance,
                    const Technique& technique) {
    return {"distance.json",
            {{"scene", scene}, {"at", distance}, {"label", scene::to_string(technique)}}};
}

Figure of_city(const std::string& distance, const Technique& technique, const Range& range) {
    return plain(distance, Quantity::error_px, at_distance("urban", distance, technique), range);
}

// Of texture, parallax and relief, for each distance.
std::vector<Figure> errors_of_city(const std::vector<std::string>& distances) {
    std::vector<Figure> figures;
    for (const std::string& distance : distances) {
        for (const Technique& technique :
             {Technique{scene::Texture{}}, Technique{scene::Parallax{}}, Technique{Relief{}}}) {
            figures.push_back(
                plain("", Quantity::error_px, at_distance("urban", distance, technique), {}));
        }
    }
    return figures;
}

std::vector<Conclusion> distance_conclusions() {
    const Technique texture{scene::Texture{}};
    const Technique parallax{scene::Parallax{}};
    return {
        {"J 3",
         "From several kilometres on, nobody notices the depth of a city.",
         "the error of a plain texture is at most 1 pixel (our reading)",
         {of_city("3 km", texture, at_most(1.0)), of_city("10 km", texture, at_most(1.0))}},
        {"J 3",
         "There, parallax is the alternative.",
         "its error is at most 1 pixel (our reading)",
         {of_city("3 km", parallax, at_most(1.0)), of_city("10 km", parallax, at_most(1.0))}},
        {"J 3",
         "Parallax is useful at large and middle distances.",
         "at most half of the error of a plain texture (our reading)",
         {ratio("city, 300 m", Quantity::error_px, at_distance("urban", "300 m", parallax),
                at_distance("urban", "300 m", texture), at_most(0.5)),
          ratio("city, 1 km", Quantity::error_px, at_distance("urban", "1 km", parallax),
                at_distance("urban", "1 km", texture), at_most(0.5)),
          ratio("city, 10 km", Quantity::error_px, at_distance("urban", "10 km", parallax),
                at_distance("urban", "10 km", texture), at_most(0.5)),
          ratio("landscape, 10 km", Quantity::error_px, at_distance("natural", "10 km", parallax),
                at_distance("natural", "10 km", texture), at_most(0.5))}},
        {"J 2.7.2, 3",
         "Relief shows a city well from middle and fairly small distances.",
         "error of at most 1 pixel (our reading)",
         {of_city("300 m", {Relief{}}, at_most(1.0)), of_city("1 km", {Relief{}}, at_most(1.0))}},
        {"J 2.7.2",
         "Relief is not usable very near, as from a plane at 100 m.",
         "error of more than 1 pixel (our reading)",
         {of_city("100 m", {Relief{}}, at_least(1.0))}},
    };
}

std::vector<Conclusion> view_conclusions() {
    const View overview{"pareto-quick.json", "natural 257", "overview"};
    return {
        {"J 2.7",
         "Where a view shows less of the terrain, it is drawn faster.",
         "less time for pose low than for overview",
         {ratio("triangles", Quantity::ms, seen(low_landscape(), {scene::Polygons{}}),
                seen(overview, {scene::Polygons{}}), at_most(1.0)),
          ratio("relief", Quantity::ms, seen(low_landscape(), {Relief{}}),
                seen(overview, {Relief{}}), at_most(1.0)),
          ratio("exact", Quantity::ms, seen(low_landscape(), {scene::Exact{}}),
                seen(overview, {scene::Exact{}}), at_most(1.0))}},
    };
}

void add(Chapter& chapter, std::vector<Conclusion> more) {
    for (Conclusion& conclusion : more) {
        chapter.conclusions.push_back(std::move(conclusion));
    }
}

} // namespace

Chapter search_chapter() {
    const View city{"oblique.json", "urban, s = 0.05", "oblique"};
    Chapter chapter{"Which search finds the hit?"};
    chapter.answer = {
        {"Over the city, {} of the pixels of 32 equal steps are wrong, {} of 11 steps with 8 "
         "halvings, {} of 14 steps with 2 secants, and {} of exact rays.",
         {plain("", Quantity::wrong, seen(city, {Steep{}}), {}),
          plain("", Quantity::wrong, seen(city, {Relief{}}), {}),
          plain("", Quantity::wrong, seen(city, {Interval{}}), {}),
          plain("", Quantity::wrong, seen(city, {scene::Exact{}}), {})}}};
    add(chapter, linear_search());
    add(chapter, interval_search());
    add(chapter, steps_by_angle());
    return chapter;
}

Chapter view_chapter() {
    Chapter chapter{"What do distance and angle change?"};
    chapter.answer = {
        {"Over the landscape, {} of the pixels of parallax are wrong from straight above, and {} "
         "at 1 degree; of relief, {} and {}.",
         {plain("", Quantity::percent, at_angle("natural", "90 degrees", {scene::Parallax{}}), {}),
          plain("", Quantity::percent, at_angle("natural", "1 degrees", {scene::Parallax{}}), {}),
          plain("", Quantity::percent, at_angle("natural", "90 degrees", {Relief{}}), {}),
          plain("", Quantity::percent, at_angle("natural", "1 degrees", {Relief{}}), {})}},
        {"Seen from 1 km, a plain texture of the city is off by {}, parallax by {}, and relief by "
         "{}; from 10 km, by {}, {} and {}.",
         errors_of_city({"1 km", "10 km"})}};
    add(chapter, angle_conclusions());
    add(chapter, distance_conclusions());
    add(chapter, view_conclusions());
    return chapter;
}

} // namespace reljef::bench

// What the steps of a search are worth, and what distance and angle change.
#include <utility>

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
    return {"pareto.json", "natural", "low"};
}

View pareto_city() {
    return {"pareto.json", "urban", "oblique"};
}

RowName at_distance(const std::string& scene, const std::string& distance,
                    const Technique& technique) {
    return {"distance.json",
            {{"scene", scene}, {"at", distance}, {"label", scene::to_string(technique)}}};
}

Figure of_city(const std::string& distance, const Technique& technique, const Range& range) {
    return plain(distance, Quantity::error_px, at_distance("urban", distance, technique), range);
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
    std::vector<Figure> figures =
        in_views({pareto_city(), low_landscape()}, quantity, techniques, range);
    figures[1].words = "landscape, low";
    return figures;
}

Technique five_and_halving() {
    return {Relief{.linear_steps = 5, .bisection_steps = 4}};
}

// `figure(view, words)` of the city and the landscape at both scales.
template <class Make> std::vector<Figure> by_scale(const Make& figure) {
    std::vector<Figure> figures;
    for (const char* const scale : {"0.04", "0.15"}) {
        figures.push_back(figure(at_scale("urban", scale), fmt::format("city, scale {}", scale)));
        figures.push_back(
            figure(at_scale("natural", scale), fmt::format("landscape, scale {}", scale)));
    }
    return figures;
}

std::vector<Conclusion> five_steps() {
    return {
        {"M 3.6.2", "With halvings, even 5 steps are much better than 5 equal steps alone.",
         "at most half of the wrong pixels (our reading of \"much\")",
         by_scale([](const View& view, const std::string& words) {
             return ratio(words, Quantity::wrong, seen(view, five_and_halving()),
                          seen(view, {Steep{.linear_steps = 5}}), at_most(0.5));
         }),
         "",
         "Halving refines a hit. It cannot find a wall that the steps missed. Over high terrain, "
         "the "
         "steps miss most."},
        {"M 3.6.2", "Still, with 5 steps there are errors in quite many places.",
         "more than 10 % of the pixels wrong (our limit)",
         by_scale([](const View& view, const std::string& words) {
             return plain(words, Quantity::wrong, seen(view, five_and_halving()), at_least(10.0));
         }),
         "scale: heights over width",
         "A step over low heights passes few samples, one over high heights many, and a ray may "
         "pass through a wall between two steps."},
    };
}

std::vector<Conclusion> linear_search() {
    const Technique few{Steep{.linear_steps = 8}};
    const Technique many{Steep{.linear_steps = 64}};
    const Technique only_halving{Relief{.linear_steps = 1}};
    const Technique twenty{Relief{.linear_steps = 20, .bisection_steps = 4}};
    const Technique forty{Steep{.linear_steps = 40}};
    return {
        {"M 3.6.1", "More equal steps are more accurate.", "less error with 64 steps than with 8",
         by_pareto(Quantity::error_px, {many, few}, at_most(1.0))},
        {"M 3.6.1", "More equal steps are slower.", "more time with 64 steps than with 8",
         by_pareto(Quantity::ms, {many, few}, at_least(1.0))},
        {"J 2.4.7; M 3.6.2", "Halving alone jumps over the right hit: equal steps come first.",
         "at least twice as many wrong pixels as with 11 equal steps (our reading)",
         by_steps(Quantity::wrong, {only_halving, {Relief{}}}, at_least(2.0)), "",
         "Halving finds the hit of a ray that crosses the surface once. Only rays that cross it "
         "several times go wrong, and from this height the city has fewer of them."},
        {"M 3.6.2", "20 steps and 4 halvings look better than 40 equal steps.",
         "less difference (FLIP) from the true picture, and fewer wrong pixels",
         joined(named("FLIP", by_steps(Quantity::flip, {twenty, forty}, at_most(1.0))),
                named("wrong", by_steps(Quantity::wrong, {twenty, forty}, at_most(1.0))))},
        {"M 3.6.2", "They need less work, too.", "fewer taps (reads of maps)",
         by_steps(Quantity::taps, {twenty, forty}, at_most(1.0))},
        {"J 2.4.7", "Eight halvings are enough.",
         "at most 1.05 times the wrong pixels of 16 halvings, and an error of at most 1 pixel (our "
         "reading)",
         joined(named("wrong",
                      by_pareto(Quantity::wrong, {{Relief{}}, {Relief{.bisection_steps = 16}}},
                                at_most(1.05))),
                {plain("error, landscape, low", Quantity::error_px,
                       seen(low_landscape(), {Relief{}}), at_most(1.0)),
                 plain("error, city from 100 m", Quantity::error_px,
                       at_distance("urban", "100 m", {Relief{}}), at_most(1.0))}),
         "",
         "More halvings find no wall that the steps missed, but they end closer to the surface "
         "that was found: a place is off by a 256th of a step after eight. From near, that is more "
         "than a pixel."},
        {"M 3.6.3",
         "The equal steps decide: refining afterwards cannot repair what they miss.",
         "with more refining, at least half of the wrong pixels stay (our reading)",
         {ratio("16 over 8 halvings, landscape, low", Quantity::wrong,
                seen(low_landscape(), {Relief{.bisection_steps = 16}}),
                seen(low_landscape(), {Relief{}}), at_least(0.5)),
          ratio("6 over 2 secants, landscape, low", Quantity::wrong,
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
          plain("landscape, low", Quantity::wrong, seen(low_landscape(), {Interval{}}),
                at_most(10.0))},
         "",
         "In a low view rays are flat, and pass several samples in a step."},
        {"M 3.6.3",
         "8 steps are too few for the secants.",
         "more than 10 % of the pixels wrong (our limit)",
         {plain("city", Quantity::wrong, seen(pareto_city(), eight), at_least(10.0)),
          plain("landscape, low", Quantity::wrong, seen(low_landscape(), eight), at_least(10.0))}},
        {"J 2.4.9", "Secants are faster than halvings.", "less time",
         and_on_gpu(in_views({city, landscape}, Quantity::ms, against_relief, at_most(1.0))), "",
         "The noise of a run is larger than the difference."},
        {"J 2.4.9", "Secants are more accurate than halvings.",
         "fewer wrong pixels, less error in pixels",
         joined(named("wrong",
                      in_views({city, landscape}, Quantity::wrong, against_relief, at_most(1.0))),
                named("error", in_views({city, landscape}, Quantity::error_px, against_relief,
                                        at_most(1.0)))),
         "",
         "14 equal steps miss fewer walls than 11. But a secant takes the surface between two "
         "steps for straight, so two of them end farther from a curved surface than eight "
         "halvings."},
    };
}

// Of bricks at a flat angle, with lower heights there over without.
Figure with_fade(const std::string& words, const Technique& technique) {
    const View view{"bricks-grazing.json", "tile brick", "grazing"};
    Technique faded = technique;
    faded.options.fade = scene::Fade{};
    return ratio(words, Quantity::flip, seen(view, faded), seen(view, technique), at_most(1.0));
}

std::vector<Conclusion> steps_by_angle() {
    Technique by_angle{Relief{}};
    by_angle.options.steps = scene::StepRange{5, 25};
    const Technique everywhere{Relief{.linear_steps = 25}};
    return {
        {"M 3.6.4", "Steps by angle, 5 to 25, are as accurate as 25 everywhere.",
         "at most 1.25 times the wrong pixels (our reading)",
         by_steps(Quantity::wrong, {by_angle, everywhere}, at_most(1.25)), "",
         "Steep rays get few steps, and a wall that is thinner than a step is missed at any "
         "angle."},
        {"M 3.6.4", "They need less work than 25 everywhere.", "fewer taps",
         by_steps(Quantity::taps, {by_angle, everywhere}, at_most(1.0))},
        {.source = "M 3.6.4",
         .claim = "Lower heights at flat angles remove errors.",
         .rule = "less difference (FLIP) from the true picture",
         .figures = {with_fade("bricks, grazing", {Relief{}}),
                     with_fade("with 5 steps", {Relief{.linear_steps = 5}})},
         .reason = "They remove missed hits, but a lower surface is another one: where it is "
                   "lowered, each pixel shows a wrong point."},
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
        {.source = "D",
         .claim = "Seen from straight above, the shift of parallax is acceptable.",
         .rule = "at 90 degrees, at most 10 % of the pixels wrong (our limit)",
         .figures = {plain("city", Quantity::percent, at_angle("urban", "90 degrees", parallax),
                           at_most(10.0)),
                     plain("landscape", Quantity::percent,
                           at_angle("natural", "90 degrees", parallax), at_most(10.0))},
         .note = "heights of 0.14 and 0.18 of the width; D's are 0.04",
         .reason = "Only the middle of a picture is seen from straight above. Towards its border "
                   "rays are inclined, and the shift passes over slopes and walls."},
        {.source = "M 3.6.1, 3.6.3",
         .claim = "The accuracy of equal steps depends strongly on the angle.",
         .rule = "at 10 degrees, at least twice the wrong pixels of 90 degrees (our reading)",
         .figures = {over_angle("city", "urban", {Relief{}}),
                     over_angle("landscape", "natural", {Relief{}}),
                     over_angle("city, no halving", "urban", {Steep{}}),
                     over_angle("landscape, no halving", "natural", {Steep{}})},
         .reason = "Without halving, many pixels are wrong from above already: steps end too far "
                   "behind the surface at any angle."},
    };
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

// The error of parallax over that of a plain texture.
Figure lead_of_parallax(const std::string& words, const std::string& scene,
                        const std::string& distance) {
    return ratio(fmt::format("{}, {}", words, distance), Quantity::error_px,
                 at_distance(scene, distance, {scene::Parallax{}}),
                 at_distance(scene, distance, {scene::Texture{}}), at_most(0.5));
}

// How a technique looks from a distance over a city, beside exact rays.
Figure as_seen(const std::string& distance, const Technique& technique) {
    return ratio(distance, Quantity::flip, at_distance("urban", distance, technique),
                 at_distance("urban", distance, {scene::Exact{}}), at_most(1.25));
}

// The time of parallax over that of a plain texture, over a city.
Figure time_of_parallax(int distance, const Range& range) {
    const CityView view{"objects.json", "urban 1024", distance};
    return ratio(fmt::format("{} m", distance), Quantity::ms,
                 city(view, "heights", {scene::Parallax{}}),
                 city(view, "heights", {scene::Texture{}}), range);
}

// The error of parallax from one distance over that from the next one.
Figure nearer(const std::string& words, const std::string& scene, const std::string& near,
              const std::string& far) {
    return ratio(fmt::format("{}, {} over {}", words, near, far), Quantity::error_px,
                 at_distance(scene, near, {scene::Parallax{}}),
                 at_distance(scene, far, {scene::Parallax{}}), at_least(1.0));
}

std::vector<Conclusion> distances_of_parallax() {
    const Technique texture{scene::Texture{}};
    const Technique parallax{scene::Parallax{}};
    return {
        {.source = "J 3",
         .claim = "From several kilometres on, one hardly notices the depth of a city.",
         .rule = "a plain texture has at most 1.25 times the difference (FLIP) of exact rays from "
                 "the true picture (our reading)",
         .figures = {as_seen("3 km", texture), as_seen("10 km", texture)},
         .reason = "From 3 km, the shape of large buildings is still some pixels wide."},
        {.source = "J 3",
         .claim = "There, parallax is the alternative.",
         .rule = "the same for parallax",
         .figures = {as_seen("3 km", parallax), as_seen("10 km", parallax)},
         .reason = "From 3 km, the shape of large buildings is still some pixels wide."},
        {"J 3",
         "Parallax is useful at large and middle distances.",
         "at most half of the error of a plain texture (our reading)",
         {lead_of_parallax("city", "urban", "300 m"), lead_of_parallax("city", "urban", "1 km"),
          lead_of_parallax("city", "urban", "10 km"),
          lead_of_parallax("landscape", "natural", "10 km")}},
        {.source = "J 3",
         .claim = "There, its cost goes unnoticed.",
         .rule = "at most 1.25 times the time of a plain texture (J's range)",
         .figures = {time_of_parallax(300, at_most(1.25)), time_of_parallax(1000, at_most(1.25)),
                     time_of_parallax(3000, at_most(1.25))},
         .note = "over 476 buildings",
         .reason = "Its cost is one of pixels: from 300 m the city fills the picture, from 3 km a "
                   "small part of it."},
        {"J 2.7.2, 3",
         "Parallax gets worse as the eye comes near.",
         "more error in pixels than from about three times as far",
         {nearer("city", "urban", "100 m", "300 m"), nearer("city", "urban", "300 m", "1 km"),
          nearer("city", "urban", "1 km", "3 km"), nearer("landscape", "natural", "1 km", "3 km"),
          nearer("landscape", "natural", "3 km", "10 km")}},
    };
}

Figure named_figure(const std::string& words, Figure figure) {
    figure.words = words;
    return figure;
}

Figure wrong_of_city(const std::string& distance) {
    return plain("wrong, " + distance, Quantity::wrong, at_distance("urban", distance, {Relief{}}),
                 at_most(10.0));
}

std::vector<Conclusion> distances_of_relief() {
    const Technique parallax{scene::Parallax{}};
    const Technique finer{Relief{.bisection_steps = 16}};
    return {
        {.source = "J 2.7.2, 3",
         .claim = "Relief shows a city well from middle and fairly small distances.",
         .rule =
             "at most 10 % of the pixels wrong (our limit), error of at most 1 pixel (our reading)",
         .figures = {wrong_of_city("300 m"), wrong_of_city("1 km"),
                     of_city("300 m", {Relief{}}, at_most(1.0)),
                     of_city("1 km", {Relief{}}, at_most(1.0))},
         .reason =
             "Its steps miss walls. The error in pixels does not see that: a ray that misses a "
             "wall shows the ground behind it in its right place."},
        {.source = "J 2.7.2",
         .claim = "Relief is not usable very near, as from a plane at 100 m.",
         .rule = "error of more than 1 pixel, also with 16 halvings (our reading)",
         .figures = {of_city("100 m", {Relief{}}, at_least(1.0)),
                     named_figure("16 halvings, 100 m", of_city("100 m", finer, at_least(1.0)))},
         .reason = "From near, a 256th of a step is more than a pixel. Eight more halvings end "
                   "that. The missed walls stay."},
        {"J 2.3; D", "Parallax knows no occlusion.",
         "at least 10 % of its pixels show a point that nearer ground hides (our limit)",
         hidden_points("distance.json", {scene::Parallax{}}, at_least(10.0))},
        {"J 2.4.6", "Relief occludes itself correctly.",
         "at most 1 % of its pixels show a point that nearer ground hides (our reading)",
         hidden_points("distance.json", {Relief{}}, at_most(1.0)), "",
         "Where a wall or a ridge is thinner than a step, its equal steps pass through it and find "
         "the ground behind."},
        {.source = "J 3",
         .claim = "Relief of a city pays at middle distances only.",
         .rule =
             "from 100 m relief is off by more than 1 pixel, also with 16 halvings; from 1 km it "
             "is not, but parallax is; from 10 km parallax is not either",
         .figures = {named_figure("relief, 100 m", of_city("100 m", {Relief{}}, at_least(1.0))),
                     named_figure("16 halvings, 100 m", of_city("100 m", finer, at_least(1.0))),
                     named_figure("relief, 1 km", of_city("1 km", {Relief{}}, at_most(1.0))),
                     named_figure("parallax, 1 km", of_city("1 km", parallax, at_least(1.0))),
                     named_figure("parallax, 10 km", of_city("10 km", parallax, at_most(1.0)))},
         .reason = "From far, parallax suffices. From near it is J's number of halvings that ends "
                   "the use of relief, not relief itself."},
    };
}

std::vector<Conclusion> view_conclusions() {
    const View overview{"pareto.json", "natural", "overview"};
    return {
        {.source = "J 2.7",
         .claim = "Where a view shows less of the terrain, it is drawn faster.",
         .rule = "less time for pose low than for overview",
         .figures = {ratio("triangles", Quantity::ms, seen(low_landscape(), {scene::Polygons{}}),
                           seen(overview, {scene::Polygons{}}), at_most(1.0)),
                     ratio("relief", Quantity::ms, seen(low_landscape(), {Relief{}}),
                           seen(overview, {Relief{}}), at_most(1.0)),
                     ratio("exact", Quantity::ms, seen(low_landscape(), {scene::Exact{}}),
                           seen(overview, {scene::Exact{}}), at_most(1.0))},
         .reason = "Triangles outside of the view are skipped. Rays cost by pixels, and a low view "
                   "has nearly as many, at flatter angles."},
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
    add(chapter, ray_searches());
    add(chapter, linear_search());
    add(chapter, five_steps());
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
    add(chapter, distances_of_parallax());
    add(chapter, distances_of_relief());
    add(chapter, view_conclusions());
    return chapter;
}

} // namespace reljef::bench

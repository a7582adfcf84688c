// What the findings come down to, and how far they hold.
#include <fmt/format.h>

#include "bench/findings/conclusions.h"
#include "bench/findings/figures.h"

namespace reljef::bench {
namespace {

using scene::Technique;

Figure lost(const std::string& test, const Technique& technique, const Range& range) {
    return drop("", source_test(test, technique), source_test(test, {scene::Texture{}}), range);
}

Figure wrong(const std::string& test, const Technique& technique, const Range& range) {
    return plain("", Quantity::wrong, source_test(test, technique), range);
}

Figure from_afar(const std::string& distance, const Technique& technique, const Range& range) {
    return plain("", Quantity::error_px,
                 {"distance.json",
                  {{"scene", "urban"}, {"at", distance}, {"label", scene::to_string(technique)}}},
                 range);
}

Figure with_gpu(const Figure& figure) {
    return and_on_gpu({figure}).back();
}

// Relief over the buildings and their ground as triangles.
Figure over_objects(Quantity quantity, const CityView& view) {
    return ratio("", quantity, city(view, "heights", {scene::Relief{}}),
                 city(view, "meshes", {scene::Polygons{.error = 1.0}}), {});
}

// Relief over exact rays.
Figure over_rays(const CityView& view) {
    return ratio("", Quantity::flip, city(view, "heights", {scene::Relief{}}),
                 city(view, "heights", {scene::Exact{}}), at_most(1.25));
}

} // namespace

std::vector<Chapter::Sentence> findings_summary() {
    const CityView built_in_city{"objects.json", "urban 1024", 1000};
    const CityView delft_city{"objects-delft.json", "Delft", 1000};
    const CityView ann_arbor_city{"objects-annarbor.json", "Ann Arbor", 1000};
    const Technique relief{scene::Relief{}};
    const Technique parallax{scene::Parallax{}};
    const Technique bounded{scene::Polygons{.error = 1.0}};
    const Figure over_relief = ratio("", Quantity::ms, source_test("relief-4", bounded),
                                     source_test("relief-4", relief), at_most(1.0));
    return {
        {"**Relief is accurate and expensive, as J says.** Over a landscape it costs {} of the "
         "frame "
         "rate on a CPU and {} on a GPU, and {} of its pixels are wrong. Over a city {} are: its "
         "steps miss walls. With a graphics card of today, such frames come at {}.",
         {lost("relief-4", relief, at_least(50.0)),
          with_gpu(lost("relief-4", relief, at_least(50.0))),
          wrong("relief-4", relief, at_most(10.0)), wrong("relief-2", relief, {}),
          with_gpu(frame_rate("", source_test("relief-4", relief), at_least(60.0)))}},
        {"**Parallax is cheap and wrong.** It costs {} on a CPU and {} on a GPU, and {} of its "
         "pixels over a landscape show a wrong point. J judged it by eye.",
         {lost("parallax-3", parallax, {}), with_gpu(lost("parallax-3", parallax, at_most(25.0))),
          wrong("parallax-3", parallax, at_least(10.0))}},
        {"**From far, parallax suffices; from near, relief needs more halvings than J's eight.** "
         "From "
         "10 km over a city, parallax is off by {}. From 1 km it is off by {}, and relief by {}. "
         "From 100 m relief is off by {}, and with 16 halvings by {}.",
         {from_afar("10 km", parallax, at_most(1.0)), from_afar("1 km", parallax, at_least(1.0)),
          from_afar("1 km", relief, at_most(1.0)), from_afar("100 m", relief, at_least(1.0)),
          from_afar("100 m", {scene::Relief{.bisection_steps = 16}}, at_most(1.0))}},
        {"**Relief saves time over buildings, and looks like them from far only.** From 1 km, 15 "
         "degrees above the horizon, it takes {}, {} and {} the time of buildings and ground as "
         "triangles (built-in city, Ann Arbor, Delft). Its picture differs {}, {} and {} as much "
         "from the true one (FLIP). The map of heights is the reason, not the search: exact rays "
         "over the same heights differ nearly as much (relief over these: {}, {} and {}).",
         {over_objects(Quantity::ms, built_in_city), over_objects(Quantity::ms, ann_arbor_city),
          over_objects(Quantity::ms, delft_city), over_objects(Quantity::flip, built_in_city),
          over_objects(Quantity::flip, ann_arbor_city), over_objects(Quantity::flip, delft_city),
          over_rays(built_in_city), over_rays(ann_arbor_city), over_rays(delft_city)}},
        {"**On terrain, triangles win, if a bound on their error chooses them.** Within one pixel, "
         "they take {} the time of relief on a CPU and {} on a GPU. J's five levels are faster "
         "still, and {} of their pixels are wrong.",
         {over_relief, with_gpu(over_relief),
          wrong("relief-4", {scene::Polygons{.max_levels = 5}}, {})}},
        {"**Heights cannot be guessed from colours.** Over Crater Lake the guess is {} as wrong as "
         "no heights at all.",
         {ratio("", Quantity::error_px,
                {"guesses.json", {{"scene", "crater lake"}, {"heights", "guessed"}}},
                {"guesses.json", {{"scene", "crater lake"}, {"heights", "flat"}}}, at_least(1.0))}},
    };
}

std::string findings_limits() {
    return R"(- The sources did not publish their terrains and programs. The city and the landscape are built in. Delft, Ann Arbor,
  Crater Lake and the Alps (where Irrlicht draws, too) are real.
- *Wrong* counts places, not impressions. An eye may forgive a wrong place with the right light, and none of our figures
  says when.
- The error in pixels compares a place with the pixel that shows it. A ray that misses a wall shows the ground behind in
  its right place, so that this error is small; *wrong* and *hidden* count it.
- The words of the sources are vague. Where a limit is ours, another one may give another verdict; the figure stands
  beside it.
- The tests of J have frames of 1024 × 768 pixels, on a CPU with two threads. More pixels cost techniques of rays more,
  and triangles little more.
- One graphics card was measured, made for data centres, with an earlier version. Rows without *GPU* say nothing about
  one: bump and normal maps, shadows, edges, layers and objects. Its clock changes within a run, and the noise of its
  times is large.
- Not measured: relief near and parallax far in one view (J 3); relief seen from behind (M 3.6.8) and beyond the border
  (M 3.6.11); relief on curved surfaces (J 2.4.6); displacement of few polygons (M 3.1); other curves of lower heights
  and other numbers of steps for shadows (M 3.6.4, 3.6.5); lower heights at cut borders (M 3.6.11); the other way to
  find edges (M 3.6.7); on which surfaces normal maps suffice (M 3.4); tangents along the texture (D).
- A height map of a city has one colour a sample, and few of them on walls. Buildings as meshes have façades. FLIP sees
  this, too.
- J guesses heights by a filter of specular light; what the filter computes is not given. Our guess takes brightness as
  height.
- A time holds for its machine, a ratio within its run. Machines of one letter may differ in speed.
)";
}

} // namespace reljef::bench

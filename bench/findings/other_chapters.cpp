// What light alone can show, what options cost, and what data are needed.
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "bench/findings/conclusions.h"
#include "bench/findings/figures.h"

namespace reljef::bench {
namespace {

using scene::Technique;

constexpr double small_loss = 25.0; // percent of the frame rate: the most that J calls small

Figure brick_cost(const std::string& words, const Technique& technique, const Technique& base,
                  const Range& range) {
    return drop(words, seen(bricks(), technique), seen(bricks(), base), range);
}

Figure brick_time(const std::string& words, const Technique& technique, const Technique& base,
                  const Range& range) {
    return ratio(words, Quantity::ms, seen(bricks(), technique), seen(bricks(), base), range);
}

// The error of guessed heights over that of flat ground.
Figure guess(const std::string& words, const std::string& scene, const std::string& heights,
             const Range& range) {
    const auto row = [&](const std::string& kind) {
        return RowName{"guesses.json", {{"scene", scene}, {"heights", kind}}};
    };
    return ratio(words, Quantity::error_px, row(heights), row("flat"), range);
}

std::vector<Figure> all_guesses() {
    const Range good = at_most(0.5);
    return {guess("city", "urban", "guessed", good),
            guess("landscape", "natural", "guessed", good),
            guess("Crater Lake", "crater lake", "guessed", good),
            guess("city, fitted", "urban", "fitted", good),
            guess("landscape, fitted", "natural", "fitted", good),
            guess("Crater Lake, fitted", "crater lake", "fitted", good)};
}

// Rows of claims.json.
RowName claim(const std::string& scene, const std::string& pose, const std::string& form,
              const Technique& technique) {
    return {
        "claims.json",
        {{"scene", scene}, {"pose", pose}, {"form", form}, {"label", scene::to_string(technique)}}};
}

// Relief on copies of a tile, and its memory over that of one terrain.
std::vector<Figure> repeated_tile() {
    const Technique relief{scene::Relief{}};
    std::vector<Figure> figures;
    for (const char* const scene : {"4 × 4 tiles of 256 cells", "8 × 8 tiles of 256 cells"}) {
        for (const char* const pose : {"overview", "oblique"}) {
            figures.push_back(plain(fmt::format("{}, {}", scene, pose), Quantity::wrong,
                                    claim(scene, pose, "one tile", relief), at_most(10.0)));
        }
        figures.push_back(ratio("memory", Quantity::bytes,
                                claim(scene, "overview", "one tile", relief),
                                claim(scene, "overview", "one terrain", relief), at_most(1.0)));
    }
    return figures;
}

// Relief over a city only, over relief on the whole terrain.
std::vector<Figure> relief_over_city() {
    const Technique relief{scene::Relief{}};
    const std::string scene = "8 × 8 pieces of 128 cells, 4 × 4 with buildings";
    std::vector<Figure> figures;
    for (const char* const pose : {"overview", "oblique"}) {
        const RowName city_only = claim(scene, pose, "city only", relief);
        const RowName everywhere = claim(scene, pose, "one terrain", relief);
        figures.push_back(ratio(fmt::format("{}, time", pose), Quantity::ms, city_only, everywhere,
                                at_most(1.0)));
        figures.push_back(ratio("taps", Quantity::taps, city_only, everywhere, at_most(1.0)));
        figures.push_back(ratio("wrong", Quantity::wrong, city_only, everywhere, {}));
    }
    return figures;
}

View bricks_from(const std::string& pose) {
    return {fmt::format("bricks-{}.json", pose), "tile brick", pose};
}

std::string pose_words(const std::string& pose) {
    return pose == "map" ? "from straight above" : pose;
}

// Of the pictures of bricks by two techniques.
Figure picture(const std::string& words, const std::string& pose, Quantity quantity,
               const Technique& technique, const Technique& base, const Range& range) {
    return ratio(words.empty() ? pose_words(pose) : fmt::format("{}, {}", words, pose_words(pose)),
                 quantity, seen(bricks_from(pose), technique), seen(bricks_from(pose), base),
                 range);
}

// Both phases of warping over the first alone.
Figure warping_over_moving() {
    const std::string scene = "8 × 8 pieces of 128 cells, 4 × 4 with buildings";
    const Technique prewarp{scene::Prewarp{}};
    return ratio("moved and rebuilt, over moved only", Quantity::ms,
                 claim(scene, "oblique", "moved and rebuilt", prewarp),
                 claim(scene, "oblique", "moved points", prewarp), at_least(3.0));
}

Technique smooth_relief() {
    Technique technique{scene::Relief{}};
    technique.options.smooth_edges = scene::SmoothEdges{};
    return technique;
}

Technique shadowed(Technique technique, double depth) {
    technique.options.shadow = scene::Shadow{depth};
    return technique;
}

Technique shadowed_relief(double depth) {
    return shadowed({scene::Relief{}}, depth);
}

Technique outlined_relief() {
    Technique technique{scene::Relief{}};
    technique.options.true_silhouettes = true;
    return technique;
}

std::vector<Conclusion> bump_maps() {
    const Technique texture{scene::Texture{}};
    return {
        {"J 2.2",
         "Bump mapping looks good at a small cost.",
         "less difference (FLIP) from the true picture than a plain texture, and at most 25 % of "
         "the frame rate (J's range for parallax)",
         {picture("FLIP", "map", Quantity::flip, {scene::Bump{}}, texture, at_most(1.0)),
          ratio("FLIP, oblique", Quantity::flip, seen(bricks(), {scene::Bump{}}),
                seen(bricks(), texture), at_most(1.0)),
          picture("FLIP", "grazing", Quantity::flip, {scene::Bump{}}, texture, at_most(1.0)),
          brick_cost("cost", {scene::Bump{}}, texture, at_most(small_loss))},
         "on a CPU; J had a graphics card",
         "It looks better from above; at flat angles, right light at wrong places is worse than "
         "even light. Without a graphics card, each read of a map and each product counts beside "
         "a plain texture, which hardly computes."},
        {"M 3.3",
         "Emboss bump mapping is fast.",
         "less time than normal maps",
         {brick_time("", {scene::Emboss{}}, {scene::Normal{}}, at_most(1.0))}},
        {.source = "M 3.3",
         .claim =
             "At sharp edges, such as those of bricks, emboss bump mapping gives good results.",
         .rule = "less difference (FLIP) from the true picture than a plain texture, and more "
                 "similarity (SSIM)",
         .figures =
             {picture("FLIP", "map", Quantity::flip, {scene::Emboss{}}, texture, at_most(1.0)),
              picture("SSIM", "map", Quantity::ssim, {scene::Emboss{}}, texture, at_least(1.0)),
              picture("FLIP", "grazing", Quantity::flip, {scene::Emboss{}}, texture, at_most(1.0)),
              picture("SSIM", "grazing", Quantity::ssim, {scene::Emboss{}}, texture,
                      at_least(1.0))},
         .reason = "From above, the edges lie in their right places, and SSIM, which compares "
                   "structure, sees that. Their brightness is not right, which FLIP sees."},
    };
}

std::vector<Conclusion> normal_maps() {
    const Technique texture{scene::Texture{}};
    const Technique relief{scene::Relief{}};
    return {
        {"M 3.4",
         "Seen from straight above, normal maps show a surface almost perfectly.",
         "at most 1.1 times the difference (FLIP) of exact rays (our reading)",
         {picture("", "map", Quantity::flip, {scene::Normal{}}, {scene::Exact{}}, at_most(1.1)),
          picture("exact rays with shadows", "map", Quantity::flip, {scene::Normal{}},
                  shadowed({scene::Exact{}}, 0.0), at_most(1.1))},
         "rays are parallel there, so that all techniques see the same places",
         "Nothing but the shadows is missing."},
        {"M 3.4",
         "At flat angles one sees that the surface is flat.",
         "at least twice the difference (FLIP) of relief (our reading)",
         {picture("", "grazing", Quantity::flip, {scene::Normal{}}, relief, at_least(2.0)),
          picture("a plain texture over normal maps", "grazing", Quantity::flip, texture,
                  {scene::Normal{}}, {})}},
        {"M 3.4",
         "Normal maps need little computing.",
         "at most half of the time of relief (our reading)",
         {brick_time("over relief", {scene::Normal{}}, relief, at_most(0.5)),
          brick_time("over a plain texture", {scene::Normal{}}, texture, {})},
         "on a CPU; M means graphics cards"},
        {"M 4",
         "With normal maps, one sees the missing shape in special cases only.",
         "at most 1.1 times the difference (FLIP) of relief (our reading)",
         {picture("", "map", Quantity::flip, {scene::Normal{}}, relief, at_most(1.1)),
          ratio("oblique", Quantity::flip, seen(bricks(), {scene::Normal{}}),
                seen(bricks(), relief), at_most(1.1)),
          picture("", "grazing", Quantity::flip, {scene::Normal{}}, relief, at_most(1.1))},
         "",
         "From straight above, light is all there is to see. The flatter the angle, the farther "
         "each place is from the right one."},
    };
}

// Holes of the warped picture; those of a plain texture lie over the plane, too.
std::vector<Figure> holes_of_warping() {
    const Technique prewarp{scene::Prewarp{}};
    std::vector<Figure> figures;
    for (const auto& [words, scene, pose] : {std::tuple{"city", "urban", "oblique"},
                                             {"landscape", "natural", "oblique"},
                                             {"landscape, low", "natural", "low"},
                                             {"bricks", "tile brick", "oblique"}}) {
        figures.push_back(plain(fmt::format("holes, {}", words), Quantity::holes,
                                seen({"pareto.json", scene, pose}, prewarp), at_most(1.0)));
    }
    figures.push_back(plain("of a plain texture, landscape", Quantity::holes,
                            seen({"pareto.json", "natural", "oblique"}, {scene::Texture{}}), {}));
    return figures;
}

Conclusion warped_visibility() {
    return {.source = "J 2.4",
            .claim = "Warping settles what hides what, and fills the holes.",
            .rule = "at most 1 % of its pixels show a point that nearer ground hides, and at most "
                    "1 % of the pixels of terrain show none (our reading)",
            .figures = joined(named("hidden", hidden_points("distance-searches.json",
                                                            {scene::Prewarp{}}, at_most(1.0))),
                              holes_of_warping()),
            .reason =
                "Over terrain, its holes lie at the border of its plane: what rises over that is "
                "cut off, as with a plain texture. In pose low the eye is below the plane. One "
                "cause of hidden points: rows move before columns, and of two points that meet in "
                "a row one is lost, even if the columns would part them."};
}

std::vector<Conclusion> layers_and_warping() {
    const Technique relief{scene::Relief{}};
    return {
        {"M 3.6.9, 3.6.10, 3.6.11",
         "Two and four layers show fences, thin shells and chains.",
         "at most 10 % of the pixels wrong (our limit)",
         {plain("fence", Quantity::wrong,
                seen({"pareto.json", "tile fence", "oblique"}, {scene::Lattice{}}), at_most(10.0)),
          plain("shell", Quantity::wrong,
                seen({"pareto.json", "tile copper", "oblique"}, {scene::DualLayer{}}),
                at_most(10.0)),
          plain("rings", Quantity::wrong,
                seen({"pareto.json", "tile rings", "oblique"}, {scene::MultiLayer{}}),
                at_most(10.0))}},
        {"M 4",
         "Four layers waste work on a surface that one layer can show.",
         "more time than relief on the same surface",
         {ratio("bricks", Quantity::ms,
                claim("tile brick", "oblique", "detail texture", {scene::MultiLayer{}}),
                claim("tile brick", "oblique", "detail texture", relief), at_least(1.0)),
          ratio("bricks, as many steps", Quantity::ms,
                claim("tile brick", "oblique", "detail texture", {scene::MultiLayer{}}),
                claim("tile brick", "oblique", "detail texture",
                      {scene::Relief{.linear_steps = 32, .bisection_steps = 6}}),
                at_least(1.0))},
         "layers take 32 steps, relief 11 or 32"},
        warped_visibility(),
        {.source = "J 2.4.5",
         .claim = "Of warping, rebuilding the picture is far more work than moving the points.",
         .rule = "both take at least 3 times the time of moving alone (our reading of \"far\")",
         .figures = {warping_over_moving()},
         .note = "on a CPU; places only, without colours",
         .reason = "Moving a point divides. Rebuilding copies and interpolates, along the rows and "
                   "then along the columns: more work, but not far more."},
    };
}

} // namespace

Chapter light_chapter() {
    const Technique texture{scene::Texture{}};
    Chapter chapter{"What can light alone show?"};
    chapter.answer = {
        {"On bricks, normal maps cost {} of the frame rate of a plain texture. Light alone moves "
         "nothing, so {} of the pixels show a wrong point.",
         {brick_cost("", {scene::Normal{}}, texture, at_least(0.0)),
          plain("", Quantity::wrong, seen(bricks(), {scene::Normal{}}), {})}}};
    chapter.conclusions = joined(
        joined(bump_maps(), normal_maps()),
        {
            {"J 2.7.2",
             "A plain texture gives no impression of depth.",
             "more than half of the pixels wrong (our reading)",
             {plain("city", Quantity::wrong, source_test("relief-2", texture), at_least(50.0)),
              plain("landscape", Quantity::wrong, source_test("relief-4", texture),
                    at_least(50.0))}},
        });
    return chapter;
}

Chapter options_chapter() {
    const Technique relief{scene::Relief{}};
    const Technique smooth = smooth_relief();
    Chapter chapter{"What do shadows, edges and layers cost?"};
    chapter.answer = {
        {"On bricks, hard shadows take {} the time of relief without them, soft ones {}, and true "
         "outlines {}. Smooth edges cost {} of the frame rate.",
         {brick_time("", shadowed_relief(0.0), relief, {}),
          brick_time("", shadowed_relief(scene::Shadow{}.depth), relief, {}),
          brick_time("", outlined_relief(), relief, {}), brick_cost("", smooth, relief, {})}}};
    chapter.conclusions = {
        {"M 3.6.7, figure 34",
         "The frame rates with and without smooth edges are left blank.",
         "",
         {brick_cost("loss of frame rate", smooth, relief, {})}},
        {"M 3.6.7",
         "Smooth edges make a better picture.",
         "less difference (FLIP) from the true picture, and more similarity (SSIM), than without",
         {ratio("FLIP", Quantity::flip, seen(bricks(), smooth), seen(bricks(), relief),
                at_most(1.0)),
          ratio("SSIM", Quantity::ssim, seen(bricks(), smooth), seen(bricks(), relief),
                at_least(1.0))},
         "",
         "Few pixels lie at edges, and one measure judges what the other does not."},
        {.source = "J 2.4.8; M 3.6.5",
         .claim = "A second ray towards the light finds the shadows of relief on itself.",
         .rule = "less difference (FLIP) from the true picture than without it",
         .figures = {picture("", "map", Quantity::flip, shadowed_relief(0.0), relief, at_most(1.0)),
                     ratio("oblique", Quantity::flip, seen(bricks(), shadowed_relief(0.0)),
                           seen(bricks(), relief), at_most(1.0)),
                     picture("", "grazing", Quantity::flip, shadowed_relief(0.0), relief,
                             at_most(1.0)),
                     picture("exact rays", "grazing", Quantity::flip,
                             shadowed({scene::Exact{}}, 0.0), {scene::Exact{}}, {})},
         .reason =
             "At a flat angle, a far pixel covers a strip of the map, with joints that the bricks "
             "before them hide. The share of the sun is the mean of that strip, as the colour is, "
             "so far bricks are too dark. Exact rays have the same fault: it is not the search."},
        {"M 4",
         "Do without shadows where none fall.",
         "shadows take at least 1.25 times the time of relief (our reading)",
         {brick_time("hard", shadowed_relief(0.0), relief, at_least(1.25)),
          brick_time("soft", shadowed_relief(scene::Shadow{}.depth), relief, at_least(1.25))}},
        {"M 3.6.6",
         "Soft shadows look truer than hard ones.",
         "less difference (FLIP) from the true picture",
         {ratio("oblique", Quantity::flip, seen(bricks(), shadowed_relief(scene::Shadow{}.depth)),
                seen(bricks(), shadowed_relief(0.0)), at_most(1.0))},
         "the true picture has the sun's own penumbra, half a degree wide",
         "These are as wide as the depth of the relief makes them, not as the sun does."},
        {"M 3.6.11",
         "Relief ends at the border of its polygon; what true outlines would cost is left open.",
         "",
         {brick_time("time with true outlines over relief", outlined_relief(), relief, {})},
         "`silhouettes=true` lifts this"},
    };
    chapter.conclusions = joined(std::move(chapter.conclusions), layers_and_warping());
    return chapter;
}

Chapter data_chapter() {
    Chapter chapter{"Which data does it need?"};
    chapter.answer = {
        {"True heights. Those guessed from a picture are {} (city), {} (landscape) and {} (Crater "
         "Lake) as wrong as flat ground.",
         {guess("", "urban", "guessed", at_least(1.0)),
          guess("", "natural", "guessed", at_least(1.0)),
          guess("", "crater lake", "guessed", at_least(1.0))}}};
    chapter.conclusions = {
        {"J 2.7, 3", "For parallax, heights may be guessed from the brightness of a picture.",
         "at most half of the error of flat ground (our reading)", all_guesses(),
         "the heights themselves, seen by exact rays; fitted: scaled as well as possible to the "
         "true ones",
         "A picture is bright where snow, sand and light roofs lie, not where the ground is high. "
         "Even the best scale leaves about the error of flat ground."},
        {"J 3", "Relief only over the city, with one height everywhere else, saves time.",
         "less time, and fewer taps, than relief over everything", relief_over_city(),
         "level ground without buildings has a plain texture"},
        {"J 2.7.2, test 1", "Relief can show a large city by repeating one tile.",
         "at most 10 % of the pixels wrong (our limit), less memory than one terrain",
         repeated_tile(), "shadows end at the borders of tiles"},
    };
    return chapter;
}

} // namespace reljef::bench

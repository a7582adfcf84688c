// What relief and parallax cost and show, and whether triangles do better.
#include <utility>

#include <fmt/format.h>

#include "bench/findings/conclusions.h"
#include "bench/findings/figures.h"

namespace reljef::bench {
namespace {

using scene::Technique;

constexpr double good_wrong = 10.0;   // percent of pixels: our limit of a good picture
constexpr double smooth_rate = 24.0;  // frames per second, M 1
constexpr double small_cost = 25.0;   // percent of the frame rate: the most that J calls small
constexpr double relief_drop = 69.75; // percent, J 3
constexpr double parallax_drop = 14.06;

const char* const limit_of_wrong = "at most 10 % of the pixels wrong (our limit)";

using Tests = std::vector<std::string>;

Tests relief_tests() {
    return {"relief-1", "relief-2", "relief-3", "relief-4"};
}

Tests parallax_tests() {
    return {"parallax-1", "parallax-2", "parallax-3"};
}

std::vector<Figure> drops(const Technique& technique, const Tests& tests, const Range& range) {
    std::vector<Figure> figures;
    for (const std::string& test : tests) {
        figures.push_back(
            drop(test, source_test(test, technique), source_test(test, {scene::Texture{}}), range));
    }
    return figures;
}

std::vector<Figure> wrongs(const Technique& technique, const Tests& tests, const Range& range) {
    std::vector<Figure> figures;
    for (const std::string& test : tests) {
        figures.push_back(plain(test, Quantity::wrong, source_test(test, technique), range));
    }
    return figures;
}

std::vector<Figure> rates(const Technique& technique, const Tests& tests, const Range& range) {
    std::vector<Figure> figures;
    for (const std::string& test : tests) {
        figures.push_back(frame_rate(test, source_test(test, technique), range));
    }
    return figures;
}

std::vector<Figure> share_of_texture(Quantity quantity, const Technique& technique,
                                     const Tests& tests, const Range& range) {
    std::vector<Figure> figures;
    for (const std::string& test : tests) {
        figures.push_back(ratio(test, quantity, source_test(test, technique),
                                source_test(test, {scene::Texture{}}), range));
    }
    return figures;
}

View oblique_city() {
    return {"oblique.json", "urban, s = 0.05", "oblique"};
}

// The quantity of a technique over that of another, on the city and the landscape.
std::vector<Figure> oblique_ratios(Quantity quantity, const Technique& technique,
                                   const Technique& base, const Range& range) {
    const View city = oblique_city();
    const View landscape{"oblique.json", "natural", "oblique"};
    return {ratio("city", quantity, seen(city, technique), seen(city, base), range),
            ratio("landscape", quantity, seen(landscape, technique), seen(landscape, base), range)};
}

// The times of two techniques on the gallery's bricks.
Figure brick_ratio(const std::string& words, const Technique& technique, const Technique& base,
                   const Range& range) {
    return ratio(words, Quantity::ms, seen(bricks(), technique), seen(bricks(), base), range);
}

// The quantity of a technique over that of another, in test relief-4.
Figure test_4(const std::string& words, Quantity quantity, const Technique& technique,
              const Technique& base, const Range& range) {
    return ratio(words, quantity, source_test("relief-4", technique), source_test("relief-4", base),
                 range);
}

Technique levels(int count) {
    return {scene::Polygons{.max_levels = count}};
}

Technique bounded() {
    return {scene::Polygons{.error = 1.0}};
}

std::vector<Chapter::Sentence> relief_answer() {
    const Technique relief{scene::Relief{}};
    return {{"Relief costs {}, {}, {} and {} of the frame rate in J's four tests.",
             drops(relief, relief_tests(), at_least(50.0))},
            {"In return, {}, {}, {} and {} of its pixels are wrong; of a plain texture, {} to {}.",
             joined(wrongs(relief, relief_tests(), {}),
                    {plain("", Quantity::wrong, source_test("relief-3", {scene::Texture{}}),
                           at_least(50.0)),
                     plain("", Quantity::wrong, source_test("relief-1", {scene::Texture{}}),
                           at_least(50.0))})}};
}

std::vector<Chapter::Sentence> parallax_answer() {
    const Technique parallax{scene::Parallax{}};
    return {{"Parallax costs {}, {} and {} of the frame rate in J's three tests.",
             drops(parallax, parallax_tests(), at_least(0.0))},
            {"Its error in pixels is {}, {} and {} that of a plain texture.",
             share_of_texture(Quantity::error_px, parallax, parallax_tests(), at_most(0.5))},
            {"Still, {}, {} and {} of its pixels show a wrong point.",
             wrongs(parallax, parallax_tests(), at_least(good_wrong))}};
}

// The times of another program over ours for the same work, from the poses overview and low.
std::vector<Figure> over_ours(const std::string& work, const std::string& what,
                              const Technique& ours) {
    std::vector<Figure> figures;
    for (const char* const pose : {"overview", "low"}) {
        figures.push_back(ratio("", Quantity::ms, peer(work, pose, what),
                                peer(work, pose, scene::to_string(ours)), {}));
    }
    return figures;
}

Chapter::Sentence programs_beside_ours() {
    const Technique exact{scene::Exact{}};
    return {
        "Of other programs, from the poses overview and low over the Alps: OpenSceneGraph draws "
        "a vertex at every sample in {} and {} of our time, and Irrlicht's parallax material a "
        "square in {} and {} of that of our parallax. Embree finds hits in {} and {}, and "
        "POV-Ray draws a picture in {} and {} of the time of our exact rays. Times of one run "
        "that are less than 10 % apart are the same.",
        joined(joined(over_ours("a vertex for every sample", "OpenSceneGraph, GeometryTechnique",
                                levels(1)),
                      over_ours("heights on a flat square", "Irrlicht, parallax material",
                                {scene::Parallax{}})),
               joined(over_ours("hits by rays on the CPU", "Embree, quads", exact),
                      over_ours("a picture by rays on the CPU", "POV-Ray, height_field", exact)))};
}

std::vector<Chapter::Sentence> triangles_answer() {
    const Technique relief{scene::Relief{}};
    return {
        {"Triangles with five levels of detail take {} the time of relief. {} of their pixels "
         "are wrong, and {} of those of relief.",
         {test_4("", Quantity::ms, levels(5), relief, at_most(1.0)),
          plain("", Quantity::wrong, source_test("relief-4", levels(5)), {}),
          plain("", Quantity::wrong, source_test("relief-4", relief), {})}},
        {"With an error bound of one pixel instead of levels, they take {} that time, and {} of "
         "their pixels are wrong.",
         {test_4("", Quantity::ms, bounded(), relief, at_most(1.0)),
          plain("", Quantity::wrong, source_test("relief-4", bounded()), {})}},
        programs_beside_ours()};
}

std::vector<Figure> work_of_relief() {
    const Technique relief{scene::Relief{}};
    const Technique parallax{scene::Parallax{}};
    const auto over_parallax = [&](const std::string& words, Quantity quantity) {
        return and_on_gpu({ratio(words, quantity, seen(oblique_city(), relief),
                                 seen(oblique_city(), parallax), at_least(10.0))})
            .back();
    };
    return {brick_ratio("over normal maps", relief, {scene::Normal{}}, at_least(10.0)),
            brick_ratio("over parallax", relief, parallax, at_least(10.0)),
            over_parallax("over parallax, city", Quantity::ms),
            over_parallax("its reads", Quantity::taps)};
}

std::vector<Conclusion> cost_of_relief() {
    const Technique relief{scene::Relief{}};
    const ThesisDrop three = thesis_drop("relief", {"relief-1", "relief-2", "relief-3"});
    const ThesisDrop four = thesis_drop("relief", relief_tests());
    return {
        {"J 3", "Relief costs 69.75 % of the frame rate on average.",
         fmt::format("{:.1f} to {:.1f} % (the range of J's tests)", four.lowest, four.highest),
         and_on_gpu(drops(relief, relief_tests(), between(four.lowest, four.highest)))},
        {.source = "J 3 against J's table",
         .claim = "The mean of J's tests is 69.75 %.",
         .rule = fmt::format("69.75 ± {:.1f} % (J's table has whole frames)", three.rounding),
         .figures = {thesis_mean("tests 1 to 3", three, relief_drop),
                     thesis_mean("all four tests", four, relief_drop)},
         .reason = "Of all choices of tests, only the first and the third together come near it."},
        {.source = "J 3",
         .claim = "Relief is too expensive for a whole scene all the time.",
         .rule = "under 24 frames per second (M 1: from 24 on, motion is smooth)",
         .figures = and_on_gpu(rates(relief, relief_tests(), at_most(smooth_rate))),
         .reason = "A graphics card draws hundreds of such frames per second. J's own card drew 44 "
                   "to 60; J judges by the loss, not by the rate."},
        {"J 2.7", "Without support by the hardware, J's laptop drew at most one frame per second.",
         "", rates(relief, relief_tests(), {}),
         "two cores of today, which draw with vector instructions"},
        {.source = "M 3.6.7",
         .claim = "Relief takes at least ten times the work of earlier techniques.",
         .rule = "at least 10 times the time and the reads (M: orders of magnitude)",
         .figures = work_of_relief(),
         .reason =
             "It reads the map so often, but a frame also shades, fetches colours and sets up "
             "triangles, which all techniques do once."},
    };
}

std::vector<Conclusion> quality_of_relief() {
    const Technique relief{scene::Relief{}};
    const Technique cone{scene::Cone{}};
    return {
        {"J 3", "Relief looks much better than parallax.",
         "at most half of the difference (FLIP) from the true picture (our reading of \"much\"), "
         "and fewer wrong pixels",
         joined(named("FLIP",
                      oblique_ratios(Quantity::flip, relief, {scene::Parallax{}}, at_most(0.5))),
                named("wrong",
                      oblique_ratios(Quantity::wrong, relief, {scene::Parallax{}}, at_most(1.0))))},
        {"J 3", "Relief shows buildings and rough ground well.", limit_of_wrong,
         wrongs(relief, relief_tests(), at_most(good_wrong)), "",
         "Rough ground, yes. Of a city, its steps miss walls that are thinner than a step."},
        {"J 3", "Relief adds no geometry.", "no more triangles than a plain texture",
         share_of_texture(Quantity::triangles, relief, {"relief-1", "relief-4"}, at_most(1.0)),
         "a plain texture lies on more pieces here"},
        {.source = "J 3",
         .claim = "Cone maps make relief faster.",
         .rule = "less time than relief",
         .figures = and_on_gpu(oblique_ratios(Quantity::ms, cone, relief, at_most(1.0))),
         .reason = "A cone's step is longer, but computes more: the gain in reads is about lost. "
                   "Over rough ground cones are narrow, and it is more than lost."},
        {"J 3", "Cone maps make relief more accurate.", "fewer wrong pixels than relief",
         oblique_ratios(Quantity::wrong, cone, relief, at_most(1.0))},
    };
}

std::vector<Conclusion> cost_of_parallax() {
    const Technique parallax{scene::Parallax{}};
    const ThesisDrop own = thesis_drop("parallax", parallax_tests());
    const ThesisDrop older = thesis_drop("parallax", parallax_tests(), 1);
    const ThesisDrop newer = thesis_drop("parallax", parallax_tests(), 2);
    return {
        {"J 3", "Parallax costs 14.06 % of the frame rate on average: nobody notices it.",
         fmt::format("{:.1f} to {:.1f} % (the range of J's tests)", own.lowest, own.highest),
         joined(drops(parallax, parallax_tests(), between(own.lowest, own.highest)),
                on_gpu(drops(parallax, {"parallax-1", "parallax-3"},
                             between(own.lowest, own.highest)))),
         "in parallax-2, the clock of the graphics card changed between the frames",
         "A plain texture hardly computes, so the few more reads of parallax weigh much where "
         "computing is slow. In parallax-2, reading a huge texture takes the time of both."},
        {"J 3 against J's table",
         "The mean of J's tests is 14.06 %.",
         fmt::format("14.06 ± {:.1f} % (J's table has whole frames)", own.rounding),
         {thesis_mean("both machines", own, parallax_drop)}},
        {.source = "J 3 against J's table",
         .claim = "This mean is what parallax costs on a machine.",
         .rule = fmt::format("14.06 ± {:.1f} % on each of J's machines", own.rounding),
         .figures = {thesis_mean("the older", older, parallax_drop),
                     thesis_mean("the newer", newer, parallax_drop)},
         .reason = "The older machine loses three times as much as the newer one. Their mean is "
                   "the loss of neither."},
        {.source = "M 3.5, 4; D",
         .claim = "Parallax takes little more than normal maps.",
         .rule = "at most 1.25 times the time (J calls a loss of 25 % small)",
         .figures = {brick_ratio("", parallax, {scene::Normal{}},
                                 at_most(1.0 + 0.01 * small_cost))},
         .reason = "A height is read, and the picture and the normal wait for it."},
        {.source = "D",
         .claim = "A limited offset is cheaper.",
         .rule = "less time than without the limit",
         .figures = and_on_gpu(
             oblique_ratios(Quantity::ms, {scene::ParallaxLimited{}}, parallax, at_most(1.0))),
         .reason = "It saves one division a pixel, which is less than the noise of the times."},
    };
}

std::vector<Figure> limited_over_parallax() {
    const Technique parallax{scene::Parallax{}};
    const Technique limited{scene::ParallaxLimited{}};
    auto figures = oblique_ratios(Quantity::error_px, limited, parallax, at_most(1.0));
    const View grazing{"pareto.json", "natural", "grazing"};
    figures.push_back(ratio("landscape, pose grazing", Quantity::error_px, seen(grazing, limited),
                            seen(grazing, parallax), at_most(1.0)));
    return figures;
}

Figure cost_over_landscape() {
    return drop("cost", source_test("parallax-3", {scene::Parallax{}}),
                source_test("parallax-3", {scene::Texture{}}), at_most(small_cost));
}

// What parallax shows over the landscape, which has no jumps, over what it shows over the city,
// both as high as a part of their width.
std::vector<Figure> without_jumps(const std::string& scale, const Range& range) {
    const RowName rough = seen(at_scale("natural", scale), {scene::Parallax{}});
    const RowName jumps = seen(at_scale("urban", scale), {scene::Parallax{}});
    return {ratio(fmt::format("error, scale {}", scale), Quantity::error_px, rough, jumps, range),
            ratio(fmt::format("wrong, scale {}", scale), Quantity::wrong, rough, jumps, range)};
}

Figure wrong_of_repeated(const std::string& words, const std::string& terrain,
                         const std::string& scale, const Range& range) {
    return plain(fmt::format("{}, scale {}", words, scale), Quantity::wrong,
                 seen(at_scale(terrain, scale), {scene::ParallaxIterated{}}), range);
}

std::vector<Conclusion> parallax_and_heights() {
    return {{.source = "M 3.5; D",
             .claim = "Repeated parallax works well, but only up to some scale of the heights.",
             .rule = "at most 10 % of the pixels wrong (our limit) at M's lower scale, 0.04, and "
                     "more at the higher one, 0.15",
             .figures = {wrong_of_repeated("city", "urban", "0.04", at_most(good_wrong)),
                         wrong_of_repeated("city", "urban", "0.15", at_least(good_wrong)),
                         wrong_of_repeated("landscape", "natural", "0.04", at_most(good_wrong)),
                         wrong_of_repeated("landscape", "natural", "0.15", at_least(good_wrong))},
             .note = "scale: heights over width",
             .reason = "Over a city, the steps already end at the wrong side of walls at the lower "
                       "scale."},
            {.source = "D",
             .claim = "Parallax is best with height maps without jumps.",
             .rule = "at D's scale, 0.04, less error in pixels, and fewer wrong pixels, over a "
                     "landscape than over a city as high",
             .figures = joined(without_jumps("0.04", at_most(1.0)), without_jumps("0.15", {})),
             .reason =
                 "A jump moves places far, so that the error in pixels is larger over a city. "
                 "But slopes are everywhere, so that about as many pixels are off by more "
                 "than a texel."}};
}

std::vector<Conclusion> quality_of_parallax() {
    const Technique parallax{scene::Parallax{}};
    return {
        {"J 2.7.1", "Parallax approximates a city in three dimensions well.",
         "at most half of the error of a plain texture (our reading of \"well\")",
         share_of_texture(Quantity::error_px, parallax, {"parallax-1", "parallax-2"},
                          at_most(0.5))},
        {"J 2.7.1", "Parallax cannot replace buildings.",
         "more than 10 % of the pixels wrong (our limit)",
         wrongs(parallax, {"parallax-1", "parallax-2"}, at_least(good_wrong))},
        {.source = "J 2.7.1",
         .claim = "On natural terrain, parallax gives realism at a small cost.",
         .rule =
             "at most 10 % of the pixels wrong (our limit), at most 25 % of the frame rate (J's "
             "range)",
         .figures = {plain("wrong", Quantity::wrong, source_test("parallax-3", parallax),
                           at_most(good_wrong)),
                     cost_over_landscape(), and_on_gpu({cost_over_landscape()}).back()},
         .reason = "The shift assumes that the ground is level between a pixel and the place it "
                   "shows. Over mountains it is not, so most pixels show a neighbour of the right "
                   "place. The cost is small on a graphics card only."},
        {.source = "J 2.3.2; D",
         .claim = "A limited offset reduces the errors of parallax.",
         .rule = "less error than without the limit",
         .figures = limited_over_parallax(),
         .reason = "The limit shortens all shifts. At flat angles they are far too long, near the "
                   "horizon by thousands of pixels; from above they are right, and become too "
                   "short."},
        {"M 3.5, 4; D",
         "Parallax looks better than normal maps.",
         "less difference (FLIP) from the true picture, and less error in pixels",
         {ratio("FLIP", Quantity::flip, seen(bricks(), parallax), seen(bricks(), {scene::Normal{}}),
                at_most(1.0)),
          ratio("error", Quantity::error_px, seen(bricks(), parallax),
                seen(bricks(), {scene::Normal{}}), at_most(1.0))}},
        {"M 3.5", "Repeated steps make parallax more accurate.", "less error than one step",
         oblique_ratios(Quantity::error_px, {scene::ParallaxIterated{}}, parallax, at_most(1.0))},
    };
}

Conclusion order_of_test_4() {
    const auto slower = [](const std::string& words, const Technique& technique,
                           const Technique& faster) {
        return test_4(words, Quantity::ms, technique, faster, at_least(1.0));
    };
    const Technique relief{scene::Relief{}};
    const Technique parallax{scene::Parallax{}};
    return {.source = "J 2.7.2, test 4",
            .claim = "From fast to slow: texture, parallax, triangles with 5 levels of detail, "
                     "with 3, relief, triangles with 1.",
            .rule = "each takes longer than the one before",
            .figures = and_on_gpu({slower("parallax over texture", parallax, {scene::Texture{}}),
                                   slower("5 levels over parallax", levels(5), parallax),
                                   slower("3 levels over 5", levels(3), levels(5)),
                                   slower("relief over 3 levels", relief, levels(3)),
                                   slower("1 level over relief", levels(1), relief)}),
            .reason =
                "Without a graphics card, triangles are set up one by one, so that three levels "
                "take about as long as relief."};
}

Conclusion levels_and_time() {
    const auto faster = [](const std::string& words, const RowName& row, const RowName& base) {
        return ratio(words, Quantity::ms, row, base, at_most(1.0));
    };
    return {"J 2.7.2", "More levels of detail draw faster.", "less time than fewer levels",
            joined(and_on_gpu({faster("3 levels over 1", source_test("relief-4", levels(3)),
                                      source_test("relief-4", levels(1))),
                               faster("5 levels over 3", source_test("relief-4", levels(5)),
                                      source_test("relief-4", levels(3)))}),
                   {faster("Irrlicht, 3 levels over 1", irrlicht(3), irrlicht(1)),
                    faster("Irrlicht, 5 levels over 3", irrlicht(5), irrlicht(3))})};
}

std::vector<Conclusion> relief_or_triangles() {
    const Technique relief{scene::Relief{}};
    const Technique automatic{scene::Automatic{}};
    const Technique displaced{scene::Displacement{}};
    return {
        {"J 2.7.2", "Without levels of detail, relief is by far the better choice.",
         "relief at least twice as fast (our reading of \"by far\")",
         and_on_gpu({test_4("", Quantity::ms, levels(1), relief, at_least(2.0))})},
        {.source = "J 3",
         .claim = "On terrain, triangles with levels of detail are the better choice.",
         .rule = "less time than relief, and no more wrong pixels",
         .figures = and_on_gpu(
             {test_4("time, 5 levels", Quantity::ms, levels(5), relief, at_most(1.0)),
              test_4("wrong, 5 levels", Quantity::wrong, levels(5), relief, at_most(1.0)),
              test_4("time, bound of 1 px", Quantity::ms, bounded(), relief, at_most(1.0)),
              test_4("wrong, bound of 1 px", Quantity::wrong, bounded(), relief, at_most(1.0))}),
         .reason =
             "They are faster, but a level is chosen by distance, whatever the ground. With a "
             "bound on the error, which asks the ground, a texel may be off, but no pixel is "
             "more than one off."},
        {"M 3.1; D",
         "Moving the vertices of a fine mesh is the most expensive way.",
         "more time than the others",
         {brick_ratio("over relief", displaced, relief, at_least(1.0)),
          brick_ratio("over exact rays", displaced, {scene::Exact{}}, at_least(1.0)),
          brick_ratio("over warping", displaced, {scene::Prewarp{}}, at_least(1.0))}},
        {.source = "M 3",
         .claim = "So many triangles cannot be drawn in real time.",
         .rule = "with a triangle at every sample, under 24 frames per second (M 1: from 24 on, "
                 "motion is smooth)",
         .figures = and_on_gpu({frame_rate("", source_test("relief-4", levels(1)), at_most(24.0))}),
         .reason = "A graphics card of today draws two million triangles hundreds of times a "
                   "second."},
        {.source = "J 3; M 4",
         .claim = "A mix of techniques is best.",
         .rule =
             "`auto` (triangles and rays within one pixel) takes no more time than either alone",
         .figures = and_on_gpu(
             {test_4("over triangles", Quantity::ms, automatic, bounded(), at_most(1.0)),
              test_4("over rays", Quantity::ms, automatic, {scene::Exact{}}, at_most(1.0))}),
         .reason =
             "In this view triangles are best nearly everywhere, so a mix can only equal them, "
             "and it pays for the choice. Relief over a city only, which J had in mind, is "
             "judged below (\"Which data does it need?\")."},
    };
}

} // namespace

Chapter relief_chapter() {
    Chapter chapter{"What does relief cost, and what does it show?", relief_answer(),
                    cost_of_relief()};
    chapter.conclusions = joined(std::move(chapter.conclusions), quality_of_relief());
    return chapter;
}

Chapter parallax_chapter() {
    Chapter chapter{"What does parallax cost, and what does it show?", parallax_answer(),
                    cost_of_parallax()};
    chapter.conclusions = joined(std::move(chapter.conclusions), quality_of_parallax());
    chapter.conclusions = joined(std::move(chapter.conclusions), parallax_and_heights());
    return chapter;
}

Chapter triangles_chapter() {
    Chapter chapter{"Relief, or triangles with levels of detail?",
                    triangles_answer(),
                    {order_of_test_4(), levels_and_time()}};
    chapter.conclusions = joined(std::move(chapter.conclusions), relief_or_triangles());
    return chapter;
}

} // namespace reljef::bench

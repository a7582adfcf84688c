// What relief and parallax cost and show, and whether triangles do better.
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

// The quantity of a technique over that of another, on the city and the landscape.
std::vector<Figure> oblique_ratios(Quantity quantity, const Technique& technique,
                                   const Technique& base, const Range& range) {
    const View city{"oblique.json", "urban, s = 0.05", "oblique"};
    const View landscape{"oblique.json", "natural", "oblique"};
    return {ratio("city", quantity, seen(city, technique), seen(city, base), range),
            ratio("landscape", quantity, seen(landscape, technique), seen(landscape, base), range)};
}

// The times of two techniques on the gallery's bricks.
Figure brick_ratio(const std::string& words, const Technique& technique, const Technique& base,
                   const Range& range) {
    const View bricks{"pareto-quick.json", "tile brick", "oblique"};
    return ratio(words, Quantity::ms, seen(bricks, technique), seen(bricks, base), range);
}

// The quantity of a technique over that of another, in test relief-4.
Figure test_4(const std::string& words, Quantity quantity, const Technique& technique,
              const Technique& base, const Range& range) {
    return ratio(words, quantity, source_test("relief-4", technique), source_test("relief-4", base),
                 range);
}

// The memory of relief over that of meshes on the bare ground, in the largest city of the suite.
Figure in_large_city(const std::string& words, Quantity quantity, int distance) {
    return ratio(words, quantity, city("urban 1024", distance, "heights", {scene::Relief{}}),
                 city("urban 1024", distance, "meshes", {scene::Polygons{.error = 1.0}}),
                 at_most(1.0));
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
            {"In return, only {}, {}, {} and {} of its pixels are wrong.",
             wrongs(relief, relief_tests(), at_most(good_wrong))}};
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
          plain("", Quantity::wrong, source_test("relief-4", bounded()), {})}}};
}

std::vector<Conclusion> cost_of_relief() {
    const Technique relief{scene::Relief{}};
    const ThesisDrop three = thesis_drop("relief", {"relief-1", "relief-2", "relief-3"});
    const ThesisDrop four = thesis_drop("relief", relief_tests());
    return {
        {"J 3", "Relief costs 69.75 % of the frame rate on average.",
         fmt::format("{:.1f} to {:.1f} % (the range of J's tests)", four.lowest, four.highest),
         drops(relief, relief_tests(), between(four.lowest, four.highest))},
        {"J 3 against J's table",
         "The mean of J's tests is 69.75 %.",
         fmt::format("69.75 ± {:.1f} % (J's table has whole frames)", three.rounding),
         {thesis_mean("tests 1 to 3", three, relief_drop),
          thesis_mean("all four tests", four, relief_drop)}},
        {"J 3", "Relief is too expensive for a whole scene all the time.",
         "under 24 frames per second (M 1: from 24 on, motion is smooth)",
         rates(relief, relief_tests(), at_most(smooth_rate)), "without a GPU"},
        {"J 2.7", "Without support by the hardware, relief draws at most one frame per second.",
         "at most 1 frame per second (J's figure)", rates(relief, relief_tests(), at_most(1.0)),
         "without a GPU"},
        {"M 3.6.7",
         "Relief takes at least ten times the work of earlier techniques.",
         "at least 10 times the time (M: orders of magnitude)",
         {brick_ratio("over normal maps", relief, {scene::Normal{}}, at_least(10.0)),
          brick_ratio("over parallax", relief, {scene::Parallax{}}, at_least(10.0))}},
    };
}

std::vector<Conclusion> quality_of_relief() {
    const Technique relief{scene::Relief{}};
    const Technique cone{scene::Cone{}};
    return {
        {"J 3", "Relief looks much better than parallax.",
         "at most half as many wrong pixels (our reading of \"much\")",
         oblique_ratios(Quantity::wrong, relief, {scene::Parallax{}}, at_most(0.5))},
        {"J 3", "Relief shows buildings and rough ground well.", limit_of_wrong,
         wrongs(relief, relief_tests(), at_most(good_wrong))},
        {"J 3", "Relief adds no geometry.", "no more triangles than a plain texture",
         share_of_texture(Quantity::triangles, relief, {"relief-1", "relief-4"}, at_most(1.0))},
        {"J 3", "Cone maps make relief faster.", "less time than relief",
         oblique_ratios(Quantity::ms, cone, relief, at_most(1.0))},
        {"J 3", "Cone maps make relief more accurate.", "fewer wrong pixels than relief",
         oblique_ratios(Quantity::wrong, cone, relief, at_most(1.0))},
    };
}

std::vector<Conclusion> cost_of_parallax() {
    const Technique parallax{scene::Parallax{}};
    const ThesisDrop own = thesis_drop("parallax", parallax_tests());
    return {
        {"J 3", "Parallax costs 14.06 % of the frame rate on average: nobody notices it.",
         fmt::format("{:.1f} to {:.1f} % (the range of J's tests)", own.lowest, own.highest),
         drops(parallax, parallax_tests(), between(own.lowest, own.highest))},
        {"J 3 against J's table",
         "The mean of J's tests is 14.06 %.",
         fmt::format("14.06 ± {:.1f} % (J's table has whole frames)", own.rounding),
         {thesis_mean("both machines", own, parallax_drop)}},
        {"M 3.5, 4; D",
         "Parallax takes little more than normal maps.",
         "at most 1.25 times the time (J calls a loss of 25 % small)",
         {brick_ratio("", parallax, {scene::Normal{}}, at_most(1.0 + 0.01 * small_cost))}},
        {"D", "A limited offset is cheaper.", "less time than without the limit",
         oblique_ratios(Quantity::ms, {scene::ParallaxLimited{}}, parallax, at_most(1.0))},
    };
}

std::vector<Figure> limited_over_parallax() {
    const Technique parallax{scene::Parallax{}};
    const Technique limited{scene::ParallaxLimited{}};
    auto figures = oblique_ratios(Quantity::error_px, limited, parallax, at_most(1.0));
    for (const char* const pose : {"grazing", "low"}) {
        const View view{"pareto-quick.json", "natural 257", pose};
        figures.push_back(ratio(fmt::format("landscape, pose {}", pose), Quantity::error_px,
                                seen(view, limited), seen(view, parallax), at_most(1.0)));
    }
    return figures;
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
        {"J 2.7.1",
         "On natural terrain, parallax gives realism at a small cost.",
         "at most 10 % of the pixels wrong (our limit), at most 25 % of the frame rate (J's "
         "range)",
         {plain("wrong", Quantity::wrong, source_test("parallax-3", parallax), at_most(good_wrong)),
          drop("cost", source_test("parallax-3", parallax),
               source_test("parallax-3", {scene::Texture{}}), at_most(small_cost))}},
        {"J 2.3.2; D", "A limited offset reduces the errors of parallax.",
         "less error than without the limit", limited_over_parallax()},
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
    return {"J 2.7.2, test 4",
            "From fast to slow: texture, parallax, triangles with 5 levels of detail, with 3, "
            "relief, triangles with 1.",
            "each takes longer than the one before",
            {slower("parallax over texture", parallax, {scene::Texture{}}),
             slower("5 levels over parallax", levels(5), parallax),
             slower("3 levels over 5", levels(3), levels(5)),
             slower("relief over 3 levels", relief, levels(3)),
             slower("1 level over relief", levels(1), relief)}};
}

Conclusion levels_and_time() {
    const auto faster = [](const std::string& words, const RowName& row, const RowName& base) {
        return ratio(words, Quantity::ms, row, base, at_most(1.0));
    };
    return {"J 2.7.2",
            "More levels of detail draw faster.",
            "less time than fewer levels",
            {faster("3 levels over 1", source_test("relief-4", levels(3)),
                    source_test("relief-4", levels(1))),
             faster("5 levels over 3", source_test("relief-4", levels(5)),
                    source_test("relief-4", levels(3))),
             faster("Irrlicht, 3 levels over 1", irrlicht(3), irrlicht(1)),
             faster("Irrlicht, 5 levels over 3", irrlicht(5), irrlicht(3))}};
}

std::vector<Conclusion> relief_or_triangles() {
    const Technique relief{scene::Relief{}};
    const Technique automatic{scene::Automatic{}};
    const Technique displaced{scene::Displacement{}};
    return {
        {"J 2.7.2",
         "Without levels of detail, relief is by far the better choice.",
         "relief at least twice as fast (our reading of \"by far\")",
         {test_4("", Quantity::ms, levels(1), relief, at_least(2.0))}},
        {"J 3",
         "On terrain, triangles with levels of detail are the better choice.",
         "less time than relief, and no more wrong pixels",
         {test_4("time, 5 levels", Quantity::ms, levels(5), relief, at_most(1.0)),
          test_4("wrong, 5 levels", Quantity::wrong, levels(5), relief, at_most(1.0)),
          test_4("time, bound of 1 px", Quantity::ms, bounded(), relief, at_most(1.0)),
          test_4("wrong, bound of 1 px", Quantity::wrong, bounded(), relief, at_most(1.0))}},
        {"M 3.1; D",
         "Moving the vertices of a fine mesh is the most expensive way.",
         "more time than the others",
         {brick_ratio("over relief", displaced, relief, at_least(1.0)),
          brick_ratio("over exact rays", displaced, {scene::Exact{}}, at_least(1.0)),
          brick_ratio("over warping", displaced, {scene::Prewarp{}}, at_least(1.0))}},
        {"J 3",
         "A mix is best: relief on parts of the terrain only.",
         "`auto` takes no more time than triangles alone and than rays alone",
         {test_4("over triangles", Quantity::ms, automatic, bounded(), at_most(1.0)),
          test_4("over rays", Quantity::ms, automatic, {scene::Exact{}}, at_most(1.0))}},
        {"J 1",
         "In large cities, buildings as objects are too much data; relief needs less.",
         "less memory of the GPU and less time than objects",
         {in_large_city("memory from 300 m", Quantity::bytes, 300),
          in_large_city("from 3 km", Quantity::bytes, 3000),
          in_large_city("time from 300 m", Quantity::ms, 300),
          in_large_city("from 3 km", Quantity::ms, 3000)}},
    };
}

void append(std::vector<Conclusion>& conclusions, std::vector<Conclusion> more) {
    for (Conclusion& conclusion : more) {
        conclusions.push_back(std::move(conclusion));
    }
}

} // namespace

Chapter relief_chapter() {
    Chapter chapter{"What does relief cost, and what does it show?", relief_answer(),
                    cost_of_relief()};
    append(chapter.conclusions, quality_of_relief());
    return chapter;
}

Chapter parallax_chapter() {
    Chapter chapter{"What does parallax cost, and what does it show?", parallax_answer(),
                    cost_of_parallax()};
    append(chapter.conclusions, quality_of_parallax());
    return chapter;
}

Chapter triangles_chapter() {
    Chapter chapter{"Relief, or triangles with levels of detail?",
                    triangles_answer(),
                    {order_of_test_4(), levels_and_time()}};
    append(chapter.conclusions, relief_or_triangles());
    return chapter;
}

} // namespace reljef::bench

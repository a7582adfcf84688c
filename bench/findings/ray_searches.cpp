// What parallax gains by following the ray.
#include <utility>

#include <fmt/format.h>

#include "bench/findings/conclusions.h"
#include "bench/findings/figures.h"

namespace reljef::bench {
namespace {

using scene::Technique;

// A search over one shift along the ray, in the error of places and in wrong pixels.
std::vector<Figure> over_one_shift(const std::string& words, const Technique& search) {
    std::vector<Figure> figures;
    for (const auto& [name, scene] :
         {std::pair{"city", "urban, s = 0.05"}, {"landscape", "natural"}}) {
        const View view{"oblique.json", scene, "oblique"};
        for (const auto& [measure, quantity] :
             {std::pair{"error", Quantity::error_px}, {"wrong", Quantity::wrong}}) {
            figures.push_back(ratio(fmt::format("{}, {}, {}", words, name, measure), quantity,
                                    seen(view, search), seen(view, {scene::Parallax{}}),
                                    at_most(1.0)));
        }
    }
    return figures;
}

} // namespace

std::vector<Conclusion> ray_searches() {
    return {
        {"J 2.3.3", "Following the ray in steps makes parallax more accurate.",
         "less error in pixels, and fewer wrong pixels, than parallax",
         joined(over_one_shift("steep parallax", {scene::Steep{}}),
                over_one_shift("parallax occlusion mapping", {scene::Pom{}}))},
        {.source = "J 2.3.3",
         .claim = "Parallax occlusion mapping shows what hides what, as its name says.",
         .rule = "at most 1 % of its pixels show a point that nearer ground hides (our reading)",
         .figures = hidden_points("distance-searches.json", {scene::Pom{}}, at_most(1.0)),
         .reason = "It passes through walls and ridges that are thinner than a step. Its one "
                   "secant takes the surface between two steps for straight, which a wall is not; "
                   "relief, with eight halvings, shows fewer hidden points."},
    };
}

} // namespace reljef::bench

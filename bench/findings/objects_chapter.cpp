// Buildings as relief beside buildings as objects: the question of J.
#include <fmt/format.h>

#include "bench/findings/conclusions.h"
#include "bench/findings/figures.h"

namespace reljef::bench {
namespace {

RowName as_relief(const CityView& view) {
    return city(view, "heights", {scene::Relief{}});
}

RowName as_objects(const CityView& view) {
    return city(view, "meshes", {scene::Polygons{.error = 1.0}});
}

CityView built_in(int distance) {
    return {"objects.json", "urban 1024", distance};
}

CityView delft(int distance, int down = 15) {
    return {"objects-delft.json", "Delft", distance, down};
}

CityView ann_arbor(int distance, int down = 15) {
    return {"objects-annarbor.json", "Ann Arbor", distance, down};
}

// The quantity of relief over that of objects.
Figure share_of_objects(const std::string& words, Quantity quantity, const CityView& view,
                        const Range& range) {
    return ratio(words, quantity, as_relief(view), as_objects(view), range);
}

Figure wrong_of_relief(const std::string& words, const CityView& view, const Range& range) {
    return plain(words, Quantity::wrong, as_relief(view), range);
}

Figure wrong_of_objects(const CityView& view) {
    return plain("", Quantity::wrong, as_objects(view), {});
}

// Wrong pixels of relief at a flat angle over those at a steep one.
Figure flatter(const std::string& words, const CityView& flat, const CityView& steep) {
    return ratio(words, Quantity::wrong, as_relief(flat), as_relief(steep), at_least(1.0));
}

std::vector<Figure> shares_of_objects(Quantity quantity) {
    std::vector<Figure> figures;
    for (const int distance : {300, 3000}) {
        const std::string from = distance == 300 ? "300 m" : "3 km";
        for (const auto& [name, view] : {std::pair{"city", built_in(distance)},
                                         {"Delft", delft(distance)},
                                         {"Ann Arbor", ann_arbor(distance)}}) {
            figures.push_back(
                share_of_objects(fmt::format("{}, {}", name, from), quantity, view, at_most(1.0)));
        }
    }
    return figures;
}

std::vector<Figure> wrongs_of_relief(int distance, const Range& range) {
    return {wrong_of_relief("city", built_in(distance), range),
            wrong_of_relief("Delft", delft(distance), range),
            wrong_of_relief("Ann Arbor", ann_arbor(distance), range)};
}

std::vector<Chapter::Sentence> objects_answer() {
    return {
        {"From 1 km over the built-in city (476 buildings), relief takes {} the time of objects, "
         "with {} of its pixels wrong; objects, as triangles within one pixel, have {}.",
         {share_of_objects("", Quantity::ms, built_in(1000), at_most(1.0)),
          wrong_of_relief("", built_in(1000), {}), wrong_of_objects(built_in(1000))}},
        {"From 100 m, it still takes {} their time, but {} of its pixels are wrong.",
         {share_of_objects("", Quantity::ms, built_in(100), at_most(1.0)),
          wrong_of_relief("", built_in(100), at_least(10.0))}},
        {"Over Delft (3062 buildings, heights every 5 m) it takes {}, {} and {} the time of "
         "objects from 300 m, 1 km and 3 km, with {}, {} and {} wrong.",
         {share_of_objects("", Quantity::ms, delft(300), {}),
          share_of_objects("", Quantity::ms, delft(1000), {}),
          share_of_objects("", Quantity::ms, delft(3000), {}), wrong_of_relief("", delft(300), {}),
          wrong_of_relief("", delft(1000), {}), wrong_of_relief("", delft(3000), {})}},
    };
}

} // namespace

Chapter objects_chapter() {
    Chapter chapter{"Are buildings better as relief or as objects?", objects_answer()};
    chapter.conclusions = {
        {"J 1", "In large cities, objects take more time than relief.", "less time than objects",
         shares_of_objects(Quantity::ms), "",
         "Relief costs by pixels, objects by buildings. Relief wins where buildings are many and "
         "fill little of the picture."},
        {"J 1", "In large cities, buildings as objects are too much data; relief needs less.",
         "less memory of the GPU than objects", shares_of_objects(Quantity::bytes), "",
         "Relief needs memory by area and resolution, objects by buildings. Ann Arbor has one "
         "sample every 0.6 m, but 92 buildings."},
        {"J 1, 2.7.2", "Relief can replace objects from middle heights.",
         "from 1 km, at most 10 % of the pixels wrong (our limit)",
         wrongs_of_relief(1000, at_most(10.0))},
        {"J 2.7.2", "From 100 m, it cannot.", "more than 10 % of the pixels wrong (our limit)",
         wrongs_of_relief(100, at_least(10.0)), "",
         "What 11 steps miss are walls. The outlines of Delft are of 5 m, so that its walls are "
         "slopes several samples wide; most of Ann Arbor is level."},
        {"J 3",
         "Flat angles show the faults of relief.",
         "from 300 m, more wrong pixels at 15 degrees than at 45",
         {flatter("city", built_in(300), {"objects.json", "urban 1024", 300, 45}),
          flatter("Delft", delft(300), delft(300, 45)),
          flatter("Ann Arbor", ann_arbor(300), ann_arbor(300, 45))}},
    };
    return chapter;
}

} // namespace reljef::bench

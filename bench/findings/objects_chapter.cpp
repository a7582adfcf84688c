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

// The buildings alone, without their ground.
RowName as_objects_alone(const CityView& view) {
    return city(view, "meshes-only", {scene::Polygons{.error = 1.0}});
}

Figure wrong_of_relief(const std::string& words, const CityView& view, const Range& range) {
    return plain(words, Quantity::wrong, as_relief(view), range);
}

// Wrong pixels of relief at a flat angle over those at a steep one.
Figure flatter(const std::string& words, const CityView& flat, const CityView& steep) {
    return ratio(words, Quantity::wrong, as_relief(flat), as_relief(steep), at_least(1.0));
}

std::string distance_words(int metres) {
    return metres < 1000 ? fmt::format("{} m", metres) : fmt::format("{} km", metres / 1000);
}

// The quantity of relief over that of buildings and ground as triangles.
Figure over_objects(const std::string& words, Quantity quantity, const CityView& view) {
    return ratio(fmt::format("{}, {}", words, distance_words(view.distance)), quantity,
                 as_relief(view), as_objects(view), at_most(1.0));
}

// The quantity of relief over that of the buildings alone.
Figure over_buildings(const std::string& words, Quantity quantity, const CityView& view) {
    return ratio(fmt::format("{}, {}", words, distance_words(view.distance)), quantity,
                 as_relief(view), as_objects_alone(view), at_most(1.0));
}

std::vector<Figure> in_all_cities(Quantity quantity) {
    std::vector<Figure> figures;
    for (const int distance : {300, 3000}) {
        figures.push_back(over_objects("city", quantity, built_in(distance)));
        figures.push_back(over_objects("Delft", quantity, delft(distance)));
        figures.push_back(over_objects("Ann Arbor", quantity, ann_arbor(distance)));
    }
    for (const int distance : {300, 3000}) {
        figures.push_back(
            over_buildings("buildings of the city alone", quantity, built_in(distance)));
    }
    return figures;
}

std::vector<Figure> in_all_cities_from(int distance, const Range& range) {
    return {wrong_of_relief("city", built_in(distance), range),
            wrong_of_relief("Delft", delft(distance), range),
            wrong_of_relief("Ann Arbor", ann_arbor(distance), range)};
}

std::vector<Chapter::Sentence> objects_answer() {
    const auto share = [](const RowName& relief, const RowName& objects) {
        return ratio("", Quantity::ms, relief, objects, {});
    };
    return {
        {"From 1 km over the built-in city (476 buildings), relief takes {} the time of buildings "
         "and ground as triangles within one pixel, and {} that of the buildings alone. {} of its "
         "pixels are wrong.",
         {share(as_relief(built_in(1000)), as_objects(built_in(1000))),
          share(as_relief(built_in(1000)), as_objects_alone(built_in(1000))),
          wrong_of_relief("", built_in(1000), {})}},
        {"From 100 m, it takes {} and {} of these times, and {} are wrong.",
         {share(as_relief(built_in(100)), as_objects(built_in(100))),
          share(as_relief(built_in(100)), as_objects_alone(built_in(100))),
          wrong_of_relief("", built_in(100), {})}},
        {"Over Delft (3062 buildings, heights every 5 m) it takes {}, {} and {} the time of "
         "buildings and ground from 300 m, 1 km and 3 km, with {}, {} and {} wrong.",
         {share(as_relief(delft(300)), as_objects(delft(300))),
          share(as_relief(delft(1000)), as_objects(delft(1000))),
          share(as_relief(delft(3000)), as_objects(delft(3000))),
          wrong_of_relief("", delft(300), {}), wrong_of_relief("", delft(1000), {}),
          wrong_of_relief("", delft(3000), {})}},
    };
}

} // namespace

Chapter objects_chapter() {
    Chapter chapter{"Are buildings better as relief or as objects?", objects_answer()};
    const CityView few_near{"objects.json", "urban 256", 300};
    const CityView few_far{"objects.json", "urban 256", 1000};
    chapter.conclusions = {
        {"J 1", "In large cities, objects take more time than relief.", "less time than objects",
         in_all_cities(Quantity::ms), "",
         "Relief costs by pixels, objects by buildings and by the triangles of their ground. Where "
         "buildings fill the picture, drawing them alone is faster."},
        {"J 1",
         "Few buildings are no problem as objects.",
         "less time than relief",
         {ratio("35 buildings alone, 300 m", Quantity::ms, as_objects_alone(few_near),
                as_relief(few_near), at_most(1.0)),
          ratio("1 km", Quantity::ms, as_objects_alone(few_far), as_relief(few_far), at_most(1.0))},
         "",
         "From far, relief has few pixels to search, but a building stays a building."},
        {"J 1", "In large cities, buildings as objects are too much data; relief needs less.",
         "less memory of the GPU than objects", in_all_cities(Quantity::bytes), "",
         "Relief needs memory by area and resolution, objects by buildings. Ann Arbor has a sample "
         "every 0.6 m, but 92 buildings."},
        {"J 1, 2.7.2", "Relief can replace objects from middle heights.",
         "from 1 km, at most 10 % of the pixels wrong (our limit)",
         in_all_cities_from(1000, at_most(10.0)),
         "a texel is 0.5 m in the city, 5 m in Delft, 0.6 m in Ann Arbor",
         "Its steps miss walls from any distance. Walls of Delft are slopes of several samples, "
         "because its heights are 5 m apart."},
        {"J 2.7.2", "From 100 m, it cannot.", "more than 10 % of the pixels wrong (our limit)",
         in_all_cities_from(100, at_least(10.0)), "the same texels",
         "As from 1 km: what it misses does not depend on the distance."},
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

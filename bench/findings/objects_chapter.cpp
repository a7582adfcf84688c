// Buildings as relief beside buildings as objects: the question of J.
#include <utility>

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

// How far relief is from the true picture, beside buildings and ground as triangles.
Figure looks_of_relief(const std::string& words, const CityView& view, const Range& range) {
    return ratio(words, Quantity::flip, as_relief(view), as_objects(view), range);
}

// The same for exact rays over the heights.
Figure looks_of_heights(const std::string& words, const CityView& view) {
    return ratio(words, Quantity::flip, city(view, "heights", {scene::Exact{}}), as_objects(view),
                 {});
}

// Wrong pixels of relief at a flat angle over those at a steep one, from one distance.
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

std::vector<Figure> in_large_cities(Quantity quantity) {
    std::vector<Figure> figures;
    for (const int distance : {300, 3000}) {
        figures.push_back(over_objects("city", quantity, built_in(distance)));
        figures.push_back(over_objects("Delft", quantity, delft(distance)));
    }
    for (const int distance : {300, 3000}) {
        figures.push_back(
            over_buildings("buildings of the city alone", quantity, built_in(distance)));
    }
    return figures;
}

std::vector<Figure> looks_in_all_cities(int distance, const Range& range) {
    const std::string words = distance_words(distance);
    return {looks_of_relief(fmt::format("city, {}", words), built_in(distance), range),
            looks_of_relief(fmt::format("Delft, {}", words), delft(distance), range),
            looks_of_relief(fmt::format("Ann Arbor, {}", words), ann_arbor(distance), range)};
}

// The time of objects over that of relief in the built-in cities of 35, 81 and 476 buildings.
std::vector<Figure> by_number(RowName (*objects)(const CityView&), int distance,
                              const Range& range) {
    std::vector<Figure> figures;
    for (const char* scene : {"urban 256", "urban 512", "urban 1024"}) {
        const CityView view{"objects.json", scene, distance};
        figures.push_back(ratio("", Quantity::ms, objects(view), as_relief(view), range));
    }
    return figures;
}

// Few buildings over relief, from 300 m.
std::vector<Figure> few_buildings() {
    std::vector<Figure> figures;
    for (const auto& [count, scene] : {std::pair{35, "urban 256"}, {81, "urban 512"}}) {
        const CityView view{"objects.json", scene, 300};
        figures.push_back(ratio(fmt::format("{} buildings", count), Quantity::ms, as_objects(view),
                                as_relief(view), at_most(1.0)));
    }
    figures.push_back(ratio("92 buildings of Ann Arbor", Quantity::ms, as_objects(ann_arbor(300)),
                            as_relief(ann_arbor(300)), at_most(1.0)));
    const CityView few{"objects.json", "urban 256", 300};
    figures.push_back(ratio("35 buildings without ground", Quantity::ms, as_objects_alone(few),
                            as_relief(few), at_most(1.0)));
    return figures;
}

std::vector<Chapter::Sentence> objects_answer() {
    const auto share = [](const RowName& relief, const RowName& objects) {
        return ratio("", Quantity::ms, relief, objects, {});
    };
    return {
        {"The eye looks 15 degrees down. From 1 km over the built-in city (476 buildings), relief "
         "takes {} the time of buildings and ground as triangles within one pixel, and {} that of "
         "the buildings alone. Its picture differs {} as much from the true one (FLIP) as that of "
         "these triangles, and that of exact rays over the same heights {}.",
         {share(as_relief(built_in(1000)), as_objects(built_in(1000))),
          share(as_relief(built_in(1000)), as_objects_alone(built_in(1000))),
          looks_of_relief("", built_in(1000), {}), looks_of_heights("", built_in(1000))}},
        {"From 100 m, it takes {} and {} of these times, and differs {} as much; exact rays {}.",
         {share(as_relief(built_in(100)), as_objects(built_in(100))),
          share(as_relief(built_in(100)), as_objects_alone(built_in(100))),
          looks_of_relief("", built_in(100), {}), looks_of_heights("", built_in(100))}},
        {"Over Delft (3062 buildings, heights every 5 m) it takes {}, {} and {} the time of "
         "buildings and ground from 300 m, 1 km and 3 km, and differs {}, {} and {} as much.",
         {share(as_relief(delft(300)), as_objects(delft(300))),
          share(as_relief(delft(1000)), as_objects(delft(1000))),
          share(as_relief(delft(3000)), as_objects(delft(3000))),
          looks_of_relief("", delft(300), {}), looks_of_relief("", delft(1000), {}),
          looks_of_relief("", delft(3000), {})}},
        {"35, 81 and 476 buildings with their ground take {}, {} and {} the time of relief from "
         "300 m, and {}, {} and {} from 1 km.",
         joined(by_number(as_objects, 300, {}), by_number(as_objects, 1000, {}))},
        {"Alone they take {}, {} and {}, and from 1 km {}, {} and {}: whether relief is faster "
         "than buildings is decided by distance rather than by their number.",
         joined(by_number(as_objects_alone, 300, at_most(1.0)),
                by_number(as_objects_alone, 1000, at_least(1.0)))},
    };
}

} // namespace

Chapter objects_chapter() {
    Chapter chapter{"Are buildings better as relief or as objects?", objects_answer()};
    chapter.conclusions = {
        {"J 1", "In large cities, objects take more time than relief.", "less time than objects",
         in_large_cities(Quantity::ms), "",
         "Relief costs by pixels, objects by buildings and by the triangles of their ground. Where "
         "buildings fill the picture, drawing them alone is faster."},
        {"J 1", "Few buildings are no problem as objects.", "from 300 m, less time than relief",
         few_buildings(), "",
         "The ground below them is triangles, too, and costs more than few buildings do."},
        {"J 1", "In large cities, buildings as objects are too much data; relief needs less.",
         "fewer bytes sent to the GPU for the first frame", in_large_cities(Quantity::bytes), "",
         "Relief needs memory by area and resolution, objects by buildings."},
        {"J 1, 2.7.2", "Relief can replace objects from middle heights.",
         "from 1 and 3 km, at most 1.25 times the difference (FLIP) of objects from the true "
         "picture (our reading)",
         joined(looks_in_all_cities(1000, at_most(1.25)), looks_in_all_cities(3000, at_most(1.25))),
         "",
         "From 3 km the built-in city and Ann Arbor look the same. Delft has a height every 5 m, "
         "which shows as long as a building is wider than some pixels."},
        {"J 2.7.2", "From 100 m, it cannot.", "more than 1.25 times (our reading)",
         looks_in_all_cities(100, at_least(1.25))},
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

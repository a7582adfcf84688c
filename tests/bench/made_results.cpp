#include "tests/bench/made_results.h"

namespace reljef::test {

bench::Results made_results(const std::string& scene) {
    bench::Row row;
    row.suite = "tables";
    row.scene = scene;
    row.technique = scene::make_technique(scene::TechniqueId::texture);
    row.size = {1024, 768};
    row.frames = 20;
    row.ms = {2.0, 2.5, 3.0};
    row.noise_floor = 0.05;
    row.stats.triangles = 2;
    row.stats.draws = 2;
    row.stats.uploads = 1;
    bench::Row polygons = row;
    polygons.technique = scene::make_technique(scene::TechniqueId::polygons);
    polygons.ms = {8.0, 9.0, 10.0};
    polygons.ratio_to_texture = 4.0;
    polygons.stats.triangles = 2'097'152;
    polygons.stats.skipped.tiles_outside_frustum = 17;
    bench::Row again = row;
    again.null_row = true;
    again.ms.median = 2.1;
    again.ratio_to_texture = 1.05;
    bench::Results results;
    results.environment = {"a renderer", "4.5 of it", "osmesa", 2, "a processor", "0123456789ab"};
    results.rows = {row, polygons, again};
    return results;
}

} // namespace reljef::test

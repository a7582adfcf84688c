#include "bench/findings/measurements.h"

#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace reljef::bench {

namespace {

std::string city_command(const std::string& city) {
    return fmt::format("reljef-bench objects --rounds 15 --size 512x384 --context osmesa "
                       "--terrain {0}.toml --json bench/results/objects-{0}.json "
                       "--markdown bench/results/objects-{0}.md",
                       city);
}

std::string bricks_command(const std::string& pose) {
    return fmt::format(
        "reljef-bench tables --context osmesa --pose {0} --terrain gallery "
        "--technique emboss --technique normal --technique bump --technique relief "
        "--technique relief:shadow=hard --technique relief:fade=0..1 "
        "--technique relief:n=5,k=8 --technique relief:n=5,k=8,fade=0..1 "
        "--technique exact --technique exact:shadow=hard --json bench/results/bricks-{0}.json "
        "--markdown bench/results/bricks-{0}.md",
        pose);
}

} // namespace

std::string ResultsSource::suite() const {
    constexpr std::string_view program = "reljef-bench ";
    std::string verb =
        command.substr(program.size(), command.find(' ', program.size()) - program.size());
    for (const std::string_view variant : {"claims", "distances", "guesses"}) {
        if (command.find(fmt::format(" --{} ", variant)) != std::string::npos) {
            return fmt::format("{}-{}", verb, variant);
        }
    }
    return verb;
}

namespace {

std::vector<ResultsSource> technique_sources() {
    return {
        {"tables", "The seven tests of J on built-in terrains, with J's figures beside ours.",
         "reljef-bench tables --context osmesa --json bench/results/tables.json "
         "--markdown bench/results/tables.md"},
        {"oblique", "Every technique on a city and a landscape, from the pose oblique.",
         "reljef-bench tables --context osmesa --terrain bench/scenes/urban-s05.toml "
         "--terrain natural --pose oblique --json bench/results/oblique.json "
         "--markdown bench/results/oblique.md"},
        {"pareto", "Every technique over the range of each parameter, and with each option.",
         "reljef-bench pareto --context osmesa --size 512x384 --rounds 5 "
         "--json bench/results/pareto.json --markdown bench/results/pareto.md"},
        {"peers", "Irrlicht's terrain node, which J used, beside our triangles.",
         "reljef-bench peers --terrain N45E006.hgt --rounds 15 --json bench/results/peers.json "
         "--markdown bench/results/peers.md"},
        {"angles", "Wrong pixels of all techniques from straight above to flat angles.",
         "reljef-bench stress --only grazing-view --context osmesa "
         "--json bench/results/angles.json --markdown bench/results/angles.md"},
        {"steps", "The searches of M's figures, with their numbers of steps.",
         "reljef-bench tables --context osmesa --terrain bench/scenes/urban-s05.toml "
         "--terrain natural --pose oblique --rounds 5 --technique relief:n=1,k=8 "
         "--technique relief:n=11,k=8 --technique relief:n=20,k=4 --technique steep:n=40 "
         "--technique relief:n=25,k=8 --technique relief:n=11,k=8,steps=5..25 "
         "--json bench/results/steps.json --markdown bench/results/steps.md"},
        {"scales", "A city and a landscape as high as M's two scales make them.",
         "reljef-bench tables --context osmesa --rounds 5 --pose oblique "
         "--terrain bench/scenes/urban-s04.toml --terrain bench/scenes/urban-s15.toml "
         "--terrain bench/scenes/natural-s04.toml --terrain bench/scenes/natural-s15.toml "
         "--technique parallax --technique parallax-iterated --technique steep:n=5 "
         "--technique relief:n=5,k=4 --json bench/results/scales.json "
         "--markdown bench/results/scales.md"},
        {"bricks-map", "Bricks from straight above.", bricks_command("map")},
        {"bricks-grazing", "Bricks at a flat angle.", bricks_command("grazing")},
    };
}

std::vector<ResultsSource> other_sources() {
    return {
        {"distance", "Errors over the distance of the eye.",
         "reljef-bench tables --distances --context osmesa --json bench/results/distance.json "
         "--markdown bench/results/distance.md",
         false},
        {"distance-searches", "The same of steep parallax, parallax occlusion mapping and warping.",
         "reljef-bench tables --distances --context osmesa --technique steep --technique pom "
         "--technique prewarp --json bench/results/distance-searches.json "
         "--markdown bench/results/distance-searches.md",
         false},
        {"objects", "The same city as heights and as meshes, by distance, angle and size.",
         "reljef-bench objects --rounds 15 --context osmesa --json bench/results/objects.json "
         "--markdown bench/results/objects.md"},
        {"objects-delft", "The same for Delft, from a surface model of 5 m and its outlines.",
         city_command("delft")},
        {"objects-annarbor", "The same for Ann Arbor, from lidar and its outlines.",
         city_command("annarbor")},
        {"h100/tables", "The tests of J with a graphics card, by an earlier version.",
         "reljef-bench tables --context egl --calibration egl.json --rounds 100 "
         "--json bench/results/h100/tables.json --markdown bench/results/h100/tables.md"},
        {"h100/oblique", "Every technique from the pose oblique with a graphics card, likewise.",
         "reljef-bench tables --context egl --terrain bench/scenes/urban-s05.toml "
         "--terrain natural --pose oblique --rounds 60 --json bench/results/h100/oblique.json "
         "--markdown bench/results/h100/oblique.md"},
        {"guesses", "Heights guessed from colours, against the true ones, by exact rays.",
         "reljef-bench tables --guesses --terrain urban --terrain natural "
         "--terrain bench/scenes/crater-lake.toml --json bench/results/guesses.json "
         "--markdown bench/results/guesses.md",
         false},
        {"claims",
         "A city of one repeated tile, relief over a city only, four layers on bricks, and the "
         "phases of warping.",
         "reljef-bench tables --claims --context osmesa --size 512x384 --rounds 9 "
         "--json bench/results/claims.json --markdown bench/results/claims.md"},
    };
}

} // namespace

// The commands of bench/results/README.md.
std::vector<ResultsSource> results_sources() {
    std::vector<ResultsSource> sources = technique_sources();
    for (ResultsSource& source : other_sources()) {
        sources.push_back(std::move(source));
    }
    return sources;
}

} // namespace reljef::bench

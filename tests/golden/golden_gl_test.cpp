#include <algorithm>
#include <cstdlib>
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "engine/platform/context.h"
#include "engine/scene/technique/technique.h"
#include "engine/session/frame_maker.h"
#include "engine/session/gallery.h"
#include "engine/session/prepared_maps.h"
#include "engine/session/scene_setup.h"
#include "tests/app/command_line.h"
#include "tests/golden/golden_picture.h"
#include "tests/scene/technique/terrain_techniques.h"
#include "tests/session/made_session.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_context.h"
#include "tests/support/test_data.h"

namespace reljef {
namespace {

struct GoldenCase {
    std::string name;
    std::string terrain; ///< built-in, or a file of the test data where `is_data`
    bool is_data = false;
    std::vector<std::string> options;
    bool is_made_here = false; ///< in this process, not by the program
};

void PrintTo(const GoldenCase& golden, std::ostream* stream) {
    *stream << golden.name;
}

// Each technique and the exact picture on each built-in terrain, what tiles on meshes add, and real
// elevation data.
std::vector<GoldenCase> golden_cases() {
    std::vector<GoldenCase> cases;
    for (const std::string terrain : {"natural", "urban"}) {
        for (const scene::TechniqueInfo& technique : scene::terrain_techniques()) {
            const std::string id(technique.name);
            std::string name = terrain + "_" + id;
            std::replace(name.begin(), name.end(), '-', '_');
            cases.push_back({name, terrain, false, {"--technique", id}, true});
        }
        cases.push_back({terrain + "_truth", terrain, false, {"--truth"}, true});
    }
    cases.push_back({"gallery", "gallery", false, {}});
    for (const std::string id : {"displacement", "bump", "emboss", "normal", "relief"}) {
        cases.push_back({"gallery_" + id, "gallery", false, {"--technique", id}, true});
    }
    cases.push_back(
        {"urban_options",
         "urban",
         false,
         {"--technique", "relief:steps=16..64,fade=0.6..1,2,shadow=soft,0.1,edges=smooth,0.01"},
         true});
    cases.push_back({"natural_shadow",
                     "natural",
                     false,
                     {"--technique", "exact:shadow=hard,depth=write"},
                     true});
    cases.push_back(
        {"natural_detail",
         "natural",
         false,
         {"--detail", "rock:width=14,scale=0.1", "--detail-technique", "exact:shadow=hard",
          "--max-error", "1", "--eye", "0,-3000,774", "--look", "300,-2400,765"}});
    cases.push_back(
        {"gallery_silhouettes", "gallery", false, {"--technique", "exact:silhouettes=true"}, true});
    cases.push_back(
        {"gallery_shadow", "gallery", false, {"--technique", "relief:shadow=hard"}, true});
    cases.push_back({"urban_mesh_shadow",
                     "urban",
                     false,
                     {"--buildings", "meshes", "--technique", "polygons:shadow=hard", "--pose",
                      "low", "--sun", "220,40"}});
    cases.push_back({"urban_detail",
                     "urban",
                     false,
                     {"--detail", "cobble:width=3", "--pose", "low", "--max-error", "none"}});
    cases.push_back({"alps",
                     "natural/srtm3/N45E006.hgt",
                     true,
                     {"--camera", "45.60,6.70,5200,20,-18", "--max-error", "none"}});
    cases.push_back({"rainier", "natural/mt_rainier_90m.tif", true, {"--max-error", "none"}});
    cases.push_back({"delft", "urban/delft/tud-dsm-5m.tif", true, {"--max-error", "none"}});
    return cases;
}

// Whether the case or its scene places the camera. The other pictures are from the pose overview.
bool has_camera(const GoldenCase& golden) {
    const auto is_camera = [](const std::string& option) {
        return option == "--pose" || option == "--eye" || option == "--camera";
    };
    return golden.terrain == "gallery" ||
           std::any_of(golden.options.begin(), golden.options.end(), is_camera);
}

constexpr glm::ivec2 picture_size{320, 240};

// Generated once for all pictures of a process, which takes longer than most of them.
const session::TerrainSource& generated(const std::string& terrain) {
    static std::map<std::string, session::TerrainSource> sources;
    auto found = sources.find(terrain);
    if (found == sources.end()) {
        session::SourceOptions options;
        options.terrain = terrain;
        found = sources.emplace(terrain, test::open_terrain(options).value()).first;
    }
    return found->second;
}

std::unique_ptr<session::FrameMaker> frame_maker(bool truth, session::Log& log) {
    if (truth) {
        return std::make_unique<session::TruthFrames>(picture_size, 1, log);
    }
    session::DeviceOptions options;
    options.context = session::backend_from_string(test::context_name()).value();
    options.size = picture_size;
    options.samples = 1;
    return std::make_unique<session::DeviceFrames>(session::Device::create(options).value(), log);
}

// The gallery with its textures, made once.
session::TerrainScene& gallery() {
    static session::TerrainScene made = [] {
        session::Log silent;
        session::SceneOptions view;
        view.size = picture_size;
        return session::make_scene(generated("gallery"), {}, view, silent).value();
    }();
    return made;
}

Result<void> add_maps(session::TerrainScene& scene, session::Log& log) {
    const auto maps = session::prepare_maps(session::missing_maps(scene), 0, log, {});
    if (!maps) {
        return maps.error();
    }
    session::apply_maps(scene, *maps);
    return {};
}

// What the program draws of the gallery with one technique.
Result<Image> drawn_of_gallery(const std::vector<std::string>& options) {
    session::Log silent;
    session::TerrainScene& shown = gallery();
    for (scene::Material* const material : shown.materials()) {
        material->technique = scene::parse_technique(options.at(1)).value();
    }
    session::shadow_floor(*shown.terrain->get<scene::TerrainNode>(), shown.models);
    if (auto added = add_maps(shown, silent); !added) {
        return added.error();
    }
    return frame_maker(false, silent)->draw(shown.scene, {});
}

// What the program draws of a generated terrain with a technique, or by exact rays.
Result<Image> drawn_as_generated(const std::string& terrain,
                                 const std::vector<std::string>& options) {
    session::Log silent;
    const bool is_true = options == std::vector<std::string>{"--truth"};
    session::SceneOptions view;
    view.size = picture_size;
    view.pose = scene::Pose::overview;
    if (!is_true) {
        view.technique = scene::parse_technique(options.at(1)).value();
    }
    auto scene = session::make_scene(generated(terrain), {}, view, silent);
    if (!scene) {
        return scene.error();
    }
    if (!is_true) {
        if (auto added = add_maps(*scene, silent); !added) {
            return added.error();
        }
    }
    return frame_maker(is_true, silent)->draw(scene->scene, {});
}

// What the program draws.
Result<Image> drawn_by_program(const GoldenCase& golden) {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "picture.png";
    std::vector<std::string> arguments{
        "render",     golden.is_data ? test::data_path(golden.terrain).string() : golden.terrain,
        "--size",     "320x240",
        "--quiet",    "-o",
        file.string()};
    arguments.insert(arguments.end(), golden.options.begin(), golden.options.end());
    arguments.insert(arguments.end(), {"--context", test::context_name(), "--samples", "1"});
    if (!has_camera(golden)) {
        arguments.insert(arguments.end(), {"--pose", "overview"});
    }
    const auto run = test::reljef(arguments);
    return run.exit_code == 0 ? io::read_image(file) : Error{run.err};
}

Result<Image> drawn(const GoldenCase& golden) {
    if (!golden.is_made_here) {
        return drawn_by_program(golden);
    }
    return golden.terrain == "gallery" ? drawn_of_gallery(golden.options)
                                       : drawn_as_generated(golden.terrain, golden.options);
}

bool draws_on_gpu() {
    return test::context_name() == "egl" && platform::make_gpu_context();
}

class Golden : public testing::TestWithParam<GoldenCase> {};

TEST_P(Golden, IsStillDrawn) {
    RELJEF_RELEASE_ONLY("each way of drawing has tests of its own");
    const GoldenCase& golden = GetParam();
    if (golden.is_data) {
        RELJEF_NEED_DATA(golden.terrain);
    }
    const auto picture = drawn(golden);
    ASSERT_TRUE(picture) << picture.error().message;
    const test::GoldenFolders folders{RELJEF_GOLDEN_PICTURES, RELJEF_GOLDEN_FAILURES};
    if (std::getenv("RELJEF_WRITE_GOLDENS") != nullptr) { // ./dev goldens
        const auto written = io::write_image(folders.pictures / (golden.name + ".png"), *picture);
        ASSERT_TRUE(written) << written.error().message;
        return;
    }
    // Graphics processors filter textures in ways of their own, above all at outlines, where the
    // pixels beside show something else.
    const bool is_true = golden.options == std::vector<std::string>{"--truth"};
    const test::GoldenLimits limits =
        draws_on_gpu() && !is_true
            ? test::GoldenLimits{.largest_difference = 12, .failing_fraction = 0.007}
            : test::GoldenLimits{};
    const auto checked = test::check_golden(golden.name, *picture, folders, limits);
    EXPECT_TRUE(checked) << checked.error().message;
}

INSTANTIATE_TEST_SUITE_P(Pictures, Golden, testing::ValuesIn(golden_cases()),
                         [](const auto& info) { return info.param.name; });

} // namespace
} // namespace reljef

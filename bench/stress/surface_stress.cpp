// Height maps, files and scales that break searches and arithmetic.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "bench/stress/made_surfaces.h"
#include "bench/stress/stress_stage.h"
#include "bench/stress/view_check.h"
#include "engine/core/atomic_file.h"
#include "engine/scene/motion/poses.h"
#include "engine/session/scene_setup.h"

namespace reljef::bench {
namespace {

namespace fs = std::filesystem;

std::vector<StressView> pose_views(const StressStage& stage,
                                   std::initializer_list<scene::Pose> poses) {
    const Box bounds = stage.surface().bounds();
    std::vector<StressView> views;
    for (const scene::Pose pose : poses) {
        scene::Camera camera = scene::pose_camera(pose, bounds, [&](double x, double y) {
            return stage.surface().height_at(x, y).value_or(bounds.low.z);
        });
        camera.near = session::near_distance(bounds);
        views.push_back({std::string(to_string(pose)), camera});
    }
    return views;
}

struct ScaledTerrain {
    std::string name;
    terrain::Terrain terrain;
    double exaggeration = 1.0;
};

std::vector<ScaledTerrain> scaled_terrains() {
    constexpr glm::ivec2 size(65);
    std::vector<ScaledTerrain> all;
    for (const double exaggeration : {1e-6, 1e-3, 1e3, 1e6}) {
        all.push_back({fmt::format("exaggeration {:g}", exaggeration), made_hills(size, 2.0, 12.0),
                       exaggeration});
    }
    for (const double spacing : {1e-6, 1e-3, 1e3, 1e6}) {
        all.push_back(
            {fmt::format("spacing {:g} m", spacing), made_hills(size, spacing, 6.0 * spacing)});
    }
    all.push_back({"1 m of relief over 1e7 m", made_hills(size, 1e7 / 64.0, 1.0)});
    for (const double level : {1e4, 1e7}) {
        terrain::Terrain high =
            made_terrain("high", size, 2.0 * level / 1e4, [level](int col, int row) {
                return level * (1.0 + 0.001 * std::sin(0.2 * col) * std::cos(0.15 * row));
            });
        all.push_back({fmt::format("heights around {:g} m", level), std::move(high)});
    }
    return all;
}

// Whether the exact rays see ground from any of the views.
Result<bool> shows_ground(StressRun& run, StressStage& stage,
                          const std::vector<StressView>& views) {
    for (const StressView& view : views) {
        stage.look(view.camera);
        const auto hits = stage.true_hits(run.size(), run.parallel());
        if (!hits) {
            return hits.error();
        }
        if (truth::has_terrain(*hits)) {
            return true;
        }
    }
    return false;
}

struct OddFile {
    std::string name;
    std::string text; ///< an ESRI ASCII grid
};

std::string ascii_grid(glm::ivec2 size, const std::string& header,
                       const std::function<std::string(int col, int row)>& value_at) {
    std::string text =
        fmt::format("ncols {}\nnrows {}\nxllcorner 0\nyllcorner 0\n{}", size.x, size.y, header);
    for (int row = 0; row < size.y; ++row) {
        for (int col = 0; col < size.x; ++col) {
            text += value_at(col, row) + (col + 1 < size.x ? " " : "\n");
        }
    }
    return text;
}

std::vector<OddFile> odd_files() {
    const auto slope = [](int col, int row) { return fmt::format("{}.5", 3 * col + row); };
    const auto slope_with = [slope](const std::string& word) {
        return [slope, word](int col, int row) {
            return col == 3 && row == 4 ? word : slope(col, row);
        };
    };
    const std::string usual = "cellsize 10\nNODATA_value -9999\n";
    const auto constant = [](const std::string& word) { return [word](int, int) { return word; }; };
    std::vector<OddFile> files;
    for (const std::string word : {"nan", "inf", "-inf", "1e39", "-9999"}) {
        files.push_back({word, ascii_grid({9, 9}, usual, slope_with(word))});
    }
    files.push_back({"all void", ascii_grid({9, 9}, usual, constant("-9999"))});
    files.push_back({"all nan", ascii_grid({9, 9}, usual, constant("nan"))});
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(2, 2), glm::ivec2(1, 40),
                                  glm::ivec2(40, 1), glm::ivec2(65536, 2)}) {
        files.push_back({fmt::format("{}x{}", size.x, size.y), ascii_grid(size, usual, slope)});
    }
    for (const std::string cell : {"0", "-10", "nan", "1e300", "1e-300"}) {
        files.push_back(
            {"cellsize " + cell, ascii_grid({9, 9}, fmt::format("cellsize {}\n", cell), slope)});
    }
    return files;
}

bool exceeds_textures(StressRun& run, const StressStage& stage) {
    const Grid<float>& heights = stage.surface().heightfield().heights;
    return std::max(heights.cols(), heights.rows()) > run.renderer().max_texture_side();
}

// Results of two runs are compared: a temporary folder would differ.
std::string without_folder(std::string text, const fs::path& folder) {
    const std::string prefix = folder.string() + "/";
    for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) {
        text.erase(at, prefix.size());
    }
    return text;
}

Result<void> check_file(StressRun& run, const std::string& name, const fs::path& path) {
    session::SourceOptions source;
    source.terrain = path.string();
    source.placement = terrain::PlacementKind::plane;
    session::Log silent;
    auto opened = session::open_terrain(source, silent, run.stop());
    const std::string refusal = opened ? "" : opened.error().message;
    const bool is_clear = opened || refusal.find(path.filename().string()) != std::string::npos;
    run.add({.stress = "odd file",
             .terrain = name,
             .figure = "errors that do not name the file",
             .value = is_clear ? 0.0 : 1.0,
             .limit = 0.0,
             .at = opened ? "opened" : without_folder(refusal, path.parent_path())});
    if (!opened) {
        return {};
    }
    auto stage = StressStage::create(std::move(opened->terrain));
    if (!stage) {
        return stage.error();
    }
    const auto views = pose_views(*stage, {scene::Pose::overview, scene::Pose::oblique});
    return check_views(run,
                       {.stress = "odd file", .exceeds_textures = exceeds_textures(run, *stage)},
                       name, *stage, views);
}

} // namespace

Result<void> stress_odd_heights(StressRun& run) {
    for (terrain::Terrain& terrain : odd_terrains()) {
        const std::string name = terrain.name;
        auto stage = StressStage::create(std::move(terrain));
        if (!stage) {
            return stage.error();
        }
        const auto views =
            pose_views(*stage, {scene::Pose::overview, scene::Pose::oblique, scene::Pose::grazing});
        const ViewCheck check{.stress = "odd heights",
                              .exceeds_textures = exceeds_textures(run, *stage)};
        if (auto done = check_views(run, check, name, *stage, views); !done) {
            return done;
        }
    }
    return {};
}

Result<void> stress_odd_files(StressRun& run) {
    const auto folder = ScratchFolder::create();
    if (!folder) {
        return folder.error();
    }
    for (const OddFile& file : odd_files()) {
        if (run.stopped()) {
            return {};
        }
        std::string name = file.name;
        std::replace(name.begin(), name.end(), ' ', '-');
        const fs::path path = folder->path() / (name + ".asc");
        if (auto written = write_text_file(path, file.text); !written) {
            return written;
        }
        if (auto done = check_file(run, file.name, path); !done) {
            return done;
        }
    }
    return {};
}

Result<void> stress_scales(StressRun& run) {
    for (ScaledTerrain& scaled : scaled_terrains()) {
        auto stage = StressStage::create(std::move(scaled.terrain), scaled.exaggeration);
        if (!stage) {
            return stage.error();
        }
        const auto views =
            pose_views(*stage, {scene::Pose::overview, scene::Pose::oblique, scene::Pose::low});
        const auto is_seen = shows_ground(run, *stage, views);
        if (!is_seen) {
            return run.stopped() ? Result<void>() : is_seen.error();
        }
        run.add({.stress = "scale",
                 .terrain = scaled.name,
                 .figure = "no view shows ground",
                 .value = *is_seen ? 0.0 : 1.0,
                 .limit = 0.0});
        if (auto done = check_views(run, {.stress = "scale"}, scaled.name, *stage, views); !done) {
            return done;
        }
    }
    return {};
}

} // namespace reljef::bench

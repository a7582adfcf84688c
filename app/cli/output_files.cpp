#include "app/cli/output_files.h"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/core/atomic_file.h"

namespace reljef::cli {
namespace {

namespace fs = std::filesystem;

// The place that a chain of links names, also if nothing is there.
fs::path without_links(fs::path place) {
    constexpr int max_links = 40; // as in Linux
    std::error_code code;
    for (int i = 0; i < max_links && fs::is_symlink(fs::symlink_status(place, code)); ++i) {
        place = place.parent_path() / fs::read_symlink(place, code);
    }
    return place;
}

bool is_same_file(const fs::path& a, const fs::path& b) {
    if (a.empty() || b.empty()) {
        return false;
    }
    std::error_code code;
    if (fs::equivalent(a, b, code)) {
        return true;
    }
    const auto whole = [&](const fs::path& path) {
        return fs::weakly_canonical(fs::absolute(without_links(path), code), code);
    };
    return !whole(a).empty() && whole(a) == whole(b);
}

// Whether writing `output` would replace `input`, or a file in the folder `input`.
bool would_replace(const fs::path& output, const fs::path& input) {
    std::error_code code;
    if (!fs::is_directory(input, code) || !fs::is_regular_file(output, code)) {
        return is_same_file(output, input);
    }
    const fs::path folder = fs::canonical(input, code);
    const fs::path file = fs::canonical(output, code);
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
           folder.end();
}

} // namespace

std::vector<NamedFile> input_files(const TerrainChoice& terrain, const ViewChoice& view) {
    std::vector<NamedFile> files{
        {"TERRAIN", terrain.terrain},
        {"--textures", terrain.textures.value_or("")},
        {"--detail", view.detail.value_or(session::DetailChoice{}).textures},
        {"--path", view.path},
        {"--sky", view.sky.value_or("")},
        {"--ramp", terrain.ramp.value_or("")},
        {"--geoid", terrain.geoid},
        {"--calibration", view.calibration}};
    for (const fs::path& image : terrain.imagery) {
        files.push_back({"--imagery", image});
    }
    for (const auto& object : view.objects) {
        files.push_back({"--object", object.file});
    }
    for (const auto& footprints : view.footprints) {
        files.push_back({"--footprints", footprints.file});
        files.push_back({"--footprints", footprints.surface});
    }
    return files;
}

void check_distinct(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs) {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        for (const NamedFile& input : inputs) {
            if (would_replace(outputs[i].path, input.path)) {
                throw CLI::ValidationError(
                    fmt::format("{}: {} found, which is read as {}; another file was expected",
                                outputs[i].option, outputs[i].path.string(), input.option));
            }
        }
        for (const NamedFile& other : outputs.subspan(i + 1)) {
            if (is_same_file(outputs[i].path, other.path)) {
                throw CLI::ValidationError(
                    fmt::format("{}: {} found, which {} writes too; another file was expected",
                                other.option, other.path.string(), outputs[i].option));
            }
        }
    }
}

Result<void> check_writable(std::span<const NamedFile> outputs) {
    for (const NamedFile& output : outputs) {
        if (output.path.empty()) {
            continue;
        }
        const auto file = AtomicFile::create(output.path);
        if (!file) {
            return file.error();
        }
        remove_leftovers(file->temporary().parent_path());
    }
    return {};
}

} // namespace reljef::cli

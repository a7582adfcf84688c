#include "bench/baselines/povray_scene.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <regex>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/baselines/baseline_files.h"

namespace reljef::bench {
namespace {

constexpr double height_steps = 65535.0;
constexpr double fine_parts =
    256.0; // of the depth range; a picture's green channel repeats in each

// POV-Ray's axes are east, up, north.
std::string povray_vector(glm::dvec3 world) {
    return fmt::format("<{},{},{}>", world.x, world.z, world.y);
}

std::string camera_text(const BaselineView& view) {
    const scene::Camera& camera = view.scene.view();
    const glm::dvec2 size(view.size);
    const glm::dvec3 corner = scene::view_ray(camera, view.size, {0.0, 0.0}).direction;
    const glm::dvec3 right = scene::view_ray(camera, view.size, {size.x, 0.0}).direction - corner;
    const glm::dvec3 up = corner - scene::view_ray(camera, view.size, {0.0, size.y}).direction;
    return fmt::format("camera {{ perspective location {} direction {} right {} up {} }}\n",
                       povray_vector(camera.eye), povray_vector(scene::view_axes(camera).forward),
                       povray_vector(right), povray_vector(up));
}

std::string terrain_text(const BaselineView& view, const std::string& before_placing,
                         const std::string& after_placing) {
    const terrain::Heightfield& heightfield = view.scene.surface().heightfield();
    const glm::dvec2 extent = static_cast<double>(view.side() - 1) * heightfield.spacing;
    const double low = heightfield.range.low;
    const double height = std::max(heightfield.range.high - low, 1e-3);
    return fmt::format("height_field {{ pgm \"heights.pgm\" {} translate <-0.5,0,-0.5> "
                       "scale <{},{},{}> translate <0,{},0> {} finish {{ ambient 1 diffuse 0 }} "
                       "}}\n",
                       before_placing, extent.x, height, extent.y, low, after_placing);
}

// Texels lie at samples.
std::string colors_text(int side) {
    const double cells = side - 1;
    return fmt::format("pigment {{ image_map {{ ppm \"colors.ppm\" gamma srgb interpolate 2 }} "
                       "scale <{0},{0},1> translate <{1},{1},0> rotate x*90 }}",
                       side / cells, -0.5 / cells);
}

// Red: depth over twice the farthest one; green: the same in parts, for its last digits.
std::string depths_text(const BaselineView& view) {
    const scene::Camera& camera = view.scene.view();
    const auto gradient = [&](std::string_view color, double length) {
        return fmt::format("[1 gradient {} color_map {{ [0 rgb 0] [1 rgb {}] }} scale {} "
                           "translate {}]",
                           povray_vector(scene::view_axes(camera).forward), color, length,
                           povray_vector(camera.eye));
    };
    return fmt::format("pigment {{ average pigment_map {{ {} {} }} }}",
                       gradient("<2,0,0>", view.range.far),
                       gradient("<0,2,0>", view.range.far / fine_parts));
}

bool write_numbers(const std::filesystem::path& path, const std::string& header,
                   const std::string& bytes) {
    std::ofstream file(path, std::ios::binary);
    file << header << bytes;
    return static_cast<bool>(file.flush());
}

bool write_heights(const std::filesystem::path& path, const terrain::Heightfield& heightfield) {
    const double low = heightfield.range.low;
    const double height = std::max(heightfield.range.high - low, 1e-3);
    std::string bytes;
    for (const float metres : heightfield.heights.samples()) {
        const auto step =
            static_cast<unsigned>(std::lround((metres - low) / height * height_steps));
        bytes += static_cast<char>(step >> 8U);
        bytes += static_cast<char>(step & 0xFFU);
    }
    return write_numbers(
        path,
        fmt::format("P5\n{} {}\n65535\n", heightfield.heights.cols(), heightfield.heights.rows()),
        bytes);
}

bool write_colors(const std::filesystem::path& path, const scene::TerrainSurface& surface) {
    const auto colors = colors_of(surface);
    const int side = surface.heightfield().heights.cols();
    return write_numbers(path, fmt::format("P6\n{0} {0}\n255\n", side),
                         std::string(colors.begin(), colors.end()));
}

std::string whole_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// Runs it in a folder to its end; its output goes to log.txt there.
Result<void> run_povray(const std::filesystem::path& folder, std::vector<std::string> words) {
    words.insert(words.begin(), "povray");
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words) {
        argv.push_back(word.data());
    }
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "log.txt",
                                     O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
    pid_t process = -1;
    const int code = posix_spawnp(&process, "povray", &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (code != 0) {
        return Error{fmt::format("povray did not start: {}; install it (apt-get install povray)",
                                 std::strerror(code))};
    }
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        const std::string log = whole_text(folder / "log.txt");
        return Error{fmt::format("povray failed: {}",
                                 log.substr(log.size() - std::min<std::size_t>(log.size(), 200)))};
    }
    return {};
}

Result<void> draw_by_povray(const std::filesystem::path& folder, const BaselineView& view,
                            const std::string& terrain, std::vector<std::string> format) {
    std::ofstream file(folder / "scene.pov");
    file << "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\nbackground { rgb 1 }\n"
         << camera_text(view) << terrain;
    if (!file.flush()) {
        return Error{fmt::format("{}: it cannot be written", (folder / "scene.pov").string())};
    }
    file.close();
    std::vector<std::string> words{"+Iscene.pov",
                                   "+Opicture.ppm",
                                   fmt::format("+W{}", view.size.x),
                                   fmt::format("+H{}", view.size.y),
                                   fmt::format("+WT{}", thread_count(view.threads)),
                                   "-D",
                                   "-A"};
    words.insert(words.end(), format.begin(), format.end());
    return run_povray(folder, std::move(words));
}

// The numbers of a picture in the format of a portable pixmap, 16 bits each.
Result<std::vector<double>> wide_pixmap(const std::filesystem::path& path, glm::ivec2 size) {
    const std::string text = whole_text(path);
    static const std::regex header(R"(^P6\s(?:#[^\n]*\n|\s)*(\d+)\s+(\d+)\s+65535\s)");
    std::smatch match;
    const std::size_t numbers =
        3 * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
    const bool found =
        std::regex_search(text, match, header, std::regex_constants::match_continuous) &&
        match[1] == std::to_string(size.x) && match[2] == std::to_string(size.y);
    const auto begin = found ? static_cast<std::size_t>(match.length()) : 0;
    if (!found || text.size() < begin + 2 * numbers) {
        return Error{
            fmt::format("povray wrote no picture of {} x {} pixels with 16 bits", size.x, size.y)};
    }
    std::vector<double> values;
    for (std::size_t i = begin; i < begin + 2 * numbers; i += 2) {
        const auto high = static_cast<unsigned char>(text[i]);
        const auto low = static_cast<unsigned char>(text[i + 1]);
        values.push_back((256.0 * high + low) / 65535.0);
    }
    return values;
}

double depth_of(double red, double green, double blue, double range) {
    if (blue > 0.5) { // the background
        return std::numeric_limits<double>::infinity();
    }
    const double part = std::round(red * fine_parts - green);
    return (part + green) / fine_parts * range;
}

} // namespace

struct PovrayScene::Files {
    std::filesystem::path folder;

    explicit Files(std::filesystem::path path) : folder(std::move(path)) {}
    Files(const Files&) = delete;
    Files& operator=(const Files&) = delete;
    ~Files() {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
};

const std::filesystem::path& PovrayScene::folder() const {
    return files_->folder;
}

Result<PovrayScene> PovrayScene::create(const BaselineView& view) {
    std::error_code ignored;
    std::string name =
        (std::filesystem::temp_directory_path(ignored) / "reljef-povray-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
        return Error{fmt::format("{}: it cannot be made: {}", name, std::strerror(errno))};
    }
    PovrayScene made(std::make_shared<const Files>(name));
    if (auto starts = run_povray(name, {"--version"}); !starts) {
        return starts.error();
    }
    if (!write_heights(made.folder() / "heights.pgm", view.scene.surface().heightfield()) ||
        !write_colors(made.folder() / "colors.ppm", view.scene.surface())) {
        return Error{fmt::format("{}: no space for heights and colours", name)};
    }
    return made;
}

Result<double> PovrayScene::draw_picture(const BaselineView& view) const {
    const auto drawn =
        draw_by_povray(folder(), view, terrain_text(view, colors_text(view.side()), ""), {"+FP8"});
    if (!drawn) {
        return drawn.error();
    }
    static const std::regex trace_time(R"(Trace Time:[^(\n]*\(([0-9.]+) seconds\))");
    const std::string log = whole_text(folder() / "log.txt");
    std::smatch match;
    if (!std::regex_search(log, match, trace_time)) {
        return Error{"povray stated no trace time"};
    }
    return 1000.0 * std::stod(match[1]);
}

Result<std::vector<double>> PovrayScene::draw_depths(const BaselineView& view) const {
    const auto drawn = draw_by_povray(folder(), view, terrain_text(view, "", depths_text(view)),
                                      {"+FP16", "File_Gamma=1.0"});
    if (!drawn) {
        return drawn.error();
    }
    const auto channels = wide_pixmap(folder() / "picture.ppm", view.size);
    if (!channels) {
        return channels.error();
    }
    std::vector<double> depths;
    for (std::size_t i = 0; i < channels->size(); i += 3) {
        depths.push_back(
            depth_of((*channels)[i], (*channels)[i + 1], (*channels)[i + 2], view.range.far));
    }
    return depths;
}

} // namespace reljef::bench

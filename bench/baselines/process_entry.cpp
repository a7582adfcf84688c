#include "bench/baselines/process_entry.h"

#include <fstream>
#include <limits>
#include <sstream>

#include <fmt/format.h>

#include "bench/baselines/baseline_files.h"

namespace reljef::bench {
namespace {

Result<void> show_view(const BaselineView& view, BaselineProcess& process) {
    const glm::dvec3 eye = view.scene.view().eye;
    const glm::dvec3 target = view.scene.view().target;
    const auto placed =
        process.ask(fmt::format("view {} {} {} {} {} {} {} {}", eye.x, eye.y, eye.z, target.x,
                                target.y, target.z, view.range.near, view.range.far));
    return placed ? Result<void>() : placed.error();
}

Result<double> draw_frame(BaselineProcess& process, BaselineRow& row) {
    const auto answer = process.ask("draw");
    if (!answer) {
        return answer.error();
    }
    std::istringstream words(*answer);
    double ms = 0.0;
    words >> ms >> row.triangles;
    return words ? Result<double>(ms)
                 : Error{fmt::format("{}: 'ok {}' found, a time and triangles were expected",
                                     row.what, *answer)};
}

Result<HitBuffer> read_hits(const BaselineView& view, BaselineProcess& process) {
    const auto stored = read_numbers(view, process, "depth");
    if (!stored) {
        return stored.error();
    }
    const DepthRange& range = view.range;
    std::vector<double> depths;
    for (const double depth : *stored) {
        depths.push_back(depth >= 1.0 ? std::numeric_limits<double>::infinity()
                                      : range.near * range.far /
                                            (range.far - depth * (range.far - range.near)));
    }
    return hits_from_depths(view, depths);
}

} // namespace

Result<std::shared_ptr<BaselineProcess>> start_program(const BaselineProgram& program,
                                                       const BaselineView& view) {
    const auto path = program_beside(program.name, program.library, program.package);
    if (!path) {
        return path.error();
    }
    const auto files = files_of(view.scene.surface());
    if (!files) {
        return files.error();
    }
    const terrain::Heightfield& heightfield = view.scene.surface().heightfield();
    auto process = BaselineProcess::start(
        *path, {fmt::format("{}", view.size.x), fmt::format("{}", view.size.y),
                fmt::format("{}", view.scene.view().vertical_fov), fmt::format("{}", view.side()),
                fmt::format("{}", heightfield.spacing.x), fmt::format("{}", heightfield.spacing.y),
                path_of(files->heights), path_of(files->colors)});
    return process ? std::make_shared<BaselineProcess>(std::move(*process))
                   : Result<std::shared_ptr<BaselineProcess>>(process.error());
}

BaselineEntry process_entry(const BaselineView& view, std::shared_ptr<BaselineProcess> process,
                            BaselineRow row) {
    BaselineEntry entry;
    entry.set_camera = [&view, process] { return show_view(view, *process); };
    entry.draw = [process](BaselineRow& drawn) { return draw_frame(*process, drawn); };
    entry.hits = [&view, process] { return read_hits(view, *process); };
    entry.row = std::move(row);
    return entry;
}

Result<std::vector<float>> read_numbers(const BaselineView& view, BaselineProcess& process,
                                        const std::string& line) {
    const auto width = static_cast<std::size_t>(view.size.x);
    std::vector<float> numbers(width * static_cast<std::size_t>(view.size.y));
    auto file = MemoryFile::create();
    if (!file) {
        return file.error();
    }
    if (const auto written = process.ask(line + " " + path_of(*file)); !written) {
        return written.error();
    }
    std::ifstream in(path_of(*file), std::ios::binary);
    for (auto row = numbers.size(); row > 0; row -= width) {
        in.read(reinterpret_cast<char*>(&numbers[row - width]),
                static_cast<std::streamsize>(width * sizeof(float)));
    }
    return in ? Result<std::vector<float>>(std::move(numbers))
              : Error{"fewer numbers found than pixels, one each was expected"};
}

} // namespace reljef::bench

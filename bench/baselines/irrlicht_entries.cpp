#include <fmt/format.h>

#include "bench/baselines/process_entry.h"
#include "bench/baselines/program/protocol.h"

namespace reljef::bench {
namespace {

constexpr BaselineProgram irrlicht_windows{baseline::irrlicht_program, "Irrlicht",
                                           "libirrlicht-dev"};

Result<HitBuffer> relief_hits(const BaselineView& view, BaselineProcess& process) {
    const auto columns = read_numbers(view, process, "samples 0");
    const auto rows = columns ? read_numbers(view, process, "samples 1") : columns;
    if (!rows) {
        return rows.error();
    }
    HitBuffer hits(view.size.x, view.size.y);
    std::size_t pixel = 0;
    for (Hit& hit : hits.samples()) {
        const float column = (*columns)[pixel];
        const float row = (*rows)[pixel++];
        if (column >= 0.0F && row >= 0.0F) {
            hit = {column, row, 0.0F, 0.0F}; // errors use neither height nor depth
        }
    }
    return hits;
}

} // namespace

BaselineEntries irrlicht_terrain_entries(const BaselineView& view) {
    std::vector<BaselineEntry> entries;
    const auto add = [&](int levels, bool moving, std::shared_ptr<BaselineProcess> process) {
        BaselineRow row;
        row.what = fmt::format("irrlicht:lods={}", levels);
        row.moving = moving;
        entries.push_back(process_entry(view, std::move(process), std::move(row)));
    };
    for (const int levels : {1, 3, 5}) {
        const auto process = start_program(irrlicht_windows, view);
        if (!process) {
            return process.error();
        }
        if (auto built = (*process)->ask(fmt::format("lods {}", levels)); !built) {
            return built.error();
        }
        add(levels, false, *process);
        if (levels == 5) {
            add(levels, true, *process);
        }
    }
    return entries;
}

BaselineEntries irrlicht_relief_entries(const BaselineView& view) {
    const auto process = start_program(irrlicht_windows, view);
    if (!process) {
        return process.error();
    }
    if (auto built = (*process)->ask("relief"); !built) {
        return built.error();
    }
    BaselineRow row;
    row.work = BaselineWork::relief;
    row.what = "Irrlicht, parallax material";
    std::vector<BaselineEntry> entries;
    entries.push_back(process_entry(view, *process, std::move(row)));
    entries.back().hits = [&view, process = *process] { return relief_hits(view, *process); };
    return entries;
}

} // namespace reljef::bench

#include "bench/baselines/process_entry.h"
#include "bench/baselines/program/protocol.h"

namespace reljef::bench {

BaselineEntries openscenegraph_entries(const BaselineView& view) {
    const auto process = start_program(
        {baseline::openscenegraph_program, "OpenSceneGraph", "libopenscenegraph-dev"}, view);
    if (!process) {
        return process.error();
    }
    BaselineRow row;
    row.work = BaselineWork::triangles;
    row.what = "OpenSceneGraph, GeometryTechnique";
    std::vector<BaselineEntry> entries;
    entries.push_back(process_entry(view, *process, std::move(row)));
    return entries;
}

} // namespace reljef::bench

#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/memory_file.h"
#include "engine/core/result.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::bench {

/// Fails without memory.
Result<MemoryFile> file_of(std::span<const std::byte> bytes);
/// Valid in other processes too, as long as this one runs.
std::string path_of(const MemoryFile& file);

/// What the programs of bench/baselines/program read, see protocol.h.
struct BaselineFiles {
    MemoryFile heights;
    MemoryFile colors;
};
/// Fails without memory.
Result<BaselineFiles> files_of(const scene::TerrainSurface& surface);

/// Colours without light: r g b by rows, one per sample.
std::vector<std::uint8_t> colors_of(const scene::TerrainSurface& surface);

/// The program beside this one. If it was not built, the error names the library and the package
/// that it needs.
Result<std::filesystem::path> program_beside(std::string_view name, std::string_view library,
                                             std::string_view package);

} // namespace reljef::bench

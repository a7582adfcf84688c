#include "bench/baselines/baseline_files.h"

#include <fstream>

#include <fmt/format.h>
#include <unistd.h>

#include "engine/view/terrain_maps.h"

namespace reljef::bench {

Result<MemoryFile> file_of(std::span<const std::byte> bytes) {
    auto file = MemoryFile::create();
    if (!file) {
        return file.error();
    }
    std::ofstream out(path_of(*file), std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    return out.flush() ? std::move(file)
                       : Error{"no memory for what the other programs are to read"};
}

std::string path_of(const MemoryFile& file) {
    return fmt::format("/proc/{}/fd/{}", ::getpid(), file.descriptor());
}

std::vector<std::uint8_t> colors_of(const scene::TerrainSurface& surface) {
    const int side = surface.heightfield().heights.cols();
    const Image lit = view::lit_map(surface, std::nullopt, side);
    std::vector<std::uint8_t> colors;
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            const Rgba8& color = lit.clamped(col, row);
            colors.insert(colors.end(), {color.r, color.g, color.b});
        }
    }
    return colors;
}

Result<BaselineFiles> files_of(const scene::TerrainSurface& surface) {
    const Grid<float>& heights = surface.heightfield().heights;
    const int side = heights.cols();
    std::vector<float> columns;
    for (int col = 0; col < side; ++col) {
        for (int row = side - 1; row >= 0; --row) {
            columns.push_back(heights(col, row));
        }
    }
    const std::vector<std::uint8_t> colors = colors_of(surface);
    auto heights_file = file_of(std::as_bytes(std::span(columns)));
    auto colors_file = file_of(std::as_bytes(std::span(colors)));
    if (!heights_file || !colors_file) {
        return (heights_file ? colors_file : heights_file).error();
    }
    return BaselineFiles{std::move(*heights_file), std::move(*colors_file)};
}

Result<std::filesystem::path> program_beside(std::string_view name, std::string_view library,
                                             std::string_view package) {
    std::error_code ignored;
    auto program = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / name;
    if (!std::filesystem::exists(program, ignored)) {
        return Error{fmt::format("{} was not built, as {} was not found: install it (apt-get "
                                 "install {}), configure and build again",
                                 name, library, package)};
    }
    return program;
}

} // namespace reljef::bench

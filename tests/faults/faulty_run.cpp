#include "tests/faults/faulty_run.h"

#include <cmath>
#include <cstdint>
#include <fstream>
#include <sstream>

namespace reljef::test {
namespace {

namespace fs = std::filesystem;

constexpr int dem_side = 300;

// Whole numbers in an EHdr file: GDAL reads its samples as it draws.
void write_dem(const TemporaryFolder& folder) {
    std::string samples;
    for (int row = 0; row < dem_side; ++row) {
        for (int col = 0; col < dem_side; ++col) {
            const auto height = static_cast<std::uint16_t>(
                std::lround(500.0 + 200.0 * std::sin(0.05 * row) * std::cos(0.07 * col)));
            samples += static_cast<char>(height & 0xFFU);
            samples += static_cast<char>(height >> 8U);
        }
    }
    folder.write("dem.bil", samples);
    std::ostringstream header;
    header << "NROWS " << dem_side << "\nNCOLS " << dem_side
           << "\nNBANDS 1\nNBITS 16\nPIXELTYPE SIGNEDINT\nBYTEORDER I\nLAYOUT BIL\n"
              "ULXMAP 6.0\nULYMAP 45.0\nXDIM 0.0003\nYDIM 0.0003\n";
    folder.write("dem.hdr", header.str());
}

std::vector<std::string> lines_of(const fs::path& path) {
    std::ifstream file(path);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) {
        lines.push_back(line);
    }
    return lines;
}

FileContents files_below(const fs::path& folder) {
    FileContents files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string name = fs::relative(entry.path(), folder).string();
        if (entry.is_regular_file() && !name.starts_with("cache/") && !name.starts_with("dem.")) {
            files[name] = read_bytes(entry.path());
        }
    }
    return files;
}

} // namespace

FaultyRun::FaultyRun(const std::vector<std::string>& arguments,
                     const std::map<std::string, std::string>& variables,
                     const FileContents& before)
    : arguments_(arguments) {
    write_dem(folder_);
    fs::create_directory(folder_.path() / "cache");
    for (const auto& [name, content] : before) {
        folder_.write(name, content);
    }
    run(variables);
}

void FaultyRun::repeat() {
    run({});
}

void FaultyRun::run(const std::map<std::string, std::string>& variables) {
    const fs::path told = folder_.path() / "cache" / "told";
    ProgramOptions options;
    options.folder = folder_.path();
    options.environment = {{"LD_PRELOAD", RELJEF_FAULT_LIBRARY},
                           {"XDG_CACHE_HOME", (folder_.path() / "cache").string()}};
    for (const auto& [name, value] : variables) {
        options.environment[name] = value == "told" ? told.string() : value;
    }
    result_ = run_program(RELJEF_BINARY, arguments_, options);
    files_ = files_below(folder_.path());
    told_ = lines_of(told);
    fs::remove(told);
}

} // namespace reljef::test

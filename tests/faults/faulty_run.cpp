#include "tests/faults/faulty_run.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <unistd.h>

#include "tests/support/forks/fork_server.h"

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

/// What serves forks of `reljef` with the library: it is linked once, which takes longer than a
/// run. It ends with this process.
int fault_server() {
    static const int server = [] {
        std::array<int, 2> ends{-1, -1};
        if (!make_fork_sockets(ends)) {
            return -1;
        }
        if (::fork() == 0) {
            ::fcntl(ends[1], F_SETFD, 0); // stays open
            ::setenv("LD_PRELOAD", RELJEF_FAULT_LIBRARY, 1);
            ::setenv("RELJEF_FAULT_SERVER", std::to_string(ends[1]).c_str(), 1);
            ::execl(RELJEF_BINARY, RELJEF_BINARY, nullptr);
            ::_exit(127);
        }
        ::close(ends[1]);
        return ends[0];
    }();
    return server;
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
    const fs::path done = folder_.path() / "cache" / "done";
    ProgramOptions options;
    options.folder = folder_.path();
    options.environment = {{"LD_PRELOAD", RELJEF_FAULT_LIBRARY},
                           {"RELJEF_FAULT_DONE", done.string()},
                           {"XDG_CACHE_HOME", (folder_.path() / "cache").string()}};
    bool tells = false;
    for (const auto& [name, value] : variables) {
        options.environment[name] = value == "told" ? told.string() : value;
        tells = tells || value == "told";
    }
    if (tells) { // also what it does after its main function
        result_ = run_program(RELJEF_BINARY, arguments_, options);
    } else {
        std::vector<std::string> all{RELJEF_BINARY};
        all.insert(all.end(), arguments_.begin(), arguments_.end());
        result_ = run_fork(fault_server(), nullptr, std::move(all), options);
    }
    files_ = files_below(folder_.path());
    told_ = lines_of(told);
    has_failed_ = !lines_of(done).empty();
    fs::remove(told);
    fs::remove(done);
}

} // namespace reljef::test

#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "engine/session/streaming.h"
#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"

namespace reljef::test {

/// Folders of SRTM-like cells 1201 samples a side, big-endian, made of a formula.
class Streaming : public ::testing::Test {
protected:
    void SetUp() override {
        for (const auto& [name, west, south] :
             {std::tuple("N44E006.hgt", 6, 44), {"N44E007.hgt", 7, 44}, {"N45E006.hgt", 6, 45}}) {
            write_cell(name, west, south);
        }
        options_.environment["XDG_CACHE_HOME"] = (folder_.path() / "cache").string();
        options_.environment["LIBGL_ALWAYS_SOFTWARE"] = "1";
    }
    /// `raise`: metres.
    void write_cell(const std::string& name, int west, int south, int raise = 0) const {
        static std::map<std::tuple<int, int, int>, std::string> made; // once for all tests
        std::string& bytes = made[{west, south, raise}];
        if (bytes.empty()) {
            bytes = cell_bytes(west, south, raise);
        }
        folder_.write("tiles/" + name, bytes);
    }
    static std::string cell_bytes(int west, int south, int raise) {
        constexpr int side = 1201;
        std::string bytes;
        for (int row = 0; row < side; ++row) {
            for (int col = 0; col < side; ++col) {
                const double x = west + col / 1200.0;
                const double y = south + 1.0 - row / 1200.0;
                const auto height = static_cast<std::int16_t>(
                    1500.0 + raise + 900.0 * std::sin(40.0 * x) * std::cos(37.0 * y) +
                    60.0 * std::sin(700.0 * x + 500.0 * y));
                bytes.push_back(static_cast<char>(height >> 8));
                bytes.push_back(static_cast<char>(height & 0xff));
            }
        }
        return bytes;
    }
    /// For the application's own calls, whose caches XDG_CACHE_HOME keeps here.
    [[nodiscard]] session::SourceOptions streamed_choice() const {
        session::SourceOptions choice;
        choice.terrain = path("tiles");
        choice.memory_megabytes = 32;
        choice.streamed = true;
        return choice;
    }
    [[nodiscard]] ProgramResult render(const std::string& picture, std::vector<std::string> more,
                                       const std::string& camera = "44.6,6.6,2600,60,-12") const {
        std::vector<std::string> arguments{"render",   path("tiles"), "-o",        path(picture),
                                           "--size",   "160x120",     "--context", "osmesa",
                                           "--memory", "32",          "--camera",  camera};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::reljef(arguments, options_);
    }
    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_.path() / name).string();
    }

    TemporaryFolder folder_;
    ProgramOptions options_;
};

} // namespace reljef::test

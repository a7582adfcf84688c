#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"

namespace reljef::test {

/// Draws the hits of a level terrain with meshes on it.
class MeshesOnTerrain : public testing::Test {
protected:
    explicit MeshesOnTerrain(std::string eye) : eye_(std::move(eye)) {}

    HitBuffer hits(const std::vector<std::string>& more) {
        const auto file = (folder_.path() / "a.exr").string();
        std::vector<std::string> arguments{"render",  dem_,    "--size", "160x120",
                                           "--quiet", "--eye", eye_,     "--look",
                                           "0,0,1",   "--hit", file};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto result = reljef(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        auto read = io::read_hits(file);
        EXPECT_TRUE(read);
        return read ? std::move(*read) : HitBuffer();
    }

    TemporaryFolder folder_;
    std::string dem_ =
        folder_
            .write("dem.asc", "ncols 5\nnrows 5\nxllcorner 0\nyllcorner 0\ncellsize 10\n"
                              "0 0 0 0 0\n0 0 0 0 0\n0 0 0 0 0\n0 0 0 0 0\n0 0 0 0 0\n")
            .string();

private:
    std::string eye_;
};

struct MeshPixels {
    int on_meshes = 0; ///< by the exact hits
    int others = 0;    ///< whose hits differ
};

inline MeshPixels compared_meshes(const HitBuffer& shown, const HitBuffer& exact) {
    MeshPixels found;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const Hit a = shown.samples()[i];
        const Hit b = exact.samples()[i];
        const bool is_mesh = !b.is_sky() && b.col == -1.0F;
        found.on_meshes += is_mesh ? 1 : 0;
        const bool agree =
            is_mesh ? a.col == -1.0F && a.row == -1.0F && std::abs(a.depth - b.depth) < 1e-4F
                    : a.is_sky() == b.is_sky() && std::abs(a.col - b.col) < 1e-3F;
        found.others += agree ? 0 : 1;
    }
    return found;
}

} // namespace reljef::test

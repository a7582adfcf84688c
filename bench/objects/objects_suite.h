#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "bench/report/results.h"
#include "bench/runner/suite_options.h"

namespace reljef::bench {

struct ObjectsOptions {
    SuiteOptions suite;
    /// Names of `urban`, or scene files with footprints on a surface model; empty: urban.
    std::vector<std::string> terrains;
    std::vector<int> sizes;        ///< of urban, samples a side; empty: 256, 512, 1024; quick: 512
    std::vector<double> distances; ///< of the eye, metres; empty: 100, 300, 1000, 3000; quick: 300
    std::vector<double> downs;     ///< angles of view, degrees; empty: 15 and 45; quick: 30
};

/// Draws the same city as heights (texture, parallax, relief, exact rays, polygons), as meshes on
/// the bare ground, and as meshes alone, over the distance, the angle and the number of buildings:
/// time, memory, and the error against the exact picture of the meshes. The last row of each test
/// draws the first again, for the noise floor. Cities without buildings and views from inside them
/// are left out with a note. With session::BackendKind::cpu, rays on the CPU draw beside OpenGL
/// what is exact or keeps an error bound; their labels say so. Their memory is what they
/// prepare for the first frame.
Results run_objects(const ObjectsOptions& options, const std::stop_token& stop);

} // namespace reljef::bench

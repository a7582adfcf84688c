#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

namespace reljef::test {

/// A cube of 2 m as most programs write OBJ: y up, quads, no normals. It stands on y = 0.
inline const std::string cube_obj = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\n"
                                    "v -1 2 1\nv 1 2 1\nv 1 2 -1\nv -1 2 -1\n"
                                    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\n"
                                    "f 3 4 8 7\nf 4 1 5 8\n";

/// A square of 1 m that faces +z of the file, with a texture whose (0,0) is below on the left.
inline const std::string square_obj = "mtllib square.mtl\nusemtl wall\n"
                                      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                      "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                      "f 1/1 2/2 3/3 4/4\n";
inline const std::string square_mtl = "newmtl wall\nKd 0.5 0.25 1\nmap_Kd wall.png\n";

/// glTF 2.0: the triangle (0,0,0), (1,0,0), (0,2,0) of a red material.
inline std::string triangle_gltf(const std::string& buffer_uri) {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}}],
"buffers":[{"byteLength":42,"uri":")" +
           buffer_uri + R"("}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,2,0]},
{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}]})";
}

/// The buffer of triangle_gltf(), which lies in the file.
inline const std::string triangle_data = "data:application/octet-stream;base64,"
                                         "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAAAAABAAIA";

/// A ball of 10 m with 4 · rings² triangles.
inline std::string ball_obj(int rings) {
    const int around = 2 * rings;
    std::string text;
    for (int row = 0; row <= rings; ++row) {
        const double down = std::numbers::pi * row / rings;
        for (int col = 0; col < around; ++col) {
            const double turn = std::numbers::pi * col / rings;
            text += fmt::format("v {} {} {}\n", 5.0 * std::sin(down) * std::cos(turn),
                                5.0 * std::cos(down), 5.0 * std::sin(down) * std::sin(turn));
        }
    }
    for (int row = 0; row < rings; ++row) {
        for (int col = 0; col < around; ++col) {
            const int a = row * around + col + 1;
            const int b = row * around + (col + 1) % around + 1;
            text += fmt::format("f {0} {1} {2} {3}\n", a, b, b + around, a + around);
        }
    }
    return text;
}

} // namespace reljef::test

#include "engine/io/mesh/mesh_file.h"

#include <cmath>
#include <filesystem>
#include <numbers>
#include <stop_token>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "engine/io/mesh/mesh_message.h"
#include "tests/io/mesh/made_mesh.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// A GLB of this JSON alone.
std::string glb_of(std::string json) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string bytes = "glTF";
    for (const std::size_t number : {std::size_t{2}, 20 + json.size(), json.size()}) {
        for (unsigned shift = 0; shift < 32; shift += 8) {
            bytes += static_cast<char>((number >> shift) & 0xFFU);
        }
    }
    return bytes + "JSON" + json;
}

class MeshFileTest : public testing::Test {
protected:
    // The sentence that names the file.
    std::string refusal(const std::filesystem::path& file, const ImportLimits& limits = {}) {
        const auto refused = read_mesh_file(file, limits);
        EXPECT_FALSE(refused);
        const std::string message = refused ? "" : refused.error().message;
        EXPECT_THAT(message, AllOf(StartsWith(file.string() + ": "), HasSubstr("expected")));
        return message;
    }

    // An import program that does what the lines say.
    ImportLimits importer(const std::string& lines) {
        const auto program = folder_.write("importer", "#!/bin/sh\n" + lines + "\n");
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        ImportLimits limits;
        limits.program = program;
        return limits;
    }

    test::TemporaryFolder folder_;
    std::filesystem::path cube_ = folder_.write("cube.obj", test::cube_obj);
};

TEST_F(MeshFileTest, ReadsACubeWithHardEdgesAndZUp) {
    const auto file = read_mesh_file(cube_);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_THAT(file->notes, testing::IsEmpty());
    ASSERT_EQ(file->parts.size(), 1U);
    EXPECT_EQ(file->bounds.low, glm::dvec3(-1.0, -1.0, 0.0));
    EXPECT_EQ(file->bounds.high, glm::dvec3(1.0, 1.0, 2.0));
    const scene::Mesh& mesh = *file->parts[0].mesh;
    ASSERT_EQ(mesh.indices.size(), 36U);
    EXPECT_EQ(mesh.texture_coordinates.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const scene::TriangleEdges edges = scene::triangle_edges(mesh, i);
        const glm::dvec3 outward = glm::normalize(glm::cross(edges.p, edges.q));
        EXPECT_GT(glm::dot(outward, edges.corner - glm::dvec3(0.0, 0.0, 1.0)), 0.9) << i;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const glm::dvec3 normal(mesh.normals[mesh.indices[i + corner]]);
            EXPECT_LT(glm::distance(normal, outward), 1e-6) << i;
        }
    }
}

TEST_F(MeshFileTest, ReadsGltfWithItsBufferInsideAndBeside) {
    const std::string bytes("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x40"
                            "\0\0\0\0\0\0\1\0\2\0",
                            42);
    folder_.write("triangle.bin", bytes);
    for (const std::string& uri : {test::triangle_data, std::string("triangle.bin")}) {
        const auto file = read_mesh_file(folder_.write("triangle.gltf", test::triangle_gltf(uri)));
        ASSERT_TRUE(file) << file.error().message;
        ASSERT_EQ(file->parts.size(), 1U);
        EXPECT_EQ(file->parts[0].color, glm::vec3(1.0F, 0.0F, 0.0F));
        EXPECT_EQ(file->bounds.high, glm::dvec3(1.0, 0.0, 2.0)) << "y of the file is up";
        EXPECT_EQ(file->parts[0].mesh->normals[0], glm::vec3(0.0F, -1.0F, 0.0F))
            << "z of the file is south";
    }
}

TEST_F(MeshFileTest, TexturesStandUprightAndAreNotMirrored) {
    Image picture(2, 2);
    picture(0, 1) = {255, 0, 0, 255}; // below on the left
    ASSERT_TRUE(write_image(folder_.path() / "wall.png", picture));
    folder_.write("square.mtl", test::square_mtl);
    const auto file = read_mesh_file(folder_.write("square.obj", test::square_obj));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_THAT(file->notes, testing::IsEmpty());
    ASSERT_NE(file->parts[0].picture, nullptr);
    EXPECT_EQ((*file->parts[0].picture)(0, 1).r, 255);
    const scene::Mesh& mesh = *file->parts[0].mesh;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_EQ(mesh.texture_coordinates[i],
                  glm::vec2(mesh.positions[i].x, 1.0F - mesh.positions[i].z));
    }
}

TEST_F(MeshFileTest, AMissingTextureIsOneNoteAndAPlainColour) {
    folder_.write("square.mtl", test::square_mtl);
    const auto file = read_mesh_file(folder_.write("square.obj", test::square_obj));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->parts[0].picture, nullptr);
    EXPECT_EQ(file->parts[0].color, glm::vec3(0.5F, 0.25F, 1.0F));
    ASSERT_EQ(file->notes.size(), 1U);
    EXPECT_THAT(file->notes[0], HasSubstr("'wall.png' cannot be used"));
}

TEST_F(MeshFileTest, PicturesHaveALimitTogether) {
    const Image large(8192, 4097); // half of max_mesh_texels, and a row
    static_assert(8192U * 4096U * 2U == max_mesh_texels);
    ASSERT_TRUE(write_image(folder_.path() / "a.png", large));
    std::filesystem::copy_file(folder_.path() / "a.png", folder_.path() / "b.png");
    folder_.write("two.mtl", "newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd b.png\n");
    const auto file = read_mesh_file(folder_.write(
        "two.obj", "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                   "usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 3/2 4/3\nusemtl a\nf 1/1 2/2 4/3\n"));
    ASSERT_TRUE(file) << file.error().message;
    std::size_t pictures = 0;
    for (const ColoredMesh& part : file->parts) {
        pictures += static_cast<std::size_t>(part.picture != nullptr);
    }
    EXPECT_EQ(pictures, 1U);
    EXPECT_EQ(file->notes.size(), 1U);
}

TEST_F(MeshFileTest, OpensNothingOutsideItsFolder) {
    Image picture(2, 2);
    ASSERT_TRUE(write_image(folder_.path() / "wall.png", picture));
    folder_.write("below/square.mtl", "newmtl wall\nmap_Kd ../wall.png\n");
    auto file = read_mesh_file(folder_.write("below/square.obj", test::square_obj));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->parts[0].picture, nullptr);
    EXPECT_EQ(file->notes.size(), 1U);
    folder_.write("triangle.bin", std::string(42, '\0'));
    EXPECT_THAT(
        refusal(folder_.write("below/triangle.gltf", test::triangle_gltf("../triangle.bin"))),
        HasSubstr("cannot be read"));
}

TEST_F(MeshFileTest, RefusesWhatIsNoMesh) {
    EXPECT_THAT(refusal(folder_.path() / "none.obj"), HasSubstr("nothing found"));
    EXPECT_THAT(refusal(folder_.path()), HasSubstr("a folder found"));
    EXPECT_THAT(refusal("/dev/null"), HasSubstr("a device found"));
    EXPECT_THAT(refusal(folder_.write("empty.obj", "")), HasSubstr("0 bytes found"));
    EXPECT_THAT(refusal(folder_.write("mesh.ply", "ply")), HasSubstr("extension '.ply' found"));
    refusal(folder_.write("text.gltf", "no glTF"));
    refusal(folder_.write("short.glb", "glTF\2\0\0\0"));
    refusal(folder_.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"));
    refusal(folder_.write("line.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"));
    refusal(folder_.write("far.obj", "v 0 0 0\nv 1e9 0 0\nv 0 1 0\nf 1 2 3\n"));
    refusal(folder_.write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"));
}

TEST_F(MeshFileTest, RefusesTooManyTrianglesBeforeItImportsThem) {
    const ImportLimits never = importer("exit 7");
    std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (std::size_t i = 0; i < max_mesh_triangles / 2; ++i) {
        faces += "f 1 2 3 1\n";
    }
    EXPECT_THAT(refusal(folder_.write("limit.obj", faces), never), HasSubstr("fail (status 7)"));
    EXPECT_THAT(refusal(folder_.write("large.obj", faces + "f 1 2 3\n"), never),
                HasSubstr("2000001 triangles found, at most 2000000 were expected"));
    std::string face = "v 0 0 0\nf";
    for (int i = 0; i < 50'000; ++i) {
        face += " 1";
    }
    EXPECT_THAT(refusal(folder_.write("face.obj", face), never),
                HasSubstr("faces of up to 50000 corners found"));
    const std::string large =
        replaced(test::triangle_gltf(test::triangle_data), R"("count":3,"type":"SCALAR")",
                 R"("count":30000000,"type":"SCALAR")");
    const std::string sentence = "10000000 triangles found, at most 2000000 were expected";
    EXPECT_THAT(refusal(folder_.write("large.gltf", large)), HasSubstr(sentence));
    EXPECT_THAT(refusal(folder_.write("large.glb", glb_of(large))), HasSubstr(sentence));
}

TEST_F(MeshFileTest, CountsTheTrianglesOfEachPlace) {
    std::string nodes = R"("nodes":[{"mesh":0,"children":[1,1]})"; // 2 to the power of 22
    for (int i = 1; i <= 22; ++i) {
        nodes += i < 22 ? fmt::format(R"(,{{"children":[{0},{0}]}})", i + 1) : R"(,{"mesh":0})";
    }
    const std::string many =
        replaced(test::triangle_gltf(test::triangle_data), R"("nodes":[{"mesh":0}])", nodes + "]");
    EXPECT_THAT(refusal(folder_.write("many.gltf", many)), HasSubstr("4194305 triangles found"));
}

TEST_F(MeshFileTest, RefusesDeepNesting) {
    const std::string deep(100'000, '[');
    EXPECT_THAT(refusal(folder_.write("deep.gltf", R"({"extras":)" + deep)),
                HasSubstr("nested more than 500 deep"));
    std::string nodes = R"("nodes":[{"mesh":0,"children":[1]})";
    for (int i = 1; i <= 20'000; ++i) {
        nodes += fmt::format(R"(,{{"children":[{}]}})", i + 1);
    }
    const std::string chain = replaced(test::triangle_gltf(test::triangle_data),
                                       R"("nodes":[{"mesh":0}])", nodes + R"(,{"mesh":0}])");
    EXPECT_THAT(refusal(folder_.write("chain.gltf", chain)), HasSubstr("nested more than 500"));
    const std::string circle =
        replaced(test::triangle_gltf(test::triangle_data), R"("nodes":[{"mesh":0}])",
                 R"("nodes":[{"mesh":0,"children":[0]}])");
    EXPECT_THAT(refusal(folder_.write("circle.gltf", circle)), HasSubstr("nested more than 500"));
}

TEST_F(MeshFileTest, NamesRequiredExtensionsThatItCannotRead) {
    const auto requiring = [](const std::string& extension) {
        return replaced(test::triangle_gltf(test::triangle_data), R"("scene":0)",
                        fmt::format(R"("extensionsRequired":["{}"],"scene":0)", extension));
    };
    EXPECT_THAT(refusal(folder_.write("draco.gltf", requiring("KHR_draco_mesh_compression"))),
                HasSubstr("requires the extension KHR_draco_mesh_compression"));
    EXPECT_TRUE(read_mesh_file(folder_.write("unlit.gltf", requiring("KHR_materials_unlit"))));
}

TEST_F(MeshFileTest, NotesMissingMaterials) {
    const auto file = read_mesh_file(folder_.write("square.obj", test::square_obj));
    folder_.write("other.mtl", test::square_mtl);
    const auto other = read_mesh_file(folder_.write("other.obj", test::square_obj));
    ASSERT_TRUE(file && other);
    EXPECT_THAT(file->notes, testing::ElementsAre(HasSubstr("'square.mtl' cannot be used")));
    EXPECT_THAT(other->notes, testing::ElementsAre(HasSubstr("the texture 'wall.png'")));
}

// Assimp needs over 20 s for as many objects and materials.
TEST_F(MeshFileTest, ObjectsOfOneMaterialAreOnePart) {
    constexpr int objects = 50'000;
    constexpr int in_row = 500;
    folder_.write("objects.mtl", "newmtl m0\nKd 1 0 0\nnewmtl m1\nKd 0 1 0\n");
    std::string text = "mtllib objects.mtl\n";
    for (int i = 0; i < objects; ++i) {
        const int x = i % in_row;
        const int z = i / in_row;
        text += fmt::format("o part{0}\ng part{0}\nusemtl m{1}\nv {2} 0 {3}\nv {2}.5 0 {3}\n"
                            "v {2} 1 {3}\nf -3 -2 -1\n",
                            i, i * 2 / objects, x, z);
    }
    ImportLimits limits;
    limits.seconds = 15; // of the processor
    const auto file = read_mesh_file(folder_.write("objects.obj", text), limits);
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_EQ(file->parts.size(), 2U);
    EXPECT_EQ(file->parts[0].mesh->indices.size(), 3U * objects / 2);
}

TEST_F(MeshFileTest, LimitsChangesOfTheMaterial) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (std::size_t i = 0; i <= max_material_changes; ++i) {
        text += fmt::format("usemtl {}\nf 1 2 3\n", i % 2);
    }
    EXPECT_THAT(refusal(folder_.write("changes.obj", text), importer("exit 7")),
                HasSubstr("20001 changes of the material found"));
}

// Steps of Assimp compare all corners at a place with each other: over a minute for each file.
TEST_F(MeshFileTest, ManyCornersAtOnePlaceCostLittle) {
    constexpr int triangles = 200'000;
    std::string same = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    std::string around = "v 0 0 0\n";
    for (int i = 0; i < triangles; ++i) {
        same += "usemtl one\nf 1 2 3\n";
        const double turn = 2.0 * std::numbers::pi * i / triangles;
        around += fmt::format("v {:.6f} {:.6f} {:.6f}\n", std::cos(turn),
                              0.5 * std::sin(9.0 * turn), std::sin(turn));
    }
    for (int i = 0; i < triangles; ++i) {
        around += fmt::format("f 1 {} {}\n", i + 2, (i + 1) % triangles + 2);
    }
    ImportLimits limits;
    limits.seconds = 15; // of the processor
    for (const std::string& text : {same, around}) {
        const auto file = read_mesh_file(folder_.write("corners.obj", text), limits);
        ASSERT_TRUE(file) << file.error().message;
        ASSERT_EQ(file->parts.size(), 1U);
        EXPECT_EQ(file->parts[0].mesh->indices.size(), 3U * triangles);
    }
}

TEST_F(MeshFileTest, LimitsMaterialsOfLibraries) {
    std::string library;
    for (int i = 0; i <= 20'000; ++i) {
        library += fmt::format("  NewMtl unused{}\n", i);
    }
    folder_.write("square.mtl", library + test::square_mtl);
    EXPECT_THAT(refusal(folder_.write("square.obj", test::square_obj)),
                HasSubstr("20002 materials found, at most 20000 were expected"));
    EXPECT_THAT(
        refusal(folder_.write("itself.obj", "mtllib itself.obj\n" + test::square_obj + library)),
        HasSubstr("materials found, at most 20000 were expected"));
}

// Each line would cost a reading of the library.
TEST_F(MeshFileTest, ReadsALibraryOnce) {
    folder_.write("square.mtl", test::square_mtl + std::string(1'000'000, '#') + "\n");
    std::string text;
    for (int i = 0; i < 100'000; ++i) {
        text += i % 2 == 0 ? "mtllib square.mtl\n" : "mtllib ./square.mtl\n";
    }
    ImportLimits limits;
    limits.seconds = 15; // of the processor
    const auto file = read_mesh_file(folder_.write("square.obj", text + test::square_obj), limits);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->parts[0].color, glm::vec3(0.5F, 0.25F, 1.0F));
}

TEST_F(MeshFileTest, OutlivesImportersThatCrashHangOrRave) {
    EXPECT_THAT(refusal(cube_, importer("kill -SEGV $$")), HasSubstr("crash (signal 11)"));
    EXPECT_THAT(refusal(cube_, importer("exit 7")), HasSubstr("fail (status 7)"));
    EXPECT_THAT(refusal(cube_, importer("echo no mesh")), HasSubstr("no mesh"));
    ImportLimits hanging = importer("exec sleep 600");
    hanging.seconds = 1;
    EXPECT_THAT(refusal(cube_, hanging), HasSubstr("takes over 3 s"));
    ImportLimits raving = importer("exec yes");
    raving.max_answer = std::size_t{1} << 20U;
    EXPECT_THAT(refusal(cube_, raving), HasSubstr("over 1 MB"));
    std::stop_source stop;
    stop.request_stop();
    const auto stopped = read_mesh_file(cube_, importer("exec sleep 600"), stop.get_token());
    ASSERT_FALSE(stopped);
    EXPECT_THAT(stopped.error().message, HasSubstr("was stopped"));
    ImportLimits absent;
    absent.program = folder_.path() / "none";
    const auto lost = read_mesh_file(cube_, absent);
    ASSERT_FALSE(lost);
    EXPECT_THAT(lost.error().message, HasSubstr("does not start"));
}

} // namespace
} // namespace reljef::io

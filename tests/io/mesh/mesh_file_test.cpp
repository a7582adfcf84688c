#include "engine/io/mesh/mesh_file.h"

#include <filesystem>
#include <stop_token>
#include <string>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/io/mesh/made_mesh.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

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
    EXPECT_THAT(refusal(folder_.path()), HasSubstr("no file found"));
    EXPECT_THAT(refusal(folder_.write("empty.obj", "")), HasSubstr("0 bytes found"));
    EXPECT_THAT(refusal(folder_.write("mesh.ply", "ply")), HasSubstr("extension '.ply' found"));
    refusal(folder_.write("text.gltf", "no glTF"));
    refusal(folder_.write("short.glb", "glTF\2\0\0\0"));
    refusal(folder_.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"));
    refusal(folder_.write("line.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"));
    refusal(folder_.write("far.obj", "v 0 0 0\nv 1e9 0 0\nv 0 1 0\nf 1 2 3\n"));
    refusal(folder_.write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"));
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

// What the keys of a glTF file may say.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/io/mesh/mesh_file.h"
#include "engine/io/mesh/mesh_message.h"
#include "tests/io/mesh/made_mesh.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class GltfKeys : public testing::Test {
protected:
    Result<MeshFile> read(const json& gltf, const ImportLimits& limits = {}) {
        return read_mesh_file(folder_.write("a.gltf", gltf.dump()), limits);
    }
    std::string refusal(const json& gltf) {
        const auto refused = read(gltf);
        EXPECT_FALSE(refused) << gltf;
        return refused ? "" : refused.error().message;
    }
    // The triangle with other values.
    [[nodiscard]] json changed(const std::vector<std::pair<std::string, json>>& changes) const {
        json gltf = triangle_;
        for (const auto& [pointer, value] : changes) {
            gltf[json::json_pointer(pointer)] = value;
        }
        return gltf;
    }

    test::TemporaryFolder folder_;
    json triangle_ = json::parse(test::triangle_gltf(test::triangle_data));
};

TEST_F(GltfKeys, OfAccessorsAreNamedWhereTheyAreWrong) {
    const std::vector<std::pair<std::pair<std::string, json>, std::string>> damages{
        {{"/accessors/0/componentType", 5999},
         "accessors[0].componentType is 5999, 5126 was expected for POSITION"},
        {{"/accessors/0/componentType", 5123}, "accessors[0].componentType is 5123, 5126 was"},
        {{"/accessors/1/componentType", 5126},
         "accessors[1].componentType is 5126, 5121, 5123 or 5125 was expected for indices"},
        {{"/accessors/0/type", "VEC5"},
         "accessors[0].type is \"VEC5\", VEC3 was expected for POSITION"},
        {{"/accessors/1/type", "VEC3"}, "accessors[1].type is \"VEC3\", SCALAR was expected"},
        {{"/accessors/0/count", -3}, "accessors[0].count is -3, a whole number from 0"},
        {{"/accessors/0/count", 3.5}, "accessors[0].count is 3.5, a whole number from 0"},
        {{"/accessors/0/byteOffset", 4},
         "accessors[0] reaches to byte 40 of bufferViews[0], at most 36 bytes were expected"},
        {{"/accessors/0/count", 4000}, "accessors[0] reaches to byte 48000 of bufferViews[0]"},
        {{"/accessors/1/componentType", 5125}, "accessors[1] reaches to byte 12 of bufferViews[1]"},
        {{"/accessors/0/bufferView", 7},
         "accessors[0].bufferView is 7, the number of one of 2 bufferViews was expected"},
        {{"/bufferViews/0/byteStride", 4}, "bufferViews[0].byteStride is 4, at least the 12 bytes"},
        {{"/bufferViews/0/byteStride", 16}, "accessors[0] reaches to byte 44 of bufferViews[0]"},
        {{"/bufferViews/1/byteOffset", 40},
         "bufferViews[1] reaches to byte 46 of buffers[0], at most 42 bytes were expected"},
        {{"/bufferViews/1/byteLength", 4e10}, "bufferViews[1].byteLength is 40000000000.0, a"},
        {{"/bufferViews/1/buffer", "first"}, "bufferViews[1].buffer is \"first\", the number of"},
        {{"/meshes/0/primitives/0/attributes/POSITION", 9},
         "meshes[0].primitives[0].attributes.POSITION is 9, the number of one of 2 accessors"},
        {{"/meshes/0/primitives/0/indices", "1"},
         "meshes[0].primitives[0].indices is \"1\", the number of one of 2 accessors"}};
    for (const auto& [change, sentence] : damages) {
        EXPECT_THAT(refusal(changed({change})),
                    AllOf(StartsWith((folder_.path() / "a.gltf").string() + ": "),
                          HasSubstr(sentence), HasSubstr("expected")));
    }
}

TEST_F(GltfKeys, OfSparseAccessorsAreNamedToo) {
    const json sparse{{"count", 1},
                      {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
                      {"values", {{"bufferView", 0}}}};
    const auto with = [&](const std::string& pointer, const json& value) {
        json changed_sparse = sparse;
        changed_sparse[json::json_pointer(pointer)] = value;
        return changed({{"/accessors/0/sparse", changed_sparse}});
    };
    EXPECT_TRUE(read(changed({{"/accessors/0/sparse", sparse}})));
    EXPECT_THAT(refusal(with("/count", 4)),
                HasSubstr("accessors[0].sparse.indices reaches to byte 8 of bufferViews[1]"));
    EXPECT_THAT(refusal(with("/values/byteOffset", 30)),
                HasSubstr("accessors[0].sparse.values reaches to byte 42 of bufferViews[0]"));
    EXPECT_THAT(refusal(with("/indices/componentType", 5126)),
                HasSubstr("accessors[0].sparse.indices.componentType is 5126"));
}

TEST_F(GltfKeys, ThatReljefDoesNotShowMayHaveAnyValue) {
    json gltf = changed({{"/cameras", {{{"type", "perspective"}}, {{"type", "perspective"}}}},
                         {"/nodes/0/camera", 0},
                         {"/nodes/0/name", "one name"},
                         {"/nodes/1", {{"name", "one name"}, {"camera", 1}}},
                         {"/scenes/0/nodes", {0, 1}},
                         {"/animations", "none"},
                         {"/accessors/2", {{"componentType", 5126}, {"count", 1'000'000'000}}},
                         {"/meshes/0/primitives/0/attributes/TANGENT", 2},
                         {"/meshes/0/extras", {{"of", "a program"}}}});
    const auto file = read(gltf);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->parts.size(), 1U);
    std::string text = gltf.dump();
    text.replace(text.find("one name"), 8, "\xE9n\xE9 n\xE0m\xE9"); // Latin-1
    EXPECT_TRUE(read_mesh_file(folder_.write("latin.gltf", text)));
}

TEST_F(GltfKeys, OfNodesThatMirrorKeepFacesOutside) {
    const json mirror{{"mesh", 0}, {"scale", {-1, 1, 1}}, {"translation", {10, 0, 0}}};
    const auto file = read(changed({{"/nodes/0", mirror}}));
    ASSERT_TRUE(file) << file.error().message;
    const scene::Mesh& mesh = *file->parts[0].mesh;
    EXPECT_EQ(file->bounds.low, glm::dvec3(9.0, 0.0, 0.0));
    EXPECT_EQ(file->bounds.high, glm::dvec3(10.0, 0.0, 2.0));
    const scene::TriangleEdges edges = scene::triangle_edges(mesh, 0);
    EXPECT_LT(glm::cross(edges.p, edges.q).y, 0.0) << "z of the file is south";
    EXPECT_EQ(mesh.normals[0], glm::vec3(0.0F, -1.0F, 0.0F));
}

// Steps of Assimp need the square of these numbers: over a minute each.
TEST_F(GltfKeys, OfManyNodesAndMaterialsCostLittle) {
    constexpr unsigned nodes = 100'000;
    constexpr unsigned materials = 5'000;
    json gltf = triangle_;
    for (unsigned i = 0; i < nodes; ++i) {
        gltf["nodes"][i] = {{"mesh", i % materials}};
        gltf["scenes"][0]["nodes"][i] = i;
    }
    for (unsigned i = 0; i < materials; ++i) {
        gltf["meshes"][i] = triangle_["meshes"][0];
        gltf["meshes"][i]["primitives"][0]["material"] = i;
        gltf["materials"][i] = triangle_["materials"][0];
    }
    ImportLimits limits;
    limits.seconds = 15; // of the processor
    const auto file = read(gltf, limits);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->parts.size(), materials);
}

TEST_F(GltfKeys, CountNodesMaterialsAndVertices) {
    json many = triangle_;
    for (unsigned i = 0; i <= max_mesh_parts; ++i) {
        many["meshes"][0]["primitives"][i] = triangle_["meshes"][0]["primitives"][0];
        many["meshes"][0]["primitives"][i]["material"] = i;
    }
    EXPECT_THAT(refusal(many), HasSubstr("10001 materials in use found, at most 10000"));
    json empty = changed({{"/nodes/0", {{"children", {1, 1}}}}});
    for (unsigned i = 1; i < 20; ++i) { // 2 to the power of 20
        empty["nodes"][i] = {{"children", {i + 1, i + 1}}};
    }
    empty["nodes"][20] = {{"mesh", 0}};
    empty["meshes"][0]["primitives"][0]["mode"] = 0; // points
    EXPECT_THAT(refusal(empty), HasSubstr("2097151 nodes found, at most 1000000 were expected"));
    const json shared = changed({{"/accessors/0/count", 13'000'000}});
    EXPECT_THAT(refusal(shared), HasSubstr("13000000 vertices of primitives found, at most"));
}

} // namespace
} // namespace reljef::io

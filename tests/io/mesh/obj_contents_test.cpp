#include "engine/io/mesh/obj_contents.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

ObjContents contents_of(const std::string& text) {
    const test::TemporaryFolder folder;
    const auto found = obj_contents(folder.write("a.obj", text));
    EXPECT_TRUE(found);
    return found ? *found : ObjContents();
}

TEST(ObjContents, CountsTrianglesOfFaces) {
    EXPECT_EQ(contents_of("").triangles, 0U);
    EXPECT_EQ(contents_of("f 1 2 3\nf 1/1 2/2 3/3 4/4\r\n  f\t1 2 3 4 5").triangles, 6U);
    EXPECT_EQ(contents_of("f 1 2 \\\n3 \\\r\n4\n").triangles, 2U) << "one line";
    EXPECT_EQ(contents_of("# f 1 2 3\nv 1 2 3 4 5\nf 1 2\nl 1 2 3\nfoo 1 2 3\n").triangles, 0U);
}

TEST(ObjContents, CountsCornersOfLargeFaces) {
    const ObjContents found = contents_of("f 1 2 3 4\nf 1 2 3 4 5\nf 1 2 3 4 5 6\nf 1 2 3\n");
    EXPECT_EQ(found.max_corners, 6U);
    EXPECT_EQ(found.face_work, 25U + 36U);
}

TEST(ObjContents, CountsChangesOfTheMaterial) {
    EXPECT_EQ(contents_of("usemtl a\nusemtl a\nusemtl b\nusemtl a \nusemtl a\n").material_changes,
              3U);
}

TEST(ObjContents, NamesLibraries) {
    EXPECT_THAT(contents_of("mtllib  my file.mtl \r\nmtllib b.mtl\nmtllib\n").libraries,
                testing::ElementsAre("my file.mtl", "b.mtl"));
    std::string text;
    for (int i = 0; i < 200; ++i) {
        text += "mtllib " + std::string(10'000, 'x') + "\n";
    }
    const ObjContents many = contents_of(text);
    EXPECT_EQ(many.libraries.size(), max_obj_libraries);
    EXPECT_LE(many.libraries[0].size(), 4096U);
}

} // namespace
} // namespace reljef::io

#include "tests/architecture/include_table.h"
#include "tests/architecture/source_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

SourceFile file_with(std::string path, std::string text) {
    return {std::move(path), std::move(text)};
}

std::vector<std::string> include_paths(std::string_view text) {
    std::vector<std::string> paths;
    for (const Include& include : includes_of(text)) {
        paths.push_back(include.path);
    }
    return paths;
}

TEST(CodeOf, BlanksCommentsAndLiteralsAndKeepsTheLines) {
    EXPECT_EQ(code_of("a // b\nc"), "a     \nc");
    EXPECT_EQ(code_of("a /* b\nc */ d"), "a     \n     d");
    EXPECT_EQ(code_of(R"(f("//", 'x'))"), R"(f("  ", ' '))");
    EXPECT_EQ(code_of(R"(f("a\"b") + g)"), R"(f("    ") + g)");
    EXPECT_EQ(code_of("1'000 + glClear()"), "1'000 + glClear()");
}

TEST(CodeOf, BlanksRawStrings) {
    EXPECT_EQ(code_of("R\"x(a)\" b)x\" c"), "R          \" c");
    EXPECT_EQ(code_of("R\"(never"), "R      r");
}

TEST(CodeOf, SurvivesWhatIsNeverClosed) {
    EXPECT_EQ(code_of("a \"b").size(), 4U);
    EXPECT_EQ(code_of("a /*b"), "a    ");
    EXPECT_EQ(code_of(""), "");
}

TEST(IncludesOf, FindsBothKindsInAnyLayout) {
    EXPECT_THAT(include_paths("#include \"engine/a.h\"\n  #  include <b/c.h> // why\n"),
                ElementsAre("engine/a.h", "b/c.h"));
}

TEST(IncludesOf, OverlooksCommentsAndStrings) {
    EXPECT_THAT(include_paths("// #include \"a.h\"\n/*\n#include <b.h>\n*/\n"), IsEmpty());
    EXPECT_THAT(include_paths("auto s = R\"(\n#include <b.h>\n)\";"), IsEmpty());
}

TEST(RoomOf, IsTheFolderOfCode) {
    EXPECT_EQ(room_of("engine/core/grid.h"), "engine/core");
    EXPECT_EQ(room_of("engine/io/raster/raster.h"), "engine/io/raster");
    EXPECT_EQ(room_of("terrains/natural/erosion.h"), "terrains/natural");
    EXPECT_EQ(room_of("tests/core/grid_test.cpp"), "tests");
    EXPECT_EQ(room_of("engine/nowhere/a.h"), "");
    EXPECT_EQ(room_of("fmt/format.h"), "");
    EXPECT_EQ(room_of("core"), "");
}

TEST(IncludeTable, AllowsWhatLiesBelow) {
    EXPECT_TRUE(may_include("engine/geo", "engine/core"));
    EXPECT_TRUE(may_include("engine/io/raster", "engine/core"));
    EXPECT_TRUE(may_include("engine/io/imagery", "engine/io/files"));
    EXPECT_FALSE(may_include("engine/io/imagery", "engine/io"));
    EXPECT_TRUE(may_include("engine/io", "engine/io/imagery"));
    EXPECT_TRUE(may_include("engine/render/passes", "engine/view"));
    EXPECT_TRUE(may_include("engine/render", "engine/gl"));
    EXPECT_TRUE(may_include("engine/truth", "engine/geo"));
    EXPECT_TRUE(may_include("engine/session", "engine/gl"));
    EXPECT_TRUE(may_include("app", "engine/session"));
    EXPECT_TRUE(may_include("bench/suites", "app/cli"));
    EXPECT_TRUE(may_include("tests", "app"));
}

TEST(IncludeTable, RefusesUpwardAndSideways) {
    EXPECT_FALSE(may_include("engine/core", "engine/geo"));
    EXPECT_FALSE(may_include("engine/terrain/field", "engine/io/raster"));
    EXPECT_FALSE(may_include("engine/terrain/mesh", "engine/terrain/tree"));
    EXPECT_FALSE(may_include("engine/io", "engine/scene/graph"));
    EXPECT_FALSE(may_include("engine/io/raster", "engine/io"));
    EXPECT_FALSE(may_include("engine/scene/graph", "engine/gl"));
    EXPECT_FALSE(may_include("engine/view", "engine/gl"));
    EXPECT_FALSE(may_include("engine/view", "engine/render"));
    EXPECT_FALSE(may_include("engine/gl", "engine/geo"));
    EXPECT_FALSE(may_include("engine/render", "engine/platform"));
    EXPECT_FALSE(may_include("engine/render", "engine/io"));
    EXPECT_FALSE(may_include("engine/session", "app/cli"));
    EXPECT_FALSE(may_include("bench", "app"));
    EXPECT_FALSE(may_include("bench/suites", "app/viewer"));
    EXPECT_FALSE(may_include("app", "bench"));
    EXPECT_FALSE(may_include("terrains", "engine/io"));
    EXPECT_FALSE(may_include("engine/scene/graph", "app"));
    EXPECT_FALSE(may_include("engine/render", "tests"));
}

TEST(IncludeTable, TheGraphIsAboveTheStreams) {
    EXPECT_TRUE(may_include("engine/scene/graph", "engine/scene/streaming"));
    EXPECT_TRUE(may_include("engine/scene/graph", "engine/terrain/tree"));
    EXPECT_TRUE(may_include("engine/scene/motion", "engine/terrain/field"));
    EXPECT_TRUE(may_include("engine/truth", "engine/scene/streaming"));
    EXPECT_FALSE(may_include("engine/scene/streaming", "engine/scene/graph"));
    EXPECT_FALSE(may_include("engine/scene/streaming", "engine/scene/technique"));
}

TEST(IncludeTable, HidesWhatLiesBelowTheSessionFromThePrograms) {
    for (const char* const room :
         {"app", "app/cli", "app/viewer", "bench", "bench/page", "bench/report", "bench/runner",
          "bench/suites", "bench/baselines"}) {
        EXPECT_TRUE(may_include(room, "engine/core")) << room;
        for (const char* const hidden :
             {"engine/gl", "engine/cast", "engine/render", "engine/render/passes",
              "engine/render/shaders", "engine/terrain/tree", "engine/io", "engine/io/cache",
              "engine/io/imagery"}) {
            EXPECT_FALSE(may_include(room, hidden)) << room << ' ' << hidden;
        }
    }
    EXPECT_TRUE(may_include("bench/baselines", "engine/terrain/mesh"));
    EXPECT_FALSE(may_include("bench", "engine/terrain/mesh"));
    EXPECT_TRUE(may_include("app", "app/cli"));
    EXPECT_FALSE(may_include("app", "engine/view")) << "named for app/cli alone";
    EXPECT_FALSE(may_include("app/cli", "app/viewer"));
    EXPECT_FALSE(may_include("bench/page", "engine/session"));
}

TEST(IncludeTable, GivesTheShadersToRenderOnly) {
    EXPECT_TRUE(may_include("engine/render/shaders", "shaders/frame"));
    EXPECT_TRUE(may_include("engine/cast/packet", "shaders/terrain"));
    EXPECT_FALSE(may_include("engine/cast/frame", "shaders/terrain"));
    EXPECT_FALSE(may_include("app", "shaders/frame"));
    EXPECT_FALSE(may_include("engine/scene/graph", "shaders/frame"));
    EXPECT_TRUE(may_include("tests", "shaders/frame"));
}

TEST(ForbiddenIncludes, NameTheFileAndWhatItIncludes) {
    EXPECT_THAT(
        forbidden_includes(file_with("engine/core/a.h", "#include \"engine/io/image/image.h\"\n")),
        ElementsAre("engine/core/a.h includes engine/io/image/image.h: engine/core may not include "
                    "engine/io/image"));
    EXPECT_THAT(
        forbidden_includes(file_with("engine/io/raster/a.h", "#include \"engine/core/b.h\"\n")),
        IsEmpty());
}

TEST(ForbiddenIncludes, WantOwnFilesFromTheRootAndLibrariesInAngleBrackets) {
    EXPECT_THAT(forbidden_includes(file_with("engine/core/a.h", "#include \"b.h\"\n")), SizeIs(1));
    EXPECT_THAT(forbidden_includes(file_with("app/a.cpp", "#include <engine/core/b.h>\n")),
                SizeIs(1));
    EXPECT_THAT(forbidden_includes(file_with("engine/core/a.h", "#include <vector>\n")), IsEmpty());
}

TEST(Libraries, StayInTheirRoomAndItsTests) {
    const std::string gdal = "#include <gdal_priv.h>\n";
    const std::string images = "#include <OpenImageIO/imageio.h>\n";
    const std::string geodesy = "#include <GeographicLib/Geocentric.hpp>\n";
    EXPECT_THAT(libraries_outside_their_room(file_with("engine/io/a.cpp", gdal)), IsEmpty());
    EXPECT_THAT(libraries_outside_their_room(file_with("engine/io/image/a.cpp", images)),
                ElementsAre(HasSubstr("only engine/io/codec/ may include OpenImageIO")));
    EXPECT_THAT(libraries_outside_their_room(file_with("engine/io/codec/a.cpp", images)),
                IsEmpty());
    EXPECT_THAT(libraries_outside_their_room(file_with("tests/io/a.cpp", gdal)), IsEmpty());
    const std::string panels = "#include <imgui.h>\n#include <backends/imgui_impl_opengl3.h>\n";
    EXPECT_THAT(libraries_outside_their_room(file_with("app/viewer/panels/a.cpp", panels)),
                IsEmpty());
    EXPECT_THAT(libraries_outside_their_room(file_with("app/viewer/a.cpp", panels)), SizeIs(2));
    EXPECT_THAT(libraries_outside_their_room(file_with("engine/geo/a.cpp", geodesy)), IsEmpty());
    EXPECT_THAT(libraries_outside_their_room(file_with("app/a.cpp", gdal + images + geodesy)),
                SizeIs(3));
    EXPECT_THAT(libraries_outside_their_room(file_with("engine/geo/a.cpp", gdal)),
                ElementsAre(HasSubstr("only engine/io/ may include GDAL")));
    EXPECT_THAT(libraries_outside_their_room(file_with("engine/io/a.cpp", geodesy)), SizeIs(1));
    EXPECT_THAT(libraries_outside_their_room(
                    file_with("bench/a.cpp", "#include <ogr_spatialref.h>\n#include <cpl_vsi.h>")),
                SizeIs(2));
}

TEST(Libraries, TheCommandLinesLibraryIsForPrograms) {
    const std::string text = "#include <CLI/CLI.hpp>\n";
    for (const char* const path : {"app/cli/a.h", "bench/a.cpp", "tests/app/a_test.cpp"}) {
        EXPECT_THAT(libraries_outside_their_room(file_with(path, text)), IsEmpty()) << path;
    }
    for (const char* const path : {"engine/session/a.cpp", "terrains/a.cpp"}) {
        EXPECT_THAT(libraries_outside_their_room(file_with(path, text)),
                    ElementsAre(HasSubstr("may include CLI11")))
            << path;
    }
}

TEST(Gl, StaysInItsRooms) {
    const std::string text = "#include <glad/gl.h>\nvoid f() { glClear(0); }\n";
    for (const char* const path :
         {"engine/gl/a.cpp", "engine/platform/a.cpp", "engine/render/a.cpp", "tests/gl/a.h",
          "tests/platform/a_test.cpp", "tests/render/a_gl_test.cpp"}) {
        EXPECT_THAT(gl_outside_its_rooms(file_with(path, text)), IsEmpty()) << path;
    }
    for (const char* const path : {"engine/scene/a.cpp", "app/a_gl_test.cpp", "bench/a.cpp",
                                   "tests/render/a_test.cpp", "engine/glue/a.cpp"}) {
        EXPECT_THAT(gl_outside_its_rooms(file_with(path, text)), SizeIs(2)) << path;
    }
}

TEST(Gl, HeadersOfWindowsAndContextsCountToo) {
    const std::string text = "#include <GLFW/glfw3.h>\n#include <EGL/egl.h>\n"
                             "#include <GL/osmesa.h>\n#include <glm/vec3.hpp>\n";
    EXPECT_THAT(gl_outside_its_rooms(file_with("app/a.cpp", text)), SizeIs(3));
}

TEST(Gl, OnlyCallsAreMeant) {
    EXPECT_THAT(gl_outside_its_rooms(file_with(
                    "app/a.cpp", "// glClear(0)\nauto s = \"glClear(0)\"; global(); glow(1);")),
                IsEmpty());
    EXPECT_THAT(gl_outside_its_rooms(file_with("app/a.cpp", "::glDrawArrays (a, b);")),
                ElementsAre(HasSubstr("glDrawArrays")));
}

TEST(UniformsByString, StayWhereUniformsAreDeclared) {
    for (const char* const text :
         {"program.set_uniform(\"eye\", eye);", "program->set( \"eye\", eye);",
          "program.set(gl::Uniform<float>(\"eye\"), 1.0F);", "glProgramUniform1f(id, 3, 1.0F);",
          "glGetUniformLocation(id, \"eye\");", "maps.lit.bind(0);", "block.bind_uniform_block(2);",
          "program.bind_sampler(\"map\", unit);"}) {
        EXPECT_THAT(uniforms_by_string(file_with("engine/render/passes/a.cpp", text)), SizeIs(1))
            << text;
        EXPECT_THAT(uniforms_by_string(file_with("engine/render/shaders/a.h", text)), IsEmpty());
        EXPECT_THAT(uniforms_by_string(file_with("tests/gl/a_gl_test.cpp", text)), IsEmpty());
    }
    for (const char* const text :
         {"program.set(uniforms.eye, eye);", "maps.lit.bind(bindings::lit_map_unit);",
          "frame_context.picture.bind();", "// set_uniform(\"eye\")", "offset(\"x\");"}) {
        EXPECT_THAT(uniforms_by_string(file_with("engine/render/passes/a.cpp", text)), IsEmpty())
            << text;
    }
}

TEST(TechniquesByString, StayInTheTableTheCommandLineAndTests) {
    for (const char* const text :
         {"auto t = scene::parse_technique(\"polygons\").value();",
          "auto t = scene::parse_technique(fmt::format(text, error));",
          "auto t = parse_technique( std::string(\"exact\"));",
          "constexpr std::string_view coarse = \"polygons:lods=5\";",
          "for (const char* t : {\"texture\", \"multi-layer:n=64\"}) {}"}) {
        for (const char* const path : {"bench/suites/a.cpp", "app/viewer/a.cpp",
                                       "engine/session/a.cpp", "engine/scene/graph/a.h"}) {
            EXPECT_THAT(techniques_by_string(file_with(path, text)), SizeIs(1)) << path << text;
        }
        for (const char* const path : {"engine/scene/technique/a.cpp", "app/cli/a.cpp",
                                       "terrains/gallery/a.cpp", "tests/scene/a_test.cpp"}) {
            EXPECT_THAT(techniques_by_string(file_with(path, text)), IsEmpty()) << path << text;
        }
    }
    for (const char* const text :
         {"auto t = scene::parse_technique(argument);", "// \"polygons:error=1\"",
          "fmt::format(\"irrlicht:lods={}\", levels)", "Polygons{.error = 1.0}",
          "log(\"see: a=b\");"}) {
        EXPECT_THAT(techniques_by_string(file_with("bench/a.cpp", text)), IsEmpty()) << text;
    }
}

TEST(PrintingExitingOrThrowing, IsForPrograms) {
    for (const char* const text :
         {"fmt::print(\"{}\", x);", "fmt::println(\"x\");", "std::cout << x;", "std::cerr << x;",
          "std::fprintf(stderr, text);", "printf(\"x\");", "::puts(text);", "perror(text);",
          "std::exit(1);", "{exit (1);}", "_exit(1);", "std::quick_exit(0);", "::abort();",
          "std::terminate();", "throw std::runtime_error(text);", "throw;"}) {
        EXPECT_THAT(printing_exiting_or_throwing(file_with("engine/io/a.cpp", text)), SizeIs(1))
            << text;
        EXPECT_THAT(printing_exiting_or_throwing(file_with("terrains/a.h", text)), SizeIs(1));
        EXPECT_THAT(printing_exiting_or_throwing(file_with("app/a.cpp", text)), IsEmpty());
        EXPECT_THAT(printing_exiting_or_throwing(file_with("bench/a.cpp", text)), IsEmpty());
        EXPECT_THAT(printing_exiting_or_throwing(file_with("engine/core/check.cpp", text)),
                    IsEmpty());
    }
    for (const char* const text :
         {"// must not throw", "auto s = \"exit(1)\";", "std::snprintf(buffer, size, text);",
          "queue.abort();", "stream->puts(text);", "on_exit(f);", "fmt::format(\"{}\", x);",
          "int exit_code = 0;", "rethrow(error);"}) {
        EXPECT_THAT(printing_exiting_or_throwing(file_with("engine/io/a.cpp", text)), IsEmpty())
            << text;
    }
}

TEST(MachinePaths, AreFoundInTextAndComments) {
    EXPECT_THAT(machine_paths(file_with("a.cpp", "open(\"/ho"
                                                 "me/ann/x.tif\")")),
                ElementsAre("a.cpp names /ho"
                            "me/ann/x.tif, a place on one machine"));
    EXPECT_THAT(machine_paths(file_with("a.h", "// see /wo"
                                               "rk/main\n")),
                SizeIs(1));
    EXPECT_THAT(machine_paths(file_with("dev", "/tm"
                                               "p/out")),
                SizeIs(1));
}

TEST(MachinePaths, PlacesEveryMachineHasAndPartsOfPathsAreFine) {
    EXPECT_THAT(machine_paths(file_with("a", "/dev/null /usr/share/x ../wo"
                                             "rk/y at/ho"
                                             "me/z")),
                IsEmpty());
}

TEST(IncludeCircles, AreFoundAtAnyLength) {
    const std::vector<SourceFile> files{
        {"engine/a.h", "#include \"engine/b.h\"\n"},
        {"engine/b.h", "#include \"engine/c.h\"\n"},
        {"engine/c.h", "#include \"engine/a.h\"\n"},
        {"engine/self.h", "#include \"engine/self.h\"\n"},
    };
    EXPECT_THAT(include_circles(files),
                ElementsAre("engine/a.h -> engine/b.h -> engine/c.h -> engine/a.h",
                            "engine/self.h -> engine/self.h"));
}

TEST(IncludeCircles, SharedHeadersAreNone) {
    const std::vector<SourceFile> files{
        {"engine/a.h", "#include \"engine/b.h\"\n#include \"engine/c.h\"\n"},
        {"engine/b.h", "#include \"engine/d.h\"\n"},
        {"engine/c.h", "#include \"engine/d.h\"\n#include \"engine/b.h\"\n"},
        {"engine/d.h", ""},
    };
    EXPECT_THAT(include_circles(files), IsEmpty());
}

TEST(MissingIncludes, AreThoseOfHeadersThatNobodyBrings) {
    const std::vector<SourceFile> files{
        {"engine/a.h", "#include <vector>\n#include <glm/vec3.hpp>\n"},
        {"engine/b.h", "#include \"engine/a.h\"\nstd::vector<glm::vec3> all; // std::map\n"},
        {"engine/c.h", "std::string s = fmt::format(x);\nstd::strange t;\n"},
        {"engine/c.cpp", "std::map<int, int> m;\n"},
    };
    EXPECT_THAT(missing_includes(files),
                ElementsAre("engine/c.h needs <fmt/> and includes it nowhere",
                            "engine/c.h needs <string> and includes it nowhere"));
}

TEST(UnlistedFiles, AreNamed) {
    const std::vector<SourceFile> files{
        {"engine/core/CMakeLists.txt", "reljef_room(core HEADERS a.h\n  SOURCES a.cpp)"},
        {"engine/core/a.h", ""},
        {"engine/core/a.cpp", ""},
        {"engine/core/readme.md", ""},
        {"engine/core/h.cpp", ""},
        {"engine/geo/b.h", ""},
    };
    EXPECT_THAT(unlisted_files(files),
                ElementsAre("engine/core/h.cpp is not named in engine/core/CMakeLists.txt",
                            "engine/geo/b.h is not named in engine/geo/CMakeLists.txt"));
}

TEST(PrivateHeadersInPublicOnes, AreNamed) {
    const std::vector<SourceFile> files{
        {"engine/core/CMakeLists.txt", "reljef_room(core HEADERS a.h SOURCES a.cpp b.h)"},
        {"engine/core/a.h", "#include \"engine/core/b.h\"\n#include \"engine/geo/c.h\"\n"},
        {"engine/core/b.h", "#include \"engine/core/a.h\"\n"},
        {"engine/core/a.cpp", "#include \"engine/core/b.h\"\n"},
        {"engine/geo/CMakeLists.txt", "reljef_room(geo\n  HEADERS c.h\n  SOURCES c.cpp)"},
        {"engine/geo/c.h", "#include <vector>\n"},
    };
    EXPECT_THAT(private_headers_in_public_ones(files),
                ElementsAre("engine/core/a.h is installed and includes engine/core/b.h, which is "
                            "not"));
}

TEST(CrowdedFolders, AreThoseOfTooManyConcepts) {
    std::vector<SourceFile> files;
    for (std::size_t i = 0; i < max_concepts; ++i) {
        for (const char* const ending : {".h", ".cpp", "_test.cpp"}) {
            files.push_back(file_with("a/concept" + std::to_string(i) + ending, ""));
        }
    }
    EXPECT_THAT(crowded_folders(files), IsEmpty());
    files.push_back(file_with("a/one_more.h", ""));
    EXPECT_THAT(crowded_folders(files), SizeIs(1));
}

TEST(LongFiles, AreThoseOfMoreThanFiveHundredLines) {
    const std::string lines(static_cast<std::size_t>(max_lines), '\n');
    EXPECT_THAT(long_file({"a.cpp", lines}), IsEmpty());
    EXPECT_THAT(long_file({"a.cpp", lines + '\n'}),
                ElementsAre("a.cpp has 501 lines, at most 500 were expected"));
}

} // namespace
} // namespace reljef::test

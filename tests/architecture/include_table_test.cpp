// The rules of source_rules.h, held against the project itself.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/architecture/include_table.h"
#include "tests/architecture/source_rules.h"
#include "tests/architecture/word_rules.h"
#include "tests/support/temporary_folder.h"

namespace reljef::test {
namespace {

namespace fs = std::filesystem;
using testing::Each;
using testing::IsEmpty;

// All files below these folders of the project.
std::vector<SourceFile> files_below(std::initializer_list<const char*> folders) {
    const fs::path root = RELJEF_SOURCE_FOLDER;
    std::vector<SourceFile> files;
    for (const char* const folder : folders) {
        for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
            if (entry.is_regular_file()) {
                files.push_back({entry.path().lexically_relative(root).generic_string(),
                                 read_bytes(entry.path())});
            }
        }
    }
    return files;
}

std::vector<SourceFile> all_code() {
    std::vector<SourceFile> files = files_below({"engine", "app", "bench", "terrains", "tests"});
    std::erase_if(files, [](const SourceFile& file) {
        return !file.path.ends_with(".h") && !file.path.ends_with(".cpp");
    });
    return files;
}

template <class Rule> Complaints complaints_about(const std::vector<SourceFile>& files, Rule rule) {
    Complaints all;
    for (const SourceFile& file : files) {
        const Complaints some = rule(file);
        all.insert(all.end(), some.begin(), some.end());
    }
    return all;
}

TEST(Project, EveryFileLiesInARoom) {
    const auto files = all_code();
    EXPECT_GT(files.size(), 50U);
    for (const SourceFile& file : files) {
        EXPECT_NE(room_of(file.path), "") << file.path;
    }
}

TEST(Project, IncludesOnlyWhatTheTableAllows) {
    EXPECT_THAT(complaints_about(all_code(), forbidden_includes), IsEmpty());
}

TEST(Project, KeepsLibrariesInTheirRooms) {
    EXPECT_THAT(complaints_about(all_code(), libraries_outside_their_room), IsEmpty());
}

TEST(Project, KeepsGlInItsRooms) {
    EXPECT_THAT(complaints_about(all_code(), gl_outside_its_rooms), IsEmpty());
}

TEST(Project, SetsNoUniformByString) {
    EXPECT_THAT(complaints_about(all_code(), uniforms_by_string), IsEmpty());
}

TEST(Project, WritesNoTechniqueAsText) {
    EXPECT_THAT(complaints_about(all_code(), techniques_by_string), IsEmpty());
}

TEST(Project, NeitherPrintsNorExitsNorThrowsInTheLibrary) {
    EXPECT_THAT(complaints_about(all_code(), printing_exiting_or_throwing), IsEmpty());
}

TEST(Project, IncludesInEveryHeaderWhatItNames) {
    EXPECT_THAT(missing_includes(all_code()), IsEmpty());
}

TEST(Project, HasNoCircleOfIncludes) {
    EXPECT_THAT(include_circles(all_code()), IsEmpty());
}

TEST(Project, ListsEveryFileInItsFolder) {
    EXPECT_THAT(unlisted_files(files_below({"engine", "app", "bench", "terrains", "tests"})),
                IsEmpty());
}

TEST(Project, InstallsEveryHeaderThatAnInstalledOneIncludes) {
    EXPECT_THAT(private_headers_in_public_ones(files_below({"engine", "terrains"})), IsEmpty());
}

TEST(Project, UsesTheFieldsWords) {
    const auto product = files_below({"engine", "app", "bench", "terrains"});
    EXPECT_THAT(complaints_about(product, dialect_names), IsEmpty());
    EXPECT_THAT(complaints_about(product, dialect_comments), IsEmpty());
}

TEST(Project, CrowdsNoFolder) {
    std::vector<SourceFile> files =
        files_below({"engine", "app", "bench", "terrains", "tests", "shaders"});
    std::erase_if(files, [](const SourceFile& file) {
        return file.path.ends_with(".png") || file.path.starts_with("bench/results") ||
               file.path.starts_with("tests/corpora");
    });
    EXPECT_THAT(crowded_folders(files), IsEmpty());
}

TEST(Project, HasNoLongFile) {
    EXPECT_THAT(complaints_about(all_code(), long_file), IsEmpty());
}

TEST(Project, NamesNoPlaceOnOneMachine) {
    std::vector<SourceFile> files =
        files_below({"engine", "app", "bench", "terrains", "tests", "shaders", "cmake", ".ci"});
    for (const auto& entry : fs::directory_iterator(RELJEF_SOURCE_FOLDER)) {
        if (entry.is_regular_file()) {
            files.push_back({entry.path().filename().string(), read_bytes(entry.path())});
        }
    }
    std::erase_if(files, [](const SourceFile& file) { return file.path.ends_with(".png"); });
    EXPECT_THAT(complaints_about(files, machine_paths), IsEmpty());
}

} // namespace
} // namespace reljef::test

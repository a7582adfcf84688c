#include "app/cli/suggestion.h"

#include <array>
#include <random>

#include <gtest/gtest.h>

namespace reljef::cli {
namespace {

TEST(Suggestion, DistanceCountsEdits) {
    EXPECT_EQ(edit_distance("", ""), 0);
    EXPECT_EQ(edit_distance("render", ""), 6);
    EXPECT_EQ(edit_distance("render", "render"), 0);
    EXPECT_EQ(edit_distance("rendr", "render"), 1);
    EXPECT_EQ(edit_distance("redner", "render"), 1) << "neighbours swapped";
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(Suggestion, DistanceIsSymmetricAndNoMoreThanTheEditsMade) {
    std::mt19937 random(7);
    for (int i = 0; i < 2000; ++i) {
        std::string word(1 + random() % 12, 'a');
        for (char& letter : word) {
            letter = static_cast<char>('a' + random() % 4);
        }
        std::string edited = word;
        const int edits = static_cast<int>(random() % 4);
        for (int edit = 0; edit < edits; ++edit) {
            edited.insert(random() % (edited.size() + 1), 1, 'z');
        }
        EXPECT_EQ(edit_distance(word, edited), edits) << word << ' ' << edited;
        EXPECT_EQ(edit_distance(edited, word), edits);
    }
}

TEST(Suggestion, IsTheNearestKnownWordIfItIsNear) {
    const std::array<std::string, 3> known{"view", "render", "height"};
    EXPECT_EQ(suggestion("rendr", known), "; did you mean render?");
    EXPECT_EQ(suggestion("veiw", known), "; did you mean view?");
    EXPECT_EQ(suggestion("bake", known), "");
    EXPECT_EQ(suggestion(std::string(100'000, 'r'), known), "");
}

} // namespace
} // namespace reljef::cli

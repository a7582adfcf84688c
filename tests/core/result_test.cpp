#include "engine/core/result.h"

#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef {
namespace {

Result<std::string> word_if(bool requested) {
    if (!requested) {
        return Error{"no word"};
    }
    return std::string("word");
}

TEST(Result, HoldsAValue) {
    const auto result = word_if(true);
    EXPECT_TRUE(result.has_value());
    EXPECT_TRUE(static_cast<bool>(result));
    EXPECT_EQ(*result, "word");
    EXPECT_EQ(result->size(), 4U);
}

TEST(Result, HoldsAnError) {
    const auto result = word_if(false);
    EXPECT_FALSE(result.has_value());
    EXPECT_FALSE(static_cast<bool>(result));
    EXPECT_EQ(result.error().message, "no word");
}

TEST(Result, CarriesWhatCanOnlyBeMoved) {
    Result<std::unique_ptr<int>> result(std::make_unique<int>(7));
    const std::unique_ptr<int> taken = *std::move(result);
    EXPECT_EQ(*taken, 7);
}

TEST(Result, ValueCanBeChangedInPlace) {
    auto result = word_if(true);
    result->append("s");
    EXPECT_EQ(result.value(), "words");
}

TEST(Result, OfNothingIsSuccessOrAnError) {
    const Result<void> fine;
    const Result<void> failed(Error{"it rained"});
    EXPECT_TRUE(fine.has_value());
    EXPECT_FALSE(failed.has_value());
    EXPECT_EQ(failed.error().message, "it rained");
}

TEST(ResultDeathTest, ValueOfAnErrorAborts) {
    EXPECT_DEATH((void)word_if(false).value(), "value\\(\\) of a Result that holds an error");
}

TEST(ResultDeathTest, ErrorOfAValueAborts) {
    EXPECT_DEATH((void)word_if(true).error(), "error\\(\\) of a Result that holds a value");
    EXPECT_DEATH((void)Result<void>().error(), "error\\(\\) of a Result that holds a value");
}

} // namespace
} // namespace reljef

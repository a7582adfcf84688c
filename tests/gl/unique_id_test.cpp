#include "engine/gl/unique_id.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::gl {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<unsigned int>& deleted() {
    static std::vector<unsigned int> ids;
    return ids;
}

void remember(unsigned int id) {
    deleted().push_back(id);
}

using Id = UniqueId<remember>;

class UniqueIdTest : public ::testing::Test {
protected:
    void SetUp() override { deleted().clear(); }
};

TEST_F(UniqueIdTest, none_is_never_deleted) {
    { const Id none; }
    EXPECT_THAT(deleted(), IsEmpty());
}

TEST_F(UniqueIdTest, each_is_deleted_once) {
    {
        Id first(7);
        const Id second(std::move(first));
        EXPECT_EQ(first.get(), 0U); // NOLINT(bugprone-use-after-move,clang-analyzer-cplusplus.Move)
        EXPECT_EQ(second.get(), 7U);
    }
    EXPECT_THAT(deleted(), ElementsAre(7U));
}

TEST_F(UniqueIdTest, assignment_deletes_the_old_one_at_once) {
    Id target(1);
    target = Id(2);
    EXPECT_THAT(deleted(), ElementsAre(1U));
    EXPECT_EQ(target.get(), 2U);
}

TEST_F(UniqueIdTest, assignment_to_itself_keeps_it) {
    Id id(3);
    Id& same = id;
    id = std::move(same);
    EXPECT_EQ(id.get(), 3U); // NOLINT(bugprone-use-after-move,clang-analyzer-cplusplus.Move)
    EXPECT_THAT(deleted(), IsEmpty());
}

} // namespace
} // namespace reljef::gl

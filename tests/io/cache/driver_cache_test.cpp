// The folder in which Mesa keeps shaders: it follows links, and takes files of other users.
#include <filesystem>

#include <gtest/gtest.h>

#include "engine/io/cache/disk_cache.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

class DriverCache : public testing::Test {
protected:
    const test::TemporaryFolder folder_;
    const test::EnvironmentVariable cache_{"XDG_CACHE_HOME", folder_.path().string()};
    const fs::path of_mesa_ = folder_.path() / "reljef" / "mesa_shader_cache";
};

TEST_F(DriverCache, IsThisUsersAlone) {
    ASSERT_EQ(driver_cache_folder(), folder_.path() / "reljef");
    EXPECT_EQ(fs::status(of_mesa_).permissions(), fs::perms::owner_all);
    EXPECT_EQ(driver_cache_folder(), folder_.path() / "reljef") << "the second time";
}

TEST_F(DriverCache, IsNoneWhereOthersCanWrite) {
    ASSERT_TRUE(driver_cache_folder());
    fs::permissions(of_mesa_, fs::perms::all);
    EXPECT_FALSE(driver_cache_folder());
}

TEST_F(DriverCache, IsNoneWhereItsIndexIsALink) {
    ASSERT_TRUE(driver_cache_folder());
    fs::create_symlink(folder_.write("precious", "hello"), of_mesa_ / "index");
    EXPECT_FALSE(driver_cache_folder());
}

TEST_F(DriverCache, IsNoneWhereAFileIsInItsPlace) {
    fs::create_directory(folder_.path() / "reljef");
    folder_.write("reljef/mesa_shader_cache", "");
    EXPECT_FALSE(driver_cache_folder());
}

} // namespace
} // namespace reljef::io

#include "engine/core/memory_file.h"

#include <cstring>
#include <fstream>

#include <gtest/gtest.h>

namespace reljef {
namespace {

std::string text_in(const MemoryFile& file) {
    const auto bytes = file.bytes();
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "?";
}

TEST(MemoryFile, HoldsWhatIsWrittenToItsName) {
    const auto file = MemoryFile::create();
    ASSERT_TRUE(file);
    EXPECT_EQ(text_in(*file), "");
    std::ofstream(file->path()) << "first, long";
    std::ofstream(file->path()) << "second";
    EXPECT_EQ(text_in(*file), "second");
}

TEST(MemoryFile, MovesWithItsContent) {
    auto file = MemoryFile::create();
    ASSERT_TRUE(file);
    std::ofstream(file->path()) << "kept";
    const MemoryFile moved(std::move(*file));
    EXPECT_EQ(text_in(moved), "kept");
}

TEST(MemoryFile, ThousandsLeaveNoDescriptorBehind) {
    for (int i = 0; i < 5000; ++i) {
        ASSERT_TRUE(MemoryFile::create()) << i;
    }
}

} // namespace
} // namespace reljef

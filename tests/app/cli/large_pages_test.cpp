// The allocator of the programs.
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <limits>
#include <memory>
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/release_only.h"

namespace reljef {
namespace {

constexpr std::size_t megabyte = std::size_t{1} << 20;

std::size_t resident_bytes() {
    constexpr std::size_t page = 4096;
    std::ifstream file("/proc/self/statm");
    std::size_t all = 0;
    std::size_t resident = 0;
    file >> all >> resident;
    return page * resident;
}

bool is_aligned(const void* place, std::size_t alignment) {
    return reinterpret_cast<std::uintptr_t>(place) % alignment == 0;
}

TEST(LargePages, LargeArraysBeginOnAPageAndHoldWhatIsWritten) {
    RELJEF_RELEASE_ONLY("sanitizers have allocators of their own");
    for (const std::size_t size :
         {4 * megabyte, 4 * megabyte + 1, 7 * megabyte - 3, 64 * megabyte}) {
        std::vector<std::uint8_t> array(size, 7);
        EXPECT_TRUE(is_aligned(array.data(), 2 * megabyte)) << size;
        array.back() = 9;
        EXPECT_EQ(std::count(array.begin(), array.end(), 7), static_cast<long>(size) - 1);
    }
}

TEST(LargePages, SmallArraysAreAlignedForEveryType) {
    for (std::size_t size = 0; size < 4 * megabyte; size = 2 * size + 1) {
        const std::unique_ptr<void, void (*)(void*)> array(
            ::operator new(size), [](void* made) { ::operator delete(made); });
        ASSERT_NE(array, nullptr) << size;
        EXPECT_TRUE(is_aligned(array.get(), __STDCPP_DEFAULT_NEW_ALIGNMENT__)) << size;
    }
}

TEST(LargePages, TypesWithAnAlignmentOfTheirOwnHaveIt) {
    struct alignas(4096) Block {
        std::array<std::uint8_t, 4096> bytes{};
    };
    for (const std::size_t count : {std::size_t{1}, std::size_t{3000}}) { // 12 MB
        const std::vector<Block> blocks(count);
        EXPECT_TRUE(is_aligned(blocks.data(), 4096)) << count;
    }
}

// Else a session would keep the memory of the largest terrain that it has shown.
TEST(LargePages, FreedArraysGoBackToTheSystem) {
    RELJEF_RELEASE_ONLY("sanitizers keep what is freed");
    const std::size_t before = resident_bytes();
    for (int round = 0; round < 3; ++round) {
        const std::vector<std::uint8_t> array(200 * megabyte, 1);
        EXPECT_GT(resident_bytes(), before + 150 * megabyte);
    }
    EXPECT_LT(resident_bytes(), before + 50 * megabyte);
}

// Else each draw of a software renderer would ask the system for its memory anew.
TEST(LargePages, BlocksThatADrawFreesStayForTheNext) {
    RELJEF_RELEASE_ONLY("sanitizers have allocators of their own");
    const auto draw = [] {
        std::vector<std::unique_ptr<std::array<std::uint8_t, 65536>>> blocks(16);
        for (auto& block : blocks) {
            block = std::make_unique<std::array<std::uint8_t, 65536>>();
        }
        return ::sbrk(0);
    };
    ::malloc_trim(0); // what tests before have freed at the end of the heap
    const void* const during = draw();
    EXPECT_EQ(::sbrk(0), during);
    EXPECT_EQ(draw(), during);
}

TEST(LargePages, ASizeBeyondAllMemoryThrows) {
    RELJEF_RELEASE_ONLY("sanitizers end the program");
    for (const std::size_t beyond : {std::size_t{0}, 5 * megabyte}) {
        volatile std::size_t size = std::numeric_limits<std::size_t>::max() / 2 - beyond;
        EXPECT_THROW(::operator delete(::operator new(size)), std::bad_alloc) << size;
        EXPECT_EQ(::operator new(size, std::nothrow), nullptr) << size;
    }
    volatile std::size_t all = std::numeric_limits<std::size_t>::max();
    EXPECT_THROW(::operator delete(::operator new(all)), std::bad_alloc);
}

TEST(LargePages, AnArrayLeavesTheLastErrorAsItWas) {
    errno = EXDEV;
    const std::vector<std::uint8_t> array(8 * megabyte, 1);
    EXPECT_EQ(errno, EXDEV);
}

} // namespace
} // namespace reljef

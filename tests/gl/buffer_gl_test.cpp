#include "engine/gl/buffer.h"

#include <array>
#include <random>
#include <vector>

#include <glad/gl.h>

#include "tests/gl/gl_fixture.h"

namespace reljef::gl {
namespace {

using BufferGlTest = test::GlTest;
using test::must;

std::vector<std::byte> random_bytes(std::size_t count, unsigned int seed) {
    std::mt19937 generator(seed);
    std::vector<std::byte> bytes(count);
    for (std::byte& byte : bytes) {
        byte = static_cast<std::byte>(generator() & 0xffU);
    }
    return bytes;
}

std::vector<std::byte> content(const Buffer& buffer) {
    std::vector<std::byte> bytes(buffer.size());
    glGetNamedBufferSubData(buffer.id(), 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
    return bytes;
}

TEST_F(BufferGlTest, content_arrives) {
    const auto bytes = random_bytes(4099, 1);
    const Buffer buffer = must(Buffer::create(bytes));
    EXPECT_EQ(buffer.size(), bytes.size());
    EXPECT_EQ(content(buffer), bytes);
}

TEST_F(BufferGlTest, write_replaces_only_its_range) {
    auto expected = random_bytes(1000, 2);
    Buffer buffer = must(Buffer::create_writable(expected.size()));
    buffer.write(0, expected);
    const auto patch = random_bytes(100, 3);
    buffer.write(900, patch);
    std::copy(patch.begin(), patch.end(), expected.begin() + 900);
    EXPECT_EQ(content(buffer), expected);
}

TEST_F(BufferGlTest, moved_from_is_harmless) {
    const auto bytes = random_bytes(64, 4);
    Buffer first = must(Buffer::create(bytes));
    const unsigned int id = first.id();
    const Buffer second = std::move(first);
    // NOLINTBEGIN(bugprone-use-after-move,clang-analyzer-cplusplus.Move)
    EXPECT_EQ(first.id(), 0U);
    EXPECT_EQ(first.size(), 0U);
    EXPECT_EQ(second.id(), id);
    EXPECT_EQ(content(second), bytes);
    first = must(Buffer::create(bytes));
    EXPECT_EQ(content(first), bytes);
    // NOLINTEND(bugprone-use-after-move,clang-analyzer-cplusplus.Move)
}

TEST_F(BufferGlTest, destruction_frees_the_name) {
    unsigned int id = 0;
    {
        const Buffer buffer = must(Buffer::create_writable(16));
        id = buffer.id();
        EXPECT_EQ(glIsBuffer(id), GL_TRUE);
    }
    EXPECT_EQ(glIsBuffer(id), GL_FALSE);
}

TEST_F(BufferGlTest, impossible_size_is_an_error) {
    const auto buffer = Buffer::create_writable(std::size_t{1} << 62U);
    ASSERT_FALSE(buffer);
    EXPECT_EQ(buffer.error().message,
              "GL buffer of 4611686018427387904 bytes: the driver has no memory for it");
    take_problems();
}

TEST(BufferDeathTest, write_to_none_or_past_the_end_aborts) {
    const std::array<std::byte, 4> bytes{};
    Buffer none;
    EXPECT_DEATH(none.write(0, bytes), "write outside a buffer");
}

} // namespace
} // namespace reljef::gl

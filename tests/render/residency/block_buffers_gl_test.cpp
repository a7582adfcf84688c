#include "engine/render/residency/block_buffers.h"

#include <array>

#include <gtest/gtest.h>

#include "tests/gl/gl_fixture.h"

namespace reljef::render {
namespace {

class BlockBuffersGlTest : public test::GlTest {
protected:
    const gl::Buffer* ask(float value) {
        const std::array values{value, 2.0F, 3.0F, 4.0F};
        return test::must(blocks.buffer(std::as_bytes(std::span(values)), stats));
    }

    void TearDown() override {
        blocks = {};
        GlTest::TearDown();
    }

    BlockBuffers blocks;
    view::FrameStats stats;
};

TEST_F(BlockBuffersGlTest, SameContentIsUploadedOnce) {
    const gl::Buffer* const first = ask(1.0F);
    EXPECT_EQ(first->size(), 16U);
    EXPECT_NE(ask(2.0F), first);
    blocks.begin_frame();
    EXPECT_EQ(ask(1.0F), first);
    EXPECT_EQ(stats.uploads, 2);
    EXPECT_EQ(stats.upload_bytes, 32U);
}

TEST_F(BlockBuffersGlTest, ContentThatChangesEachFrameDoesNotGather) {
    for (int frame = 0; frame < 3 * BlockBuffers::kept_frames; ++frame) {
        blocks.begin_frame();
        ask(static_cast<float>(frame));
        ask(-1.0F);
        EXPECT_LE(blocks.count(), BlockBuffers::kept_frames + 2U);
    }
}

} // namespace
} // namespace reljef::render

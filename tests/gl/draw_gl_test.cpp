#include "engine/gl/draw.h"

#include <array>
#include <cstdint>
#include <vector>

#include <gmock/gmock.h>

#include "engine/gl/read_pixels.h"
#include "engine/gl/state.h"
#include "tests/gl/gl_fixture.h"

namespace reljef::gl {
namespace {

using test::must;

constexpr int slots = 16;

/// Points: each vertex marks the slot (pixel) that its attribute names, each instance a row.
class DrawGlTest : public test::GlTest {
protected:
    void SetUp() override {
        test::GlTest::SetUp();
        target_ = test::float_target({slots, 2});
        const std::array stages{
            StageSource{.stage = Stage::vertex,
                        .name = "slots.vert",
                        .text = "#version 450 core\nlayout(location = 0) in float slot;\n"
                                "layout(location = 1) in float row;\n"
                                "void main() { gl_Position = vec4((slot + 0.5) / 8.0 - 1.0,\n"
                                "                                 row - 0.5, 0.5, 1.0); }"},
            StageSource{.stage = Stage::fragment,
                        .name = "slots.frag",
                        .text = "#version 450 core\nlayout(location = 0) out vec4 color;\n"
                                "void main() { color = vec4(1.0); }"}};
        program_ = must(Program::create(stages));
        std::array<float, slots> places{};
        for (std::size_t index = 0; index < slots; ++index) {
            places[index] = static_cast<float>(index);
        }
        const std::array<float, 2> rows{0.0F, 1.0F};
        vertices_ = must(Buffer::create(std::as_bytes(std::span(places))));
        instances_ = must(Buffer::create(std::as_bytes(std::span(rows))));
        array_ = VertexArray::create();
        const VertexAttribute slot{.location = 0};
        const VertexAttribute row{.location = 1};
        array_.set_vertices(0, vertices_, {.stride = 4}, std::span(&slot, 1));
        array_.set_vertices(1, instances_, {.stride = 4, .divisor = 1}, std::span(&row, 1));
        set_depth_test(DepthTest::off);
        target_.bind();
        target_.clear_color(glm::vec4(0.0F));
        program_.use();
        array_.bind();
    }
    void TearDown() override {
        array_ = {};
        vertices_ = {};
        instances_ = {};
        indices_ = {};
        program_ = {};
        target_ = {};
        test::GlTest::TearDown();
    }

    template <class Index> void set_indices(const std::vector<Index>& indices) {
        indices_ = must(Buffer::create(std::as_bytes(std::span(indices))));
        array_.set_indices(indices_);
    }

    /// The marked slots of the lower (0) or upper (1) row.
    std::vector<int> marked(int row) {
        const Grid<glm::vec4> pixels = read_float_color(target_);
        std::vector<int> found;
        for (int slot = 0; slot < slots; ++slot) {
            if (pixels(slot, 1 - row).r > 0.0F) {
                found.push_back(slot);
            }
        }
        return found;
    }

private:
    Framebuffer target_;
    Program program_;
    Buffer vertices_;
    Buffer instances_;
    Buffer indices_;
    VertexArray array_;
};

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST_F(DrawGlTest, arrays_start_at_first) {
    draw_arrays(Primitive::points, 3, 2);
    EXPECT_THAT(marked(0), ElementsAre(3, 4));
    EXPECT_THAT(marked(1), IsEmpty());
}

TEST_F(DrawGlTest, indices_of_16_bits) {
    set_indices<std::uint16_t>({1, 5, 9, 13});
    draw_elements({.primitive = Primitive::points, .type = IndexType::uint16, .count = 4});
    EXPECT_THAT(marked(0), ElementsAre(1, 5, 9, 13));
}

TEST_F(DrawGlTest, indices_of_32_bits_from_the_second_on) {
    set_indices<std::uint32_t>({1, 5, 9, 13});
    draw_elements({.primitive = Primitive::points, .count = 2, .first_index = 1});
    EXPECT_THAT(marked(0), ElementsAre(5, 9));
}

TEST_F(DrawGlTest, first_index_counts_indices_not_bytes) {
    set_indices<std::uint16_t>({1, 5, 9, 13});
    draw_elements(
        {.primitive = Primitive::points, .type = IndexType::uint16, .count = 1, .first_index = 3});
    EXPECT_THAT(marked(0), ElementsAre(13));
}

TEST_F(DrawGlTest, base_vertex_is_added_to_each_index) {
    set_indices<std::uint16_t>({0, 2});
    draw_elements(
        {.primitive = Primitive::points, .type = IndexType::uint16, .count = 2, .base_vertex = 10});
    EXPECT_THAT(marked(0), ElementsAre(10, 12));
}

TEST_F(DrawGlTest, instances_step_the_divided_attribute) {
    set_indices<std::uint16_t>({7});
    draw_elements(
        {.primitive = Primitive::points, .type = IndexType::uint16, .count = 1, .instances = 2});
    EXPECT_THAT(marked(0), ElementsAre(7));
    EXPECT_THAT(marked(1), ElementsAre(7));
}

TEST(DrawTest, index_sizes) {
    EXPECT_EQ(size_of(IndexType::uint16), 2U);
    EXPECT_EQ(size_of(IndexType::uint32), 4U);
}

} // namespace
} // namespace reljef::gl

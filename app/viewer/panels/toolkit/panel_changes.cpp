#include "app/viewer/panels/toolkit/panel_changes.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/vec4.hpp>

namespace reljef::app {
namespace {

using Vertices = std::span<const ImDrawVert>;

class Bounds {
public:
    void add(Vertices vertices) {
        for (const ImDrawVert& vertex : vertices) {
            low_ = glm::min(low_, glm::vec2(vertex.pos.x, vertex.pos.y));
            high_ = glm::max(high_, glm::vec2(vertex.pos.x, vertex.pos.y));
        }
    }
    [[nodiscard]] PixelArea within(glm::ivec2 window) const {
        const auto low = glm::ivec2(glm::max(glm::floor(low_), glm::vec2(0.0F)));
        const auto high = glm::ivec2(glm::min(glm::ceil(high_), glm::vec2(window)));
        return high.x > low.x && high.y > low.y ? PixelArea{low, high - low} : PixelArea{};
    }

private:
    glm::vec2 low_{1e9F};
    glm::vec2 high_{-1e9F};
};

bool is_equal(const ImDrawVert& a, const ImDrawVert& b) {
    return a.pos.x == b.pos.x && a.pos.y == b.pos.y && a.uv.x == b.uv.x && a.uv.y == b.uv.y &&
           a.col == b.col;
}

bool has_same_corners(const ImVec4& a, const ImVec4& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
}

// Vertices are in the order of drawing: without the equal ones at the beginning and at the end,
// those that differ are left.
void add_difference(Vertices before, Vertices now, Bounds& bounds) {
    const auto [first_before, first_now] =
        std::mismatch(before.begin(), before.end(), now.begin(), now.end(), is_equal);
    before = {first_before, before.end()};
    now = {first_now, now.end()};
    const auto [last_before, last_now] =
        std::mismatch(before.rbegin(), before.rend(), now.rbegin(), now.rend(), is_equal);
    bounds.add({before.begin(), last_before.base()});
    bounds.add({now.begin(), last_now.base()});
}

bool is_equal(const ImDrawCmd& a, const ImDrawCmd& b) {
    return has_same_corners(a.ClipRect, b.ClipRect) && a.TextureId == b.TextureId &&
           a.UserCallback == b.UserCallback;
}

template <class T> std::span<const T> all_of(const ImVector<T>& values) {
    return {values.Data, static_cast<std::size_t>(values.Size)};
}

std::span<ImDrawList* const> lists_of(const ImDrawData& data) {
    return {data.CmdLists, static_cast<std::size_t>(data.CmdListsCount)};
}

glm::ivec2 size_of(const ImDrawData& data) {
    return {static_cast<int>(data.DisplaySize.x), static_cast<int>(data.DisplaySize.y)};
}

std::string panel_of(const ImDrawList& list) {
    return list._OwnerName == nullptr ? std::string() : list._OwnerName;
}

} // namespace

std::vector<PixelArea> PanelChanges::update(const ImDrawData& data) {
    const auto lists = lists_of(data);
    const glm::ivec2 size = size_of(data);
    bool is_new = size != size_ || lists.size() != lists_.size();
    lists_.resize(lists.size());
    std::vector<PixelArea> areas;
    for (std::size_t i = 0; i < lists.size(); ++i) {
        const ImDrawList& list = *lists[i];
        List& last = lists_[i];
        const Vertices vertices = all_of(list.VtxBuffer);
        const auto commands = all_of(list.CmdBuffer);
        is_new = is_new || last.panel != panel_of(list);
        const bool is_clipped_alike =
            std::ranges::equal(last.commands, commands, [](const ImDrawCmd& a, const ImDrawCmd& b) {
                return is_equal(a, b);
            });
        Bounds bounds;
        if (is_clipped_alike) {
            add_difference(last.vertices, vertices, bounds);
        } else {
            bounds.add(last.vertices);
            bounds.add(vertices);
        }
        if (const PixelArea area = bounds.within(size); !area.is_empty()) {
            areas.push_back(area);
        }
        last = {
            panel_of(list), {vertices.begin(), vertices.end()}, {commands.begin(), commands.end()}};
    }
    size_ = size;
    return is_new ? std::vector<PixelArea>{{{0, 0}, size}} : disjoint(std::move(areas));
}

} // namespace reljef::app

#include "app/viewer/panels/toolkit/panel_changes.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>

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
    return std::memcmp(&a, &b, sizeof(ImDrawVert)) == 0;
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
    return std::memcmp(&a.ClipRect, &b.ClipRect, sizeof a.ClipRect) == 0 &&
           a.TextureId == b.TextureId && a.UserCallback == b.UserCallback;
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

// The low corner in xy, the high one in zw.
bool touches(std::span<const ImDrawIdx, 3> triangle, const ImDrawVert* vertices,
             const ImVec4& area) {
    glm::vec2 low(1e9F);
    glm::vec2 high(-1e9F);
    for (const ImDrawIdx index : triangle) {
        const ImVec2 place = vertices[index].pos;
        low = glm::min(low, glm::vec2(place.x, place.y));
        high = glm::max(high, glm::vec2(place.x, place.y));
    }
    return low.x < area.z && high.x > area.x && low.y < area.w && high.y > area.y;
}

void clip(ImDrawList& list, ImDrawCmd& command, const ImVec4& area) {
    ImVec4& rectangle = command.ClipRect;
    rectangle = {std::max(rectangle.x, area.x), std::max(rectangle.y, area.y),
                 std::min(rectangle.z, area.z), std::min(rectangle.w, area.w)};
    if (rectangle.x >= rectangle.z || rectangle.y >= rectangle.w) {
        command.ElemCount = 0;
        return;
    }
    const ImDrawVert* const vertices = list.VtxBuffer.Data + command.VtxOffset;
    ImDrawIdx* const first = list.IdxBuffer.Data + command.IdxOffset;
    ImDrawIdx* end = first;
    constexpr std::size_t corners = 3;
    for (std::size_t i = 0; i + corners <= command.ElemCount; i += corners) {
        if (touches(std::span<const ImDrawIdx, 3>(first + i, corners), vertices, rectangle)) {
            end = std::copy_n(first + i, corners, end);
        }
    }
    command.ElemCount = static_cast<unsigned int>(end - first);
}

} // namespace

PixelArea PanelChanges::update(const ImDrawData& data) {
    const auto lists = lists_of(data);
    const glm::ivec2 size = size_of(data);
    bool is_new = size != size_ || lists.size() != lists_.size();
    lists_.resize(lists.size());
    Bounds bounds;
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
        if (is_clipped_alike) {
            add_difference(last.vertices, vertices, bounds);
        } else {
            bounds.add(last.vertices);
            bounds.add(vertices);
        }
        last = {
            panel_of(list), {vertices.begin(), vertices.end()}, {commands.begin(), commands.end()}};
    }
    size_ = size;
    return is_new ? PixelArea{{0, 0}, size} : bounds.within(size);
}

void clip(ImDrawData& data, const PixelArea& area) {
    const glm::vec2 low(area.low);
    const glm::vec2 high(area.low + area.size);
    int kept = 0;
    for (ImDrawList* const list : lists_of(data)) {
        unsigned int triangles = 0;
        for (ImDrawCmd& command : list->CmdBuffer) {
            clip(*list, command, {low.x, low.y, high.x, high.y});
            triangles += command.ElemCount;
        }
        if (triangles > 0) {
            data.CmdLists[kept++] = list;
        }
    }
    data.CmdListsCount = kept;
}

} // namespace reljef::app

#include "engine/render/residency/block_buffers.h"

#include <string_view>
#include <utility>

#include "engine/render/residency/resident_mesh.h"

namespace reljef::render {

void BlockBuffers::begin_frame() {
    std::erase_if(buffers_, [](const auto& entry) { return !entry.second.in_use; });
    for (auto& [content, entry] : buffers_) {
        entry.in_use = false;
    }
}

Result<const gl::Buffer*> BlockBuffers::buffer(std::span<const std::byte> content,
                                               view::FrameStats& stats) {
    const std::string_view key(reinterpret_cast<const char*>(content.data()), content.size());
    const auto found = buffers_.find(key);
    if (found != buffers_.end()) {
        found->second.in_use = true;
        return &found->second.buffer;
    }
    auto made = gl::Buffer::create(content);
    if (!made) {
        return made.error();
    }
    count_upload(stats, content.size());
    return &buffers_.emplace(key, Entry{std::move(*made)}).first->second.buffer;
}

} // namespace reljef::render

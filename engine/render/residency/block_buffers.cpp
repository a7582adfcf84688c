#include "engine/render/residency/block_buffers.h"

#include <string_view>
#include <utility>

#include "engine/render/triangles/resident_mesh.h"

namespace reljef::render {

void BlockBuffers::begin_frame() {
    for (auto& [content, entry] : buffers_) {
        ++entry.unused_frames;
    }
    std::erase_if(buffers_,
                  [](const auto& entry) { return entry.second.unused_frames > kept_frames; });
}

Result<const gl::Buffer*> BlockBuffers::buffer(std::span<const std::byte> content,
                                               view::FrameStats& stats) {
    const std::string_view key(reinterpret_cast<const char*>(content.data()), content.size());
    const auto found = buffers_.find(key);
    if (found != buffers_.end()) {
        found->second.unused_frames = 0;
        return &found->second.buffer;
    }
    auto made = upload_buffer(content, stats);
    if (!made) {
        return made.error();
    }
    return &buffers_.emplace(key, Entry{std::move(*made)}).first->second.buffer;
}

} // namespace reljef::render

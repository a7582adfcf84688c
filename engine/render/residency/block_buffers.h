#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>

#include "engine/core/result.h"
#include "engine/gl/buffer.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// Immutable buffers by the content of uniform blocks. Writing to a buffer that draws still read
/// makes some drivers wait or copy.
class BlockBuffers {
public:
    /// Frames that a buffer survives unused, so that techniques that alternate find theirs again.
    static constexpr int kept_frames = 64;

    void begin_frame();

    /// The buffer with this content, valid for the frame. Fails without GL memory. Precondition:
    /// not empty.
    Result<const gl::Buffer*> buffer(std::span<const std::byte> content, view::FrameStats& stats);

    [[nodiscard]] std::size_t count() const { return buffers_.size(); }

private:
    struct Entry {
        gl::Buffer buffer;
        int unused_frames = 0;
    };
    std::map<std::string, Entry, std::less<>> buffers_; // by the bytes
};

} // namespace reljef::render

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

/// A buffer for each content of uniform blocks that frames ask for. None is ever rewritten: where
/// draws still read a buffer, some drivers would wait for them or copy it. Needs a current context;
/// destroy while it is current.
class BlockBuffers {
public:
    /// Frames that a buffer outlives without being asked for: techniques that take turns, as when
    /// they are measured, find theirs again.
    static constexpr int kept_frames = 64;

    /// Drops the buffers that no frame asked for in the last `kept_frames`.
    void begin_frame();

    /// The buffer that holds these bytes, made when first asked for. Valid for the frame. Fails
    /// when the driver has no memory. Precondition: not empty.
    Result<const gl::Buffer*> buffer(std::span<const std::byte> content, view::FrameStats& stats);

    [[nodiscard]] std::size_t count() const { return buffers_.size(); }

private:
    struct Entry {
        gl::Buffer buffer;
        int unused_frames = 0; // since a frame asked for it
    };
    std::map<std::string, Entry, std::less<>> buffers_; // by the bytes
};

} // namespace reljef::render

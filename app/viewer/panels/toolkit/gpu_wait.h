#pragma once

namespace reljef::app {

/// Waits until the current OpenGL context has drawn all that it was given.
void wait_for_gpu();

} // namespace reljef::app

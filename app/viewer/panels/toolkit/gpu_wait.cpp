#include "app/viewer/panels/toolkit/gpu_wait.h"

#include "engine/gl/fence.h"

namespace reljef::app {

void wait_for_gpu() {
    gl::Fence::after_commands().wait();
}

} // namespace reljef::app

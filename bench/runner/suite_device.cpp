#include "bench/runner/suite_device.h"

namespace reljef::bench {

Result<session::Device> make_device(const SuiteOptions& options) {
    return session::Device::create({.context = options.context,
                                    .size = options.size,
                                    .shader_dir = options.shader_dir,
                                    .threads = options.threads,
                                    .selects_always = true});
}

} // namespace reljef::bench

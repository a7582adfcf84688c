#include <algorithm>
#include <cstdlib>

#include "app/cli/parsed_option.h"
#include "bench/report/results.h"
#include "engine/core/parallel_for.h"
#include "engine/platform/context.h"
#include "engine/platform/processor.h"

namespace reljef::bench {
namespace {

unsigned renderer_threads(int requested) {
    if (requested > 0) {
        return static_cast<unsigned>(requested);
    }
    const char* variable = std::getenv("LP_NUM_THREADS");
    const auto limit = cli::number_from<unsigned>(variable == nullptr ? "" : variable);
    return limit ? std::max(*limit, 1U) : thread_count(0);
}

} // namespace

Environment environment_of(const platform::RendererInfo& info, int threads) {
    return {info.renderer,
            info.version,
            info.context,
            renderer_threads(threads),
            platform::processor_name(),
            RELJEF_COMMIT,
            {}};
}

bool Environment::has_gpu() const {
    return (context == "egl" || context == "glfw") && !platform::is_software_renderer(renderer);
}

} // namespace reljef::bench

#include "bench/report/environment.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <string_view>

#include "engine/core/parallel_for.h"

namespace reljef::bench {
namespace {

std::string cpu_name() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);) {
        const auto colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) {
            return line.substr(colon + 2);
        }
    }
    return "unknown";
}

unsigned renderer_threads(int requested) {
    if (requested > 0) {
        return static_cast<unsigned>(requested);
    }
    const char* variable = std::getenv("LP_NUM_THREADS");
    const std::string_view text = variable == nullptr ? "" : variable;
    unsigned threads = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), threads);
    const bool is_number = code == std::errc{} && end == text.data() + text.size();
    return is_number ? std::max(threads, 1U) : thread_count(0);
}

} // namespace

Environment environment_of(const platform::Context& context, int threads) {
    return {context.renderer(),
            context.version(),
            std::string(platform::to_string(context.kind())),
            renderer_threads(threads),
            cpu_name(),
            RELJEF_COMMIT};
}

} // namespace reljef::bench

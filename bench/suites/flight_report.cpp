#include <cstdio>

#include <fmt/format.h>

#include "app/cli/message.h"
#include "bench/report/environment_json.h"
#include "bench/suites/flight_suite.h"
#include "engine/core/atomic_file.h"
#include "engine/core/statistics.h"
#include "engine/session/terrain_source.h"

namespace reljef::bench {
namespace {

using FlightJson = nlohmann::ordered_json;

FlightJson times_json(std::span<const double> times) {
    const Summary summary = summarize(times);
    return {{"median", summary.median}, {"p95", summary.p95}, {"p99", summary.p99}};
}

FlightJson stream_json(const scene::TileStreamStats& stats) {
    return {{"read", stats.read},
            {"failed", stats.failed},
            {"cancelled", stats.cancelled},
            {"evicted", stats.evicted},
            {"bytes_read", stats.bytes_read},
            {"most_bytes", stats.max_bytes}};
}

double megabytes(std::size_t bytes) {
    return static_cast<double>(bytes) * 1e-6;
}

std::string stream_line(const scene::TileStreamStats& stats) {
    return fmt::format("tiles: {} read ({:.1f} MB of files), {} failed, {} cancelled, {} evicted, "
                       "at most {:.1f} MB\n",
                       stats.read, megabytes(stats.bytes_read), stats.failed, stats.cancelled,
                       stats.evicted, megabytes(stats.max_bytes));
}

std::string flight_table(const FlightResults& results) {
    const Summary drawing = summarize(results.times.drawing_ms);
    const Summary waiting = summarize(results.times.waiting_ms);
    return fmt::format("{}, {}x{}, {}, {} threads\n"
                       "frames: {} in {:.1f} s, the first after {:.2f} s\n"
                       "drawing: median {:.2f} ms, p95 {:.2f}, p99 {:.2f}\n"
                       "waiting for tiles: median {:.2f} ms, p95 {:.2f}, p99 {:.2f}\n"
                       "{}memory: {:.1f} MB at most, {:.1f} MB before the terrain was read: {:.0f} "
                       "% of the {} MiB "
                       "allowed\n",
                       cli::printable(results.options.terrain.terrain), results.options.view.size.x,
                       results.options.view.size.y, cli::printable(results.environment.renderer),
                       results.environment.threads, results.times.drawing_ms.size(),
                       results.seconds, results.seconds_to_first_frame, drawing.median, drawing.p95,
                       drawing.p99, waiting.median, waiting.p95, waiting.p99,
                       results.stream ? stream_line(*results.stream) : "",
                       megabytes(results.max_memory), megabytes(results.times.memory_before),
                       100.0 * memory_share(results), results.options.terrain.memory_megabytes);
}

} // namespace

std::string flight_json(const FlightResults& results) {
    const FlightOptions& options = results.options;
    const FlightJson report{
        {"schema", "reljef-bench-flight/1"},
        {"complete", !results.stopped.has_value()},
        {"environment", environment_json(results.environment)},
        {"terrain", options.terrain.terrain},
        {"path", options.view.path},
        {"size", fmt::format("{}x{}", options.view.size.x, options.view.size.y)},
        {"frames", results.times.drawing_ms.size()},
        {"seconds", results.seconds},
        {"seconds_to_first_frame", results.seconds_to_first_frame},
        {"drawing_ms", times_json(results.times.drawing_ms)},
        {"waiting_ms", times_json(results.times.waiting_ms)},
        {"tiles", results.stream ? stream_json(*results.stream) : FlightJson()},
        {"faulty_files", results.failed_files},
        {"memory",
         {{"allowed", static_cast<std::size_t>(options.terrain.memory_megabytes) << 20U},
          {"before", results.times.memory_before},
          {"most", results.max_memory},
          {"share_of_allowed", memory_share(results)}}}};
    // File names need not be UTF-8.
    return report.dump(2, ' ', false, FlightJson::error_handler_t::replace) + "\n";
}

Result<void> report(const FlightResults& results, const std::filesystem::path& json) {
    if (results.times.drawing_ms.empty()) {
        return results.stopped.value_or(Error{"no frames found, some were expected"});
    }
    Result<void> written;
    if (!json.empty()) {
        written = write_text_file(json, flight_json(results));
    }
    fmt::print("{}", flight_table(results));
    if (std::fflush(stdout) != 0 || !written) {
        return written;
    }
    return results.stopped
               ? Result<void>(*results.stopped)
               : session::report_errors(results.options.terrain.terrain, results.failed_files);
}

} // namespace reljef::bench

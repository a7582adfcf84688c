#include "bench/baselines/methods_suite.h"

#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cli/message.h"
#include "app/cli/progress_line.h"
#include "bench/baselines/peer_scene.h"
#include "engine/core/atomic_file.h"

namespace reljef::bench {
namespace {

using MethodsJson = nlohmann::ordered_json;

Result<void> add_rows(const MethodsOptions& options, const std::string& terrain,
                      const std::stop_token& stop, MethodsResults& results) {
    const auto scene = open_peer_scene({terrain, options.suite.threads, options.suite.quiet}, stop);
    if (!scene) {
        return scene.error();
    }
    const terrain::Heightfield& heightfield = scene->surface().heightfield();
    for (const double part : options.errors) {
        const double error = part * (heightfield.range.high - heightfield.range.low);
        if (error <= 0.0) {
            return Error{fmt::format("{}: all heights are {} m, different ones were expected",
                                     terrain, heightfield.range.low)};
        }
        for (const TriangleMethod method : all_triangle_methods) {
            if (stop.stop_requested()) {
                return Error{"interrupted, the table holds what was counted until then"};
            }
            results.rows.push_back({terrain, heightfield.heights.cols(), method, error,
                                    triangulate_by(method, heightfield.heights, error)});
        }
    }
    return {};
}

MethodsJson row_json(const MethodRow& row) {
    return {{"terrain", row.terrain},
            {"side", row.side},
            {"method", to_string(row.method)},
            {"error_m", row.error},
            {"triangles", row.result.triangles},
            {"worst_m", row.result.worst}};
}

} // namespace

MethodsResults run_methods(const MethodsOptions& options, const std::stop_token& stop) {
    MethodsResults results;
    cli::ProgressLine line("counting triangles", options.suite.quiet);
    for (std::size_t i = 0; i < options.terrains.size() && !results.stopped; ++i) {
        line.update(static_cast<double>(i) / static_cast<double>(options.terrains.size()));
        if (auto done = add_rows(options, options.terrains[i], stop, results); !done) {
            results.stopped = done.error();
            results.failed = !stop.stop_requested();
        }
    }
    return results;
}

std::string methods_table(const MethodsResults& results) {
    std::string text = fmt::format("{:<24} {:>5} {:>9} {:<10} {:>10} {:>9} {:>7}\n", "terrain",
                                   "side", "error m", "method", "triangles", "worst m", "x error");
    for (const MethodRow& row : results.rows) {
        text += fmt::format("{:<24} {:>5} {:>9.3f} {:<10} {:>10} {:>9.3f} {:>7.2f}\n",
                            cli::printable(row.terrain), row.side, row.error, to_string(row.method),
                            row.result.triangles, row.result.worst, row.result.worst / row.error);
    }
    return text;
}

std::string methods_json(const MethodsResults& results) {
    MethodsJson json{
        {"schema", "reljef-bench-methods/1"},
        {"complete", !results.stopped.has_value()},
        {"stopped", results.stopped ? MethodsJson(results.stopped->message) : MethodsJson()},
        {"rows", MethodsJson::array()}};
    for (const MethodRow& row : results.rows) {
        json["rows"].push_back(row_json(row));
    }
    // File names need not be UTF-8.
    return json.dump(2, ' ', false, MethodsJson::error_handler_t::replace) + "\n";
}

Result<void> report(const MethodsResults& results, const std::filesystem::path& json) {
    if (results.rows.empty()) {
        return results.stopped.value_or(Error{"no rows found, some were expected"});
    }
    Result<void> written;
    if (!results.failed && !json.empty()) {
        written = write_text_file(json, methods_json(results));
    }
    fmt::print("{}", methods_table(results));
    if (std::fflush(stdout) != 0 || !written) {
        return written;
    }
    return results.stopped ? Result<void>(*results.stopped) : Result<void>();
}

} // namespace reljef::bench

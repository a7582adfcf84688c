#include <charconv>
#include <filesystem>

#include <fmt/format.h>

#include "bench/report/json_object.h"
#include "bench/report/report_json.h"
#include "engine/core/atomic_file.h"

namespace reljef::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t largest_file = std::size_t{1} << 25;
// Of times, rates and ratios: a picosecond to eleven days, in milliseconds. Products and quotients
// of three of them are still numbers.
constexpr JsonRange figure_range{.low = 1e-9, .high = 1e9};
constexpr JsonRange share{.low = 0.0, .high = 1.0};

Result<nlohmann::json> parse(const std::string& text, const std::string& file) {
    try {
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::parse_error& error) {
        return Error{error.byte > text.size()
                         ? fmt::format("{}: its end is missing after {} bytes, whole results of "
                                       "reljef-bench were expected",
                                       file, text.size())
                         : fmt::format("{}: no JSON found at byte {}, results of reljef-bench were "
                                       "expected",
                                       file, error.byte)};
    } catch (const nlohmann::json::out_of_range&) {
        return Error{fmt::format("{}: a number beyond all range found, results of reljef-bench "
                                 "were expected",
                                 file)};
    }
}

Environment read_environment(const JsonObject& json) {
    return {json.text("renderer"), json.text("gl"),
            json.text("context"),  static_cast<unsigned>(json.whole("threads")),
            json.text("cpu"),      json.text("commit")};
}

// From "1024x768".
glm::ivec2 read_size(const JsonObject& json) {
    const std::string text = json.text("size");
    glm::ivec2 size{0};
    const char* const end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, size.x);
    const bool has_separator = width.ec == std::errc{} && width.ptr != end && *width.ptr == 'x';
    const auto height = std::from_chars(width.ptr + (has_separator ? 1 : 0), end, size.y);
    const bool is_whole = has_separator && height.ec == std::errc{} && height.ptr == end;
    if (!is_whole || size.x < 1 || size.y < 1) {
        json.fail("size", "WIDTHxHEIGHT");
    }
    return size;
}

scene::Pose read_pose(const JsonObject& json) {
    const auto pose = scene::pose_from_string(json.text("pose"));
    if (!pose) {
        json.fail("pose", "a standard pose");
    }
    return pose.value_or(scene::Pose::overview);
}

Setting read_setting(const JsonObject& json) {
    Setting setting{json.text("technique"), {}, json.text("label")};
    const JsonObject parameters = json.object("params");
    for (const std::string& key : parameters.keys()) {
        const JsonRange any{.low = std::numeric_limits<double>::lowest()};
        setting.parameters.push_back({key, parameters.number(key, any)});
    }
    return setting;
}

view::FrameStats::Skipped read_skipped(const JsonObject& json) {
    view::FrameStats::Skipped skipped;
    skipped.invisible_nodes = json.whole("invisible_nodes");
    skipped.nodes_outside_frustum = json.whole("nodes_outside_frustum");
    skipped.tiles_outside_frustum = json.whole("tiles_outside_frustum");
    skipped.triangles_outside_frustum = json.count("triangles_outside_frustum");
    if (json.has("triangles_under_error")) { // older reports have none
        skipped.triangles_under_error = json.count("triangles_under_error");
        skipped.cuts_unchanged = json.whole("cuts_unchanged");
    }
    skipped.selections_unchanged =
        json.has("selections_unchanged") ? json.whole("selections_unchanged") : 0;
    skipped.tiles_occluded = json.has("tiles_occluded") ? json.whole("tiles_occluded") : 0;
    skipped.uploads_unchanged = json.whole("uploads_unchanged");
    skipped.sky = json.whole("sky");
    return skipped;
}

bool is_there(const JsonObject& json, std::string_view key) {
    return json.has(key) && !json.is_null(key);
}

std::optional<ConfidenceInterval> read_interval(const JsonObject& ms) {
    if (ms.is_null("interval")) {
        return std::nullopt;
    }
    const std::vector<double> ends = ms.numbers("interval", 2);
    if (ends[0] > ends[1] || ends[0] < figure_range.low || ends[1] > figure_range.high) {
        ms.fail("interval", fmt::format("two numbers from {} to {}, the lower one first",
                                        figure_range.low, figure_range.high));
    }
    return ConfidenceInterval{ends[0], ends[1]};
}

Timing read_timing(const JsonObject& json) {
    const JsonObject ms = json.object("ms");
    Timing timing;
    timing.frames = json.count("frames", 1);
    timing.ms = {ms.number("median", figure_range), ms.number("p95", figure_range),
                 ms.number("p99", figure_range)};
    timing.interval = read_interval(ms);
    timing.fps_1_percent_low = json.number("fps_1_percent_low", figure_range);
    timing.ratio_to_texture = json.number_or_null("ratio_to_texture", figure_range);
    timing.noise_floor = json.number_or_null("noise_floor");
    if (is_there(json, "gpu_ms")) {
        timing.gpu_ms = json.number("gpu_ms", {0.0, figure_range.high});
    }
    timing.stats.tiles = json.whole("tiles");
    timing.stats.triangles = json.count("triangles");
    timing.stats.draws = json.whole("draws");
    timing.stats.uploads = json.whole("uploads");
    timing.stats.skipped = read_skipped(json.object("skipped"));
    return timing;
}

std::optional<RowError::Geometric> read_geometric(const JsonObject& json, std::string_view key) {
    if (json.is_null(key)) {
        return std::nullopt;
    }
    const JsonObject error = json.object(key);
    return RowError::Geometric{{.count = error.count("count", 1),
                                .median = error.number("median"),
                                .p95 = error.number("p95"),
                                .p99 = error.number("p99"),
                                .max = error.number("max"),
                                .rms = error.number("rms")},
                               error.count("unbounded")};
}

RowError read_error(const JsonObject& json) {
    return {.reprojection_px = read_geometric(json, "reprojection_px"),
            .hit_texels = read_geometric(json, "hit_texels"),
            .wrong_percent = json.number("wrong_percent", {0.0, 100.0}),
            .holes = json.count("holes"),
            .rmse = json.number("rmse", share),
            .psnr = json.number_or_null("psnr"),
            .ssim = json.number_or_null("ssim", {-1.0, 1.0}),
            .flip = json.number("flip", share)};
}

Row read_row(const JsonObject& json) {
    Row row;
    row.suite = json.text("suite");
    row.test = is_there(json, "test") ? json.text("test") : "";
    row.scene = json.text("scene");
    row.pose = read_pose(json);
    row.setting = read_setting(json);
    row.null_row = json.flag("null_row");
    row.size = read_size(json);
    if (!json.flag("missing")) {
        row.timing = read_timing(json);
    }
    if (is_there(json, "error")) {
        row.error = read_error(json.object("error"));
    }
    if (is_there(json, "source")) {
        const JsonObject source = json.object("source");
        row.source = SourceFigure{source.number("fps", figure_range),
                                  source.number("ratio", figure_range), source.text("where")};
    }
    return row;
}

Front read_front(const JsonObject& json) {
    Front front;
    front.scene = json.text("scene");
    front.pose = read_pose(json);
    front.area = json.number_or_null("area", share);
    front.front = json.texts("front");
    json.each("dominated", [&](const JsonObject& setting) {
        front.dominated.push_back({setting.text("label"), setting.text("by")});
    });
    if (json.has("holed")) {
        front.holed = json.texts("holed");
    }
    return front;
}

LeftOut read_left_out(const JsonObject& json) {
    return {json.text("scene"), read_pose(json), json.count("settings", 1),
            json.texts("techniques")};
}

// What is told of the run itself. Keys that the first results of this schema did not have may be
// absent.
Results read_run(const JsonObject& json, const std::string& file) {
    const bool is_complete = json.flag("complete");
    Results results;
    results.environment = read_environment(json.object("environment"));
    if (json.has("notes")) {
        results.notes = json.texts("notes");
    }
    if (json.has("left_out")) {
        json.each("left_out", [&](const JsonObject& group) {
            results.left_out.push_back(read_left_out(group));
        });
    }
    if (is_there(json, "stopped")) {
        results.stopped = Error{json.text("stopped")};
    } else if (!is_complete && results.left_out.empty()) {
        results.stopped = Error{fmt::format("{}: the run ended early", file)};
    }
    return results;
}

void check_schema(const JsonObject& json) {
    if (json.text("schema") != schema_name) {
        json.fail("schema", fmt::format("\"{}\"", schema_name));
    }
}

Results read_results(const JsonObject& json, const std::string& file) {
    check_schema(json);
    Results results = read_run(json, file);
    json.each("rows", [&](const JsonObject& row) { results.rows.push_back(read_row(row)); });
    if (json.has("fronts")) {
        json.each("fronts",
                  [&](const JsonObject& front) { results.fronts.push_back(read_front(front)); });
    }
    return results;
}

} // namespace

Result<Results> read_json_report(const std::filesystem::path& file) {
    std::error_code ignored;
    if (fs::exists(file, ignored) && !fs::is_directory(file, ignored) &&
        !fs::is_regular_file(file, ignored)) { // which may never end
        return Error{fmt::format("{}: is a device, a file was expected", file.string())};
    }
    const auto text = read_text_file(file, largest_file);
    if (!text) {
        return text.error();
    }
    const auto json = parse(*text, file.string());
    if (!json) {
        return json.error();
    }
    JsonFault fault(file.string());
    Results results = read_results(JsonObject(*json, "", fault), file.string());
    if (fault.error()) {
        return *fault.error();
    }
    return results;
}

} // namespace reljef::bench

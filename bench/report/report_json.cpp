#include "bench/report/report_json.h"

#include <filesystem>

#include <fmt/format.h>

#include "app/cli/shard_option.h"
#include "bench/report/json_fields.h"
#include "engine/core/atomic_file.h"

namespace reljef::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_file_bytes = std::size_t{1} << 25;
// Of times (a picosecond to eleven days, in ms), rates and ratios: products and quotients of three
// figures stay finite.
constexpr JsonRange figure_range{.low = 1e-9, .high = 1e9};
constexpr JsonRange share{.low = 0.0, .high = 1.0};

} // namespace

// Each describe() lists the fields of one struct for JsonWriter and JsonReader, which find it by
// argument-dependent lookup.
template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<Environment>& environment) {
    fields.field("renderer", environment.renderer);
    fields.field("gl", environment.gl);
    fields.field("context", environment.context);
    fields.field("threads", environment.threads);
    fields.field("cpu", environment.cpu);
    fields.field("commit", environment.commit);
    fields.later_field("costs", environment.costs);
}

template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<RunSettings>& settings) {
    fields.field("quick", settings.quick);
    fields.field("rounds", settings.rounds);
    fields.field("moving", settings.moving);
    fields.field("cold", settings.cold);
}

template <class Fields>
static void describe(Fields& fields,
                     typename Fields::template Of<view::FrameStats::Skipped>& skipped) {
    fields.field("invisible_nodes", skipped.invisible_nodes);
    fields.field("nodes_outside_frustum", skipped.nodes_outside_frustum);
    fields.field("tiles_outside_frustum", skipped.tiles_outside_frustum);
    fields.later_field("tiles_occluded", skipped.tiles_occluded);
    fields.field("triangles_outside_frustum", skipped.triangles_outside_frustum);
    fields.later_field("triangles_under_error", skipped.triangles_under_error);
    fields.later_field("selections_unchanged", skipped.selections_unchanged);
    fields.later_field("cuts_unchanged", skipped.cuts_unchanged);
    fields.field("uploads_unchanged", skipped.uploads_unchanged);
    fields.field("sky", skipped.sky);
}

template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<view::TypicalChoice>& typical) {
    fields.field("technique", typical.technique);
    fields.field("share", typical.share, share);
}

template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<view::Choice>& choice) {
    fields.field("tiles_as_triangles", choice.tiles_as_triangles);
    fields.field("tiles_by_rays", choice.tiles_by_rays);
    fields.field("ray_pixels", choice.ray_pixels, share);
    fields.field("estimated_ms", choice.estimated_ms);
    fields.field("triangles_ms", choice.triangles_ms);
    fields.field("rays_ms", choice.rays_ms);
    fields.object("typical", choice.typical);
}

template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<Timing>& timing) {
    fields.field("frames", timing.frames, std::size_t{1});
    fields.object("ms", [&](auto& ms) {
        ms.field("median", timing.ms.median, figure_range);
        ms.field("p95", timing.ms.p95, figure_range);
        ms.field("p99", timing.ms.p99, figure_range);
        ms.field("interval", timing.interval, figure_range);
    });
    fields.derived("fps", 1000.0 / timing.ms.median);
    fields.field("fps_1_percent_low", timing.fps_1_percent_low, figure_range);
    fields.field("ratio_to_texture", timing.ratio_to_texture, figure_range);
    fields.field("noise_floor", timing.noise_floor);
    fields.later_field("gpu_ms", timing.gpu_ms);
    fields.field("tiles", timing.stats.tiles);
    fields.field("triangles", timing.stats.triangles);
    fields.later_field("slivers", timing.stats.slivers);
    fields.field("draws", timing.stats.draws);
    fields.field("uploads", timing.stats.uploads);
    fields.later_field("bytes_uploaded", timing.stats.upload_bytes);
    fields.later_field("state_changes", timing.stats.state_changes);
    fields.later_field("kept_error_px", timing.stats.kept_error);
    fields.later_field("tiles_unproven", timing.stats.tiles_unproven);
    fields.object("choice", timing.stats.choice);
}

template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<RowError::Geometric>& error) {
    fields.field("median", error.distribution.median);
    fields.field("p95", error.distribution.p95);
    fields.field("p99", error.distribution.p99);
    fields.field("max", error.distribution.max);
    fields.field("rms", error.distribution.rms);
    fields.field("count", error.distribution.count, std::size_t{1});
    fields.field("unbounded", error.unbounded);
}

template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<RowError>& error) {
    fields.object("reprojection_px", error.reprojection_px);
    fields.object("hit_texels", error.hit_texels);
    fields.field("wrong_percent", error.wrong_percent, JsonRange{0.0, 100.0});
    fields.later_field("wrong_of_terrain_percent", error.wrong_of_terrain_percent);
    fields.field("holes", error.holes);
    fields.field("rmse", error.rmse, share);
    fields.field("psnr", error.psnr);
    fields.field("ssim", error.ssim, JsonRange{-1.0, 1.0});
    fields.field("flip", error.flip, share);
}

template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<SourceFigure>& source) {
    fields.field("fps", source.fps, figure_range);
    fields.field("ratio", source.ratio, figure_range);
    fields.field("where", source.where);
}

template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<Front::Dominated>& dominated) {
    fields.field("label", dominated.label);
    fields.field("by", dominated.by);
}

template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<Front>& front) {
    fields.field("scene", front.scene);
    fields.field("pose", front.pose);
    fields.field("area", front.area, share);
    fields.field("front", front.front);
    fields.array("dominated", front.dominated);
    fields.later_field("holed", front.holed);
}

template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<LeftOut>& left_out) {
    fields.field("scene", left_out.scene);
    fields.field("pose", left_out.pose);
    fields.field("settings", left_out.settings, std::size_t{1});
    fields.field("techniques", left_out.techniques);
}

template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<view::WorkTotals>& work) {
    fields.field("taps", work.taps);
    fields.field("steps", work.steps);
    fields.field("rays", work.rays);
}

template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<RowSkip::Savings>& saved) {
    constexpr JsonRange any{.low = -1e15, .high = 1e15};
    fields.field("ms", saved.ms, any);
    fields.field("taps", saved.taps, any);
    fields.field("steps", saved.steps, any);
    fields.field("rays", saved.rays, any);
    fields.field("triangles", saved.triangles, any);
    fields.field("bytes_uploaded", saved.bytes_uploaded, any);
    fields.field("bytes_read", saved.bytes_read, any);
    fields.field("state_changes", saved.state_changes, any);
}

template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<RowSkip::Difference>& found) {
    fields.field("pixels", found.pixels);
    fields.field("levels", found.levels);
    fields.field("hits", found.hits);
    fields.field("edges", found.edges);
    fields.field("max_px", found.max_px);
    fields.field("tolerance_px", found.tolerance_px);
    fields.field("tolerance_levels", found.tolerance_levels);
}

template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<RowSkip>& skip) {
    fields.field("without", skip.without);
    fields.field("meaning", skip.meaning);
    fields.later_field("bytes_read", skip.bytes_read);
    fields.object("difference", [&](auto& inner) { describe(inner, skip.difference); });
    fields.object("saved", [&](auto& inner) { describe(inner, skip.saved); });
}

template <class Fields>
static void describe(Fields& fields, typename Fields::template Of<RowObjects>& objects) {
    fields.field("form", objects.form);
    fields.field("buildings", objects.buildings);
    fields.field("distance", objects.distance, figure_range);
    fields.field("down", objects.down, JsonRange{-90.0, 90.0});
    fields.field("bytes", objects.bytes);
}

template <class Fields>
static void describe_setting(Fields& fields, typename Fields::template Of<Row>& row) {
    fields.field("scene", row.scene);
    fields.field("pose", row.pose);
    fields.field("technique", row.setting.technique);
    fields.field("params", row.setting.parameters);
    fields.field("label", row.setting.label);
    fields.field("null_row", row.null_row);
}

static void describe(JsonWriter& fields, const Row& row) {
    fields.field("suite", row.suite);
    fields.field("test", row.test);
    if (row.test.empty()) {
        fields.json["test"] = nullptr;
    }
    describe_setting(fields, row);
    fields.field("missing", false);
    fields.field("noisy", row.noisy());
    fields.field("size", row.size);
    describe(fields, row.timing);
    fields.field("taps", row.taps());
    fields.object("work", row.work);
    fields.object("error", row.error);
    fields.object("source", row.source);
    fields.object("skipped", [&](auto& inner) { describe(inner, row.timing.stats.skipped); });
    fields.object("skip", row.skip);
    fields.object("objects", row.objects);
}

static void describe(JsonReader& fields, Row& row) {
    fields.field("suite", row.suite);
    fields.later_field("test", row.test);
    describe_setting(fields, row);
    fields.field("size", row.size);
    bool is_missing = false;
    fields.field("missing", is_missing);
    if (is_missing) {
        return; // read_results removes the row
    }
    describe(fields, row.timing);
    fields.object("skipped", [&](auto& inner) { describe(inner, row.timing.stats.skipped); });
    fields.object("error", row.error);
    fields.object("source", row.source);
    fields.object("work", row.work);
    fields.object("skip", row.skip);
    fields.object("objects", row.objects);
}

namespace {

Shard read_shard(JsonReader& fields) {
    std::string text = cli::shard_text({});
    fields.later_field("shard", text);
    const auto shard = cli::parse_shard(text, [](const char*) { return nullptr; });
    if (!shard) {
        fields.fail("shard", "a part of a run like \"0/4\"");
    }
    return shard ? *shard : Shard();
}

std::optional<Error> read_stopped(JsonReader& document, bool is_complete) {
    if (!document.has("stopped")) {
        return is_complete ? std::nullopt : std::optional(Error{"the run ended early"});
    }
    Error stopped;
    document.field("stopped", stopped.message);
    return stopped;
}

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

} // namespace

nlohmann::ordered_json json_of(const Environment& environment) {
    JsonWriter fields;
    describe(fields, environment);
    return fields.json;
}

nlohmann::ordered_json json_of(const ReportHead& head) {
    JsonWriter fields;
    fields.field("schema", schema_name);
    fields.field("suite", head.suite);
    fields.field("complete", head.complete);
    fields.json["stopped"] = nullptr;
    if (head.stopped) {
        fields.field("stopped", head.stopped->message);
    }
    fields.field("notes", head.notes);
    fields.json["environment"] = json_of(head.environment);
    if (!head.shard.is_whole()) {
        fields.field("shard", cli::shard_text(head.shard));
    }
    return fields.json;
}

// Files of earlier versions lack some keys.
ReportHead read_head(JsonReader& document) {
    ReportHead head;
    document.later_field("suite", head.suite);
    document.field("complete", head.complete);
    head.stopped = read_stopped(document, head.complete);
    document.later_field("notes", head.notes);
    document.object("environment", [&](auto& inner) { describe(inner, head.environment); });
    head.shard = read_shard(document);
    return head;
}

std::string json_report(const Results& results) {
    JsonWriter fields;
    fields.json = json_of(ReportHead{
        .suite = results.rows.empty() ? "" : results.rows.front().suite,
        .complete = results.complete(),
        .stopped = results.stopped,
        .notes = results.notes,
        .environment = results.environment,
        .shard = results.shard,
    });
    fields.array("left_out", results.left_out);
    fields.object("settings", results.settings);
    fields.array("rows", results.rows);
    if (!results.fronts.empty()) {
        fields.array("fronts", results.fronts);
    }
    // File names need not be UTF-8.
    return fields.json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

Result<nlohmann::json> read_result_json(const fs::path& file) {
    std::error_code ignored;
    if (fs::exists(file, ignored) && !fs::is_directory(file, ignored) &&
        !fs::is_regular_file(file, ignored)) { // a pipe may never end
        return Error{fmt::format("{}: is a device, a file was expected", file.string())};
    }
    const auto text = read_text_file(file, max_file_bytes);
    if (!text) {
        return text.error();
    }
    return parse(*text, file.string());
}

Result<void> read_report(const fs::path& file,
                         const std::function<void(JsonReader& document)>& read) {
    const auto json = read_result_json(file);
    if (!json) {
        return json.error();
    }
    std::optional<Error> error;
    JsonReader document(*json, "", error);
    std::string found;
    document.field("schema", found);
    if (found != schema_name) {
        document.fail("schema", fmt::format("\"{}\"", schema_name));
    }
    read(document);
    return error ? Result<void>(Error{fmt::format("{}: {}", file.string(), error->message)})
                 : Result<void>();
}

Results read_results(JsonReader& document) {
    Results results;
    ReportHead head = read_head(document);
    results.shard = head.shard;
    results.environment = std::move(head.environment);
    results.notes = std::move(head.notes);
    results.stopped = std::move(head.stopped);
    if (document.has("left_out")) {
        document.array("left_out", results.left_out);
    }
    if (results.stopped && !document.has("stopped") && !results.left_out.empty()) {
        results.stopped.reset(); // it is not complete because it left settings out
    }
    document.object("settings", results.settings);
    document.array("rows", results.rows);
    std::erase_if(results.rows, [](const Row& row) { return row.timing.frames == 0; });
    if (document.has("fronts")) {
        document.array("fronts", results.fronts);
    }
    return results;
}

Result<Results> read_json_report(const fs::path& file) {
    Results results;
    const auto done = read_report(file, [&](JsonReader& document) {
        if (document.has("columns")) {
            document.fail("suite", "a suite of techniques");
            return;
        }
        results = read_results(document);
    });
    return done ? Result<Results>(std::move(results)) : done.error();
}

} // namespace reljef::bench

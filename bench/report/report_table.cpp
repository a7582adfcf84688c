#include "bench/report/report_table.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/message.h"
#include "bench/report/figure_table.h"
#include "bench/report/pareto_front.h"

namespace reljef::bench {
namespace {

constexpr const char* no_figure = "–";

bool is_same_table(const Row& a, const Row& b) {
    return a.suite == b.suite && a.test == b.test && a.scene == b.scene && a.pose == b.pose &&
           a.size == b.size;
}

// " of LABEL" if the null row does not repeat the first row.
std::string null_row_text(std::span<const Row> rows) {
    const auto null_row =
        std::find_if(rows.begin(), rows.end(), [](const Row& row) { return row.null_row; });
    return null_row == rows.end() || null_row->setting.label == rows.front().setting.label
               ? ""
               : fmt::format(" of {}", null_row->setting.label);
}

std::string heading_of(std::span<const Row> rows) {
    const Row& row = rows.front();
    const Timing& timing = row.timing;
    const std::string pose = row.objects ? fmt::format(", {} buildings", row.objects->buildings)
                                         : fmt::format(", {}", scene::to_string(row.pose));
    return fmt::format("{}{}{}, {}x{}, {} frame{}, noise floor{}{}",
                       row.test.empty() ? "" : row.test + ": ", row.scene, pose, row.size.x,
                       row.size.y, timing.frames, timing.frames == 1 ? "" : "s",
                       timing.noise_floor ? fmt::format("{} {:.1f} %", null_row_text(rows),
                                                        100.0 * *timing.noise_floor)
                                          : " unknown",
                       !row.noisy()           ? ""
                       : row.has_few_frames() ? ": NOISY, too few frames"
                                              : ": NOISY");
}

bool has_sources(std::span<const Row> rows) {
    return std::any_of(rows.begin(), rows.end(),
                       [](const Row& row) { return row.source.has_value(); });
}

// Tables of the suite lod also show triangles and the maximum error.
bool is_of_levels(std::span<const Row> rows) {
    return rows.front().suite == "lod";
}

std::vector<std::string> columns_of(bool with_sources, bool with_levels) {
    std::vector<std::string> columns{"technique", "ms", "±", "fps", "1 % low", "ratio", "drop"};
    if (with_sources) {
        columns.insert(columns.end(), {"source", "ratio"});
    }
    if (with_levels) {
        columns.insert(columns.end(), {"triangles", "most px"});
    }
    columns.insert(columns.end(), {"error px", "wrong"});
    return columns;
}

// At least three significant digits.
std::string figure(double value) {
    if (value >= 99.95) {
        return fmt::format("{:.0f}", value);
    }
    return value >= 9.995 ? fmt::format("{:.1f}", value)
                          : fmt::format("{:.{}f}", value, value >= 0.9995 ? 2 : 3);
}

std::string half_width_cell(const Timing& timing) {
    if (!timing.interval) {
        return no_figure;
    }
    const double half_width = 0.5 * (timing.interval->high - timing.interval->low);
    return fmt::format("{:.1f} %", 100.0 * half_width / timing.ms.median);
}

std::vector<std::string> time_cells(const Timing& timing) {
    const auto& ratio = timing.ratio_to_texture;
    return {figure(timing.ms.median),
            half_width_cell(timing),
            figure(1000.0 / timing.ms.median),
            figure(timing.fps_1_percent_low),
            ratio ? fmt::format("{:.2f}", *ratio) : no_figure,
            ratio ? fmt::format("{:.0f} %", 100.0 * (1.0 - 1.0 / *ratio)) : no_figure};
}

std::vector<std::string> source_cells(const Row& row) {
    return row.source ? std::vector<std::string>{figure(row.source->fps),
                                                 fmt::format("{:.2f}", row.source->ratio)}
                      : std::vector<std::string>(2, no_figure);
}

bool has_unbounded(const Row& row) {
    return row.error && row.error->reprojection_px && row.error->reprojection_px->unbounded > 0;
}

std::vector<std::string> level_cells(const Row& row) {
    const bool has_error = row.error && row.error->reprojection_px;
    return {fmt::format("{}", row.timing.stats.triangles),
            !has_error           ? std::string(no_figure)
            : has_unbounded(row) ? "∞"
                                 : figure(row.error->reprojection_px->distribution.max)};
}

std::vector<std::string> error_cells(const Row& row) {
    if (!row.error) {
        return std::vector<std::string>(2, no_figure);
    }
    const auto& error = row.error->reprojection_px;
    const std::string bound = has_unbounded(row) ? "≥" : "";
    return {error ? bound + figure(error->distribution.rms) : std::string(no_figure),
            fmt::format("{:.1f} %", row.error->wrong_percent)};
}

// The label; with the search that `auto` drew without a proof.
std::string technique_cell(const Row& row) {
    const auto& choice = row.timing.stats.choice;
    return choice && choice->typical
               ? fmt::format("{} (unproven: {})", row.setting.label, choice->typical->technique)
               : row.setting.label;
}

std::vector<std::string> cells_of(const Row& row, bool with_sources, bool with_levels) {
    std::vector<std::string> cells{technique_cell(row)};
    const auto append = [&](const std::vector<std::string>& more) {
        cells.insert(cells.end(), more.begin(), more.end());
    };
    append(time_cells(row.timing));
    if (with_sources) {
        append(source_cells(row));
    }
    if (with_levels) {
        append(level_cells(row));
    }
    append(error_cells(row));
    return cells;
}

// Tables of the suite skip show what each kind of skipping saves.
bool is_of_skips(std::span<const Row> rows) {
    return rows.front().skip.has_value();
}

std::vector<std::string> skip_columns() {
    return {"without", "ms",   "±",         "saves",   "%",       "taps/px",
            "saves",   "rays", "triangles", "MB sent", "MB read", "picture"};
}

// Without savings in the row that skips everything.
std::string saved_cell(const RowSkip& skip, const std::optional<double>& saved, double unit,
                       int decimals) {
    return skip.without.empty() || !saved ? std::string(no_figure)
                                          : fmt::format("{:.{}f}", *saved / unit, decimals);
}

std::string same_cell(const RowSkip& skip) {
    const RowSkip::Difference& found = skip.difference;
    if (found.is_same()) {
        return "same bits";
    }
    if (!found.is_allowed()) {
        return "ANOTHER";
    }
    return found.hits > 0 ? fmt::format("rounded: {:.1g} px", found.max_px)
                          : fmt::format("rounded: {} of 255", found.levels);
}

std::vector<std::string> skip_cells(const Row& row) {
    constexpr double megabyte = 1e6;
    const RowSkip& skip = *row.skip;
    const RowSkip::Savings& saved = skip.saved;
    const double pixels = static_cast<double>(row.size.x) * row.size.y;
    const double all_ms = row.timing.ms.median - saved.ms.value_or(0.0);
    return {skip.without.empty() ? row.setting.label : skip.without,
            figure(row.timing.ms.median),
            half_width_cell(row.timing),
            saved_cell(skip, saved.ms, 1.0, 2),
            saved_cell(skip, saved.ms, all_ms / 100.0, 0),
            row.taps() ? fmt::format("{:.1f}", *row.taps()) : no_figure,
            saved_cell(skip, saved.taps, pixels, 1),
            saved_cell(skip, saved.rays, 1.0, 0),
            saved_cell(skip, saved.triangles, 1.0, 0),
            saved_cell(skip, saved.bytes_uploaded, megabyte, 2),
            saved_cell(skip, saved.bytes_read, megabyte, 2),
            same_cell(skip)};
}

ReportTable skip_table(std::span<const Row> rows) {
    ReportTable table{heading_of(rows), skip_columns(), {}, {}};
    for (const Row& row : rows) {
        if (!row.null_row) {
            table.lines.push_back(skip_cells(row));
        }
    }
    return table;
}

std::vector<std::string> objects_columns() {
    return {"form and technique", "ms", "±", "ratio", "triangles", "MB", "off", "wrong", "FLIP"};
}

std::string off_cell(const Row& row) {
    return row.error && row.error->hit_texels ? figure(row.error->hit_texels->distribution.rms)
                                              : no_figure;
}

std::vector<std::string> objects_cells(const Row& row) {
    constexpr double megabyte = 1e6;
    const auto& ratio = row.timing.ratio_to_texture;
    return {row.setting.label,
            figure(row.timing.ms.median),
            half_width_cell(row.timing),
            ratio ? fmt::format("{:.2f}", *ratio) : no_figure,
            fmt::format("{}", row.timing.stats.triangles),
            figure(static_cast<double>(row.objects->bytes) / megabyte),
            off_cell(row),
            row.error ? fmt::format("{:.1f} %", row.error->wrong_percent) : no_figure,
            row.error ? fmt::format("{:.3f}", row.error->flip) : no_figure};
}

ReportTable objects_table(std::span<const Row> rows) {
    ReportTable table{heading_of(rows), objects_columns(), {}, {}};
    for (const Row& row : rows) {
        if (!row.null_row) {
            table.lines.push_back(objects_cells(row));
        }
    }
    return table;
}

std::string unbounded_text(const Row& row) {
    return fmt::format("{} {}", row.setting.label, row.error->reprojection_px->unbounded);
}

// The errors of exact, whose colour map is filtered unlike that of the true picture.
std::string picture_floor(const Row& exact) {
    const RowError& error = *exact.error;
    return fmt::format(
        "floor of the pictures' errors, that of exact: FLIP {:.3f}, PSNR {}, SSIM {}", error.flip,
        error.psnr ? fmt::format("{:.1f} dB", *error.psnr) : "∞",
        error.ssim ? fmt::format("{:.3f}", *error.ssim) : no_figure);
}

std::vector<std::string> notes_of(std::span<const Row> rows) {
    std::vector<std::string> notes;
    const auto add_note = [&](std::string_view title, const auto& is_listed, const auto& text_of) {
        std::vector<std::string> texts;
        for (const Row& row : rows) {
            if (!row.null_row && is_listed(row)) {
                texts.push_back(text_of(row));
            }
        }
        if (!texts.empty()) {
            notes.push_back(fmt::format("{}: {}", title, fmt::join(texts, ", ")));
        }
    };
    add_note(
        "shows nothing of the terrain here, so its time says nothing",
        [](const Row& row) { return row.shows_nothing(); },
        [](const Row& row) { return row.setting.label; });
    add_note("≥, pixels whose error has no bound are not in it", has_unbounded, unbounded_text);
    const auto exact = std::find_if(rows.begin(), rows.end(), [](const Row& row) {
        return row.setting.technique == "exact" && row.error;
    });
    if (exact != rows.end()) {
        notes.push_back(picture_floor(*exact));
    }
    return notes;
}

ReportTable table_of_rows(std::span<const Row> rows) {
    if (is_of_skips(rows)) {
        return skip_table(rows);
    }
    if (rows.front().objects) {
        return objects_table(rows);
    }
    const bool with_sources = has_sources(rows);
    const bool with_levels = is_of_levels(rows);
    ReportTable table{heading_of(rows), columns_of(with_sources, with_levels), {}, notes_of(rows)};
    for (const Row& row : rows) {
        if (!row.null_row) {
            table.lines.push_back(cells_of(row, with_sources, with_levels));
        }
    }
    return table;
}

} // namespace

std::vector<ReportTable> report_tables(const Results& results) {
    std::vector<ReportTable> tables;
    const auto end = results.rows.end();
    for (auto begin = results.rows.begin(); begin != end;) {
        const auto next = std::find_if_not(
            begin, end, [&](const Row& row) { return is_same_table(row, *begin); });
        tables.push_back(table_of_rows(std::span(begin, next)));
        begin = next;
    }
    return tables;
}

Results printable(Results results) {
    const auto clean = [](std::string& text) { text = cli::printable(text); };
    const auto clean_all = [&](std::vector<std::string>& texts) {
        std::for_each(texts.begin(), texts.end(), clean);
    };
    Environment& environment = results.environment;
    for (std::string* text : {&environment.renderer, &environment.gl, &environment.context,
                              &environment.cpu, &environment.commit, &environment.costs}) {
        clean(*text);
    }
    for (Row& row : results.rows) {
        for (std::string* text : {&row.suite, &row.test, &row.scene, &row.setting.label}) {
            clean(*text);
        }
        if (row.skip) {
            clean(row.skip->without);
            clean(row.skip->meaning);
        }
        if (row.objects) {
            clean(row.objects->form);
        }
    }
    for (Front& front : results.fronts) {
        clean(front.scene);
        clean_all(front.front);
        clean_all(front.holed);
        for (Front::Dominated& setting : front.dominated) {
            clean(setting.label);
            clean(setting.by);
        }
    }
    clean_all(results.notes);
    if (results.stopped) {
        results.stopped->message = in_one_line(results.stopped->message);
        clean(results.stopped->message);
    }
    return results;
}

std::vector<std::string> environment_lines(const Results& results) {
    const Environment& environment = results.environment;
    std::vector<std::string> lines{
        fmt::format("renderer: {}", environment.renderer),
        fmt::format("OpenGL:   {}, context {}", environment.gl, environment.context),
        fmt::format("machine:  {}, {} thread{}; commit {}", environment.cpu, environment.threads,
                    environment.threads == 1 ? "" : "s", environment.commit)};
    const bool has_choice =
        std::any_of(results.rows.begin(), results.rows.end(),
                    [](const Row& row) { return row.timing.stats.choice.has_value(); });
    if (has_choice && !environment.costs.empty()) {
        lines.push_back(fmt::format("auto:     costs {}", environment.costs));
    }
    return lines;
}

namespace {

std::vector<std::string> notes_of_techniques() {
    return {
        "ms: median; ±: half of its 95 % interval. 1 % low: frame rate of the slowest hundredth.",
        "ratio: median over that of texture in the same run; drop: what it costs of the rate.",
        "error px: reprojection, RMS. wrong: pixels whose surface is over a texel off, or a hole."};
}

std::vector<std::string> notes_of_objects() {
    return {
        "heights: the buildings are heights of the terrain; meshes: meshes on the bare ground; "
        "meshes-only: meshes on a level plane. The truth is the exact picture of meshes.",
        "ms: median; ratio: over that of the texture. MB: sent to the GPU for the first frame.",
        "off: how far pixels are from the place they should show, RMS, in samples of the heights; "
        "wrong: pixels that are over a sample off, or show sky for city, or city for sky."};
}

std::vector<std::string> notes_of_skips(std::span<const Row> rows) {
    std::vector<std::string> notes{
        "ms: median without that kind of skipping; ±: half of its 95 % interval. saves: what the "
        "kind saves of ms (also in % of the time with everything skipped) and of taps a pixel.",
        "rays, triangles, MB: what it saves of a picture. Savings below the noise floor say "
        "nothing. rounded: hits with other bits are that near to their pixels."};
    for (const Row& row : rows) {
        const std::string text = fmt::format("{}: {}", row.skip->without, row.skip->meaning);
        if (!row.skip->without.empty() &&
            std::find(notes.begin(), notes.end(), text) == notes.end()) {
            notes.push_back(text);
        }
    }
    return notes;
}

} // namespace

std::vector<std::string> column_notes(const Results& results) {
    const bool is_of_objects = !results.rows.empty() && results.rows.front().objects;
    std::vector<std::string> notes = is_of_objects               ? notes_of_objects()
                                     : is_of_skips(results.rows) ? notes_of_skips(results.rows)
                                                                 : notes_of_techniques();
    const auto begin = results.rows.begin();
    const auto end = results.rows.end();
    if (has_sources(results.rows)) {
        notes.emplace_back(
            "source: frame rate in the thesis, on the newer of its two machines, and ratio there.");
    }
    if (std::any_of(begin, end,
                    [](const Row& row) { return row.noisy() && !row.has_few_frames(); })) {
        notes.push_back(
            fmt::format("NOISY: two measurements of the same technique (texture, or the one in the "
                        "heading) differ by over {:.0f} %. Smaller differences say nothing.",
                        100.0 * max_noise));
    }
    if (std::any_of(begin, end, [](const Row& row) { return row.has_few_frames(); })) {
        notes.push_back(fmt::format("Caution: under {} frames of a technique are too few for "
                                    "reliable times and for a noise floor.",
                                    min_frames));
    }
    if (std::any_of(begin, end, [](const Row& row) { return row.setting.technique == "exact"; })) {
        notes.emplace_back("FLIP, PSNR, SSIM, RMSE: of the shaded picture, filtering of its colour "
                           "map included; exact's own is the floor.");
    }
    notes.insert(notes.end(), results.notes.begin(), results.notes.end());
    return notes;
}

std::string front_text(const Front& front) {
    return front.front.empty() ? "none" : fmt::format("{}", fmt::join(front.front, ", "));
}

std::string area_text(const Front& front) {
    return front.area ? fmt::format("area {:.3f}", *front.area)
                      : "no area, as a technique or the ratio to texture is lacking";
}

std::string holed_text(const Front& front) {
    return fmt::format("holes over {:.1f} % of the picture: {}", 100.0 * max_holes,
                       fmt::join(front.holed, ", "));
}

std::string markdown_rule(std::size_t columns) {
    std::string text;
    for (std::size_t i = 0; i < columns; ++i) {
        text += i == 0 ? "|:--" : "|--:";
    }
    return text + "|\n";
}

std::size_t text_width(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    }));
}

std::vector<std::size_t> column_widths(const std::vector<std::vector<std::string>>& lines) {
    std::vector<std::size_t> widths;
    for (const auto& line : lines) {
        widths.resize(std::max(widths.size(), line.size()));
        for (std::size_t i = 0; i < line.size(); ++i) {
            widths[i] = std::max(widths[i], text_width(line[i]));
        }
    }
    return widths;
}

std::string padded_line(const std::vector<std::string>& cells,
                        const std::vector<std::size_t>& widths) {
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const std::string padding(widths[i] - text_width(cells[i]), ' ');
        line += i == 0 ? cells[i] + padding : "  " + padding + cells[i];
    }
    return line + "\n";
}

} // namespace reljef::bench

#include "bench/stress/stress_results.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "app/cli/message.h"
#include "app/cli/shard_option.h"
#include "bench/report/json_fields.h"
#include "bench/report/report_json.h"
#include "bench/report/report_table.h"
#include "bench/report/result_parts.h"

namespace reljef::bench {
namespace {

constexpr std::string_view stress_suite = "stress";

// A class of rows: the same figure of the same stress, with a limit or without.
struct StressLine {
    const StressRow* worst = nullptr;
    std::size_t rows = 0;
    std::size_t known = 0;
    std::size_t over = 0;
};

bool is_same_line(const StressRow& a, const StressRow& b) {
    return a.stress == b.stress && a.figure == b.figure && a.limit == b.limit;
}

bool is_worse(const StressRow& a, const StressRow& b) {
    return std::isnan(a.value) || a.value > b.value;
}

std::vector<StressLine> lines_of(const std::vector<StressRow>& rows) {
    std::vector<StressLine> lines;
    for (const StressRow& row : rows) {
        auto line = std::find_if(lines.begin(), lines.end(), [&](const StressLine& each) {
            return is_same_line(*each.worst, row);
        });
        if (line == lines.end()) {
            line = lines.insert(lines.end(), StressLine{&row});
        }
        line->worst = is_worse(row, *line->worst) ? &row : line->worst;
        ++line->rows;
        const StressVerdict verdict = verdict_of(row);
        line->known += verdict == StressVerdict::known ? 1 : 0;
        line->over += verdict == StressVerdict::over ? 1 : 0;
    }
    return lines;
}

std::string number_text(double value) {
    return fmt::format("{:.4g}", value);
}

std::string place_text(const StressRow& row) {
    std::string text;
    for (const std::string& part : {row.terrain, row.technique, row.at}) {
        text += (text.empty() || part.empty() ? "" : ", ") + part;
    }
    return cli::printable(text);
}

std::string summary_of(const StressLine& line) {
    if (!line.worst->limit) {
        return "reported";
    }
    if (line.over > 0) {
        return fmt::format("{} OVER", line.over);
    }
    return line.known > 0 ? fmt::format("{} known", line.known) : "ok";
}

// What parts of one run have in common.
FigureJson settings_of(const StressOptions& options) {
    FigureJson techniques = FigureJson::array();
    for (const scene::Technique& technique : options.techniques) {
        techniques.push_back(scene::to_string(technique));
    }
    return {{"size", size_text(options.suite.size)},
            {"quick", options.suite.quick},
            {"seed", options.seed},
            {"skip", options.skip},
            {"poses", options.poses ? FigureJson(*options.poses) : FigureJson()},
            {"terrains", options.terrains},
            {"techniques", techniques},
            {"stresses", options.stresses}};
}

// Files of earlier versions lack some keys.
StressOptions read_options(JsonReader& document) {
    StressOptions options;
    document.field("size", options.suite.size);
    document.field("quick", options.suite.quick);
    document.field("seed", options.seed);
    document.later_field("skip", options.skip);
    document.later_field("terrains", options.terrains);
    document.later_field("stresses", options.stresses);
    if (document.has("poses")) {
        document.field("poses", options.poses.emplace());
    }
    std::vector<std::string> techniques;
    document.later_field("techniques", techniques);
    for (const std::string& text : techniques) {
        const auto technique = scene::parse_technique(text);
        if (!technique) {
            document.fail("techniques", "techniques of this version");
            break;
        }
        options.techniques.push_back(*technique);
    }
    return options;
}

std::string rows_text(const StressResults& results, StressVerdict verdict,
                      std::string_view heading) {
    std::string text;
    for (const StressRow& row : results.rows) {
        if (verdict_of(row) == verdict) {
            text += fmt::format("  {}: {} {}, at most {} was expected ({}){}\n", row.stress,
                                number_text(row.value), row.figure, number_text(*row.limit),
                                place_text(row), row.known.empty() ? "" : "; " + row.known);
        }
    }
    return text.empty() ? text : fmt::format("{}\n{}", heading, text);
}

} // namespace

// JsonReader::array() finds it by argument-dependent lookup.
static void describe(JsonReader& fields, StressRow& row) {
    constexpr JsonRange any{.low = std::numeric_limits<double>::lowest()};
    std::optional<double> value;
    fields.field("stress", row.stress);
    fields.later_field("terrain", row.terrain);
    fields.later_field("technique", row.technique);
    fields.field("figure", row.figure);
    fields.field("value", value, any);
    fields.field("limit", row.limit, any);
    fields.later_field("at", row.at);
    fields.later_field("known", row.known);
    fields.later_field("only", row.only);
    row.value = value.value_or(std::nan(""));
}

StressVerdict verdict_of(const StressRow& row) {
    if (!row.limit) {
        return StressVerdict::reported;
    }
    if (row.value <= *row.limit) {
        return StressVerdict::within;
    }
    return row.known.empty() ? StressVerdict::over : StressVerdict::known;
}

std::string_view to_string(StressVerdict verdict) {
    switch (verdict) {
    case StressVerdict::within:
        return "ok";
    case StressVerdict::reported:
        return "reported";
    case StressVerdict::known:
        return "known";
    case StressVerdict::over:
        return "OVER";
    }
    return "";
}

void StressResults::add(StressRow row) {
    row.known = known_failure(row);
    rows.push_back(std::move(row));
}

std::size_t StressResults::failures() const {
    return static_cast<std::size_t>(
        std::count_if(rows.begin(), rows.end(),
                      [](const StressRow& row) { return verdict_of(row) == StressVerdict::over; }));
}

FigureTable figure_table(const StressResults& results) {
    using namespace columns;
    FigureColumn value = less("/value", "value", "", 4);
    value.limit = "/limit";
    FigureTable table{.suite = std::string(stress_suite),
                      .environment = results.environment,
                      .shard = results.options.shard,
                      .settings = settings_of(results.options),
                      .summary = FigureJson::object({{"over", results.failures()}}),
                      .columns = {group("/stress", "stress"), name("/terrain", "terrain"),
                                  name("/technique", "technique"), name("/figure", "figure"), value,
                                  plain("/limit", "limit", "", 4), plain("/at", "worst at"),
                                  plain("/verdict", "verdict"), plain("/known", "known"),
                                  detail(plain("/only", "--only"))}};
    table.end = results.end;
    for (const StressRow& row : results.rows) {
        const auto text = [](const std::string& word) {
            return word.empty() ? FigureJson() : FigureJson(word);
        };
        table.rows.push_back({row.stress, text(row.terrain), text(row.technique), row.figure,
                              row.value, json_or_null(row.limit), text(row.at),
                              to_string(verdict_of(row)), text(row.known), text(row.only)});
    }
    return table;
}

Result<StressResults> read_stress_report(const std::filesystem::path& file) {
    StressResults results;
    const auto done = read_report(file, [&](JsonReader& document) {
        ReportHead head = read_head(document);
        if (head.suite != stress_suite) {
            document.fail("suite", fmt::format("\"{}\"", stress_suite));
            return;
        }
        results.environment = std::move(head.environment);
        document.object("settings",
                        [&](JsonReader& inner) { results.options = read_options(inner); });
        results.options.shard = head.shard;
        results.end.stopped = std::move(head.stopped);
        document.array("rows", results.rows);
    });
    return done ? Result<StressResults>(std::move(results)) : done.error();
}

Result<StressResults> merged(std::vector<StressResults> parts,
                             std::span<const std::string> stresses) {
    auto run = whole_run(std::move(parts));
    if (!run) {
        return run.error();
    }
    StressResults all{.environment = run->front().environment, .options = run->front().options};
    all.options.shard = {};
    for (StressResults& part : *run) {
        if (settings_of(part.options) != settings_of(all.options)) {
            return Error{fmt::format("part {} was measured with other options than the first one, "
                                     "the same were expected",
                                     cli::shard_text(part.options.shard))};
        }
        std::move(part.rows.begin(), part.rows.end(), std::back_inserter(all.rows));
        all.end.stopped = all.end.stopped ? all.end.stopped : part.end.stopped;
        all.end.failed = all.end.failed || part.end.failed;
    }
    const auto place_of = [&](const StressRow& row) {
        return std::find(stresses.begin(), stresses.end(), row.only);
    };
    std::stable_sort(all.rows.begin(), all.rows.end(), [&](const StressRow& a, const StressRow& b) {
        return place_of(a) < place_of(b);
    });
    return all;
}

std::string stress_text(const StressResults& results) {
    std::vector<std::vector<std::string>> cells{
        {"stress and figure", "rows", "worst", "limit", "verdict"}};
    std::vector<std::string> places{"worst at"};
    for (const StressLine& line : lines_of(results.rows)) {
        const StressRow& worst = *line.worst;
        cells.push_back({fmt::format("{}: {}", worst.stress, worst.figure),
                         std::to_string(line.rows), number_text(worst.value),
                         worst.limit ? number_text(*worst.limit) : "–", summary_of(line)});
        places.push_back(place_text(worst));
    }
    const std::vector<std::size_t> widths = column_widths(cells);
    std::string text;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        std::string line = padded_line(cells[i], widths);
        line.pop_back(); // its end
        text += fmt::format("{}  {}\n", line, places[i]);
    }
    text += rows_text(results, StressVerdict::known, "known:");
    return text + rows_text(results, StressVerdict::over, "over their limits:");
}

} // namespace reljef::bench

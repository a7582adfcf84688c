#include "bench/findings/committed_results.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <system_error>

#include <fmt/format.h>

#include "app/cli/message.h"
#include "app/cli/parsed_option.h"
#include "bench/report/report_json.h"
#include "bench/report/results.h"

namespace reljef::bench {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

struct QuantityInfo {
    const char* pointer = nullptr; // into a row
    double high = std::numeric_limits<double>::max();
    double low = 0.0;
};

// The smallest time of a frame that a clock of nanoseconds can tell from none.
constexpr double min_ms = 1e-6;

QuantityInfo info_of(Quantity quantity) {
    switch (quantity) {
    case Quantity::ms:
        return {.pointer = "/ms/median", .low = min_ms};
    case Quantity::wrong:
        return {.pointer = "/error/wrong_of_terrain_percent", .high = 100.0};
    case Quantity::hidden:
        return {.pointer = "/error/hidden_percent", .high = 100.0};
    case Quantity::holes:
        return {"/error/holes"};
    case Quantity::error_px:
        return {"/error/reprojection_px/rms"};
    case Quantity::flip:
        return {.pointer = "/error/flip", .high = 1.0};
    case Quantity::ssim:
        return {.pointer = "/error/ssim", .high = 1.0, .low = -1.0};
    case Quantity::triangles:
        return {"/triangles"};
    case Quantity::taps:
        return {"/taps"};
    case Quantity::percent:
        return {.pointer = "/value", .high = 100.0};
    case Quantity::bytes:
        return {.pointer = "/objects/bytes"};
    }
    return {};
}

Result<void> check_results(const json& results, const std::string& file) {
    const json* const schema =
        results.is_object() && results.contains("schema") ? &results.at("schema") : nullptr;
    if (schema == nullptr || !schema->is_string()) {
        return Error{
            fmt::format("{}: no schema found, results of reljef-bench were expected", file)};
    }
    const auto& name = schema->get_ref<const std::string&>();
    if (name != schema_name) {
        return Error{fmt::format("{}: schema '{}' found, {} was expected", file,
                                 cli::printable(name), schema_name)};
    }
    if (results.contains("rows") && !results.at("rows").is_array()) {
        return Error{fmt::format("{}: rows: no array found, one was expected", file)};
    }
    if (results.contains("stopped") && !results.at("stopped").is_null()) {
        return Error{fmt::format("{}: the run ended early, whole results were expected", file)};
    }
    return {};
}

bool equals(const json& value, const std::string& text) {
    return value.is_string() && value.get_ref<const std::string&>() == text;
}

bool is_named(const json& row, const RowName& name) {
    if (!row.is_object() || row.value("null_row", json(false)) == json(true)) {
        return false;
    }
    return std::all_of(name.members.begin(), name.members.end(), [&](const auto& member) {
        const auto found = row.find(member.first);
        return found != row.end() && equals(*found, member.second);
    });
}

std::string text_of(const RowName& name) {
    std::string text;
    for (const auto& [key, value] : name.members) {
        text += fmt::format("{}{}", text.empty() ? "" : ", ", value);
    }
    return text;
}

// The value at a pointer; none if it is null or one of the steps does not exist.
const json* at(const json& row, const char* pointer) {
    const json::json_pointer place(pointer);
    const json* const value = row.contains(place) ? &row.at(place) : nullptr;
    return value == nullptr || value->is_null() ? nullptr : value;
}

Result<std::optional<double>> value_at(const json& row, const QuantityInfo& info) {
    const json* const value = at(row, info.pointer);
    if (value == nullptr) {
        return std::optional<double>();
    }
    const double number = value->is_number() ? value->get<double>() : NAN;
    if (!(number >= info.low && number <= info.high)) {
        return Error{
            fmt::format("{}: {} found, a number of {} to {} was expected", info.pointer,
                        cli::printable(value->dump(-1, ' ', true, json::error_handler_t::replace)),
                        info.low, info.high)};
    }
    return std::optional<double>(number);
}

// Of "1024x768".
std::optional<double> pixels_of(const std::string& size) {
    const auto middle = size.find('x');
    const auto cols = cli::number_from<double>(size.substr(0, middle));
    const auto rows = middle == std::string::npos
                          ? std::nullopt
                          : cli::number_from<double>(size.substr(middle + 1));
    return cols && rows ? std::optional(*cols * *rows) : std::nullopt;
}

// Rows have the counts of pixels; of a picture without terrain they have holes only.
Result<std::optional<double>> holes_percent(const json& row) {
    auto holes = value_at(row, info_of(Quantity::holes));
    if (!holes || !*holes) {
        return holes;
    }
    double terrain = **holes;
    for (const char* const pointer :
         {"/error/reprojection_px/count", "/error/reprojection_px/unbounded"}) {
        auto shown = value_at(row, {.pointer = pointer});
        if (!shown) {
            return shown;
        }
        terrain += shown->value_or(0.0);
    }
    return terrain > 0.0 ? std::optional(100.0 * **holes / terrain) : std::nullopt;
}

// Rows of techniques of earlier versions have the share of the picture and the counts of its
// pixels.
Result<std::optional<double>> wrong_of_terrain(const json& row) {
    std::array<double, 4> found{};
    constexpr std::array pointers{"/error/wrong_percent", "/error/reprojection_px/count",
                                  "/error/reprojection_px/unbounded", "/error/holes"};
    for (std::size_t i = 0; i < pointers.size(); ++i) {
        auto value = value_at(row, {.pointer = pointers[i]});
        if (!value || !*value) {
            return value;
        }
        found[i] = **value;
    }
    const auto [wrong, finite, unbounded, holes] = found;
    const auto size = row.find("size");
    const auto pixels = size != row.end() && size->is_string()
                            ? pixels_of(size->get_ref<const std::string&>())
                            : std::optional<double>();
    const double terrain = finite + unbounded + holes;
    if (!pixels || !(terrain > 0.0)) {
        return std::optional<double>();
    }
    return std::optional(std::min(wrong * *pixels / terrain, 100.0));
}

Result<std::optional<double>> quantity_of(const json& row, Quantity quantity) {
    if (quantity == Quantity::holes) {
        return holes_percent(row);
    }
    auto value = value_at(row, info_of(quantity));
    return value && !*value && quantity == Quantity::wrong ? wrong_of_terrain(row) : value;
}

// The farther end of the interval of a median, a share of the median; 0 without an interval.
Result<double> spread_of(const json& row, double median) {
    double spread = 0.0;
    for (const char* const pointer : {"/ms/interval/0", "/ms/interval/1"}) {
        const auto end = value_at(row, {.pointer = pointer});
        if (!end) {
            return end.error();
        }
        spread = std::max(spread, std::abs(end->value_or(median) - median) / median);
    }
    return spread;
}

// A time. Rows of a suite without a noise floor count as noisy as a row may be that is not marked
// noisy.
Result<Number> time_of(const json& row, double median) {
    const auto floor = value_at(row, {.pointer = "/noise_floor"});
    const auto spread = spread_of(row, median);
    if (!floor || !spread) {
        return floor ? spread.error() : floor.error();
    }
    return Number{median, median * floor->value_or(max_noise), median * *spread};
}

Result<std::optional<Number>> number_in(const json& row, Quantity quantity) {
    const auto value = quantity_of(row, quantity);
    if (!value) {
        return value.error();
    }
    if (!*value) {
        return std::optional<Number>();
    }
    if (quantity != Quantity::ms) {
        return std::optional(Number{**value});
    }
    const auto time = time_of(row, **value);
    return time ? Result<std::optional<Number>>(*time) : time.error();
}

} // namespace

Result<CommittedResults> CommittedResults::read(const fs::path& folder,
                                                std::span<const std::string> files) {
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) {
        return Error{fmt::format(
            "{}: no folder found, one with results of reljef-bench was expected", folder.string())};
    }
    CommittedResults results;
    results.folder_ = folder;
    for (const std::string& file : files) {
        const fs::path path = folder / file;
        if (!fs::exists(path, ignored)) {
            continue;
        }
        auto json = read_result_json(path);
        if (!json) {
            return json.error();
        }
        if (auto good = check_results(*json, path.string()); !good) {
            return good.error();
        }
        results.files_.emplace(file, std::move(*json));
    }
    return results;
}

Result<std::optional<Number>> CommittedResults::number(const RowName& row,
                                                       Quantity quantity) const {
    const auto file = files_.find(row.file);
    if (file == files_.end() || !file->second.contains("rows")) {
        return std::optional<Number>();
    }
    const json* found = nullptr;
    for (const json& candidate : file->second.at("rows")) {
        if (!is_named(candidate, row)) {
            continue;
        }
        if (found != nullptr) {
            return Error{fmt::format("{}: several rows '{}' found, one was expected",
                                     (folder_ / row.file).string(), text_of(row))};
        }
        found = &candidate;
    }
    if (found == nullptr) {
        return std::optional<Number>();
    }
    auto number = number_in(*found, quantity);
    if (!number) {
        return Error{fmt::format("{}: row '{}': {}", (folder_ / row.file).string(), text_of(row),
                                 number.error().message)};
    }
    return number;
}

std::size_t CommittedResults::left_out(const std::string& file) const {
    const auto found = files_.find(file);
    const json* const parts = found == files_.end() ? nullptr : at(found->second, "/left_out");
    std::size_t count = 0;
    if (parts != nullptr && parts->is_array()) {
        for (const json& part : *parts) {
            const json* const settings = at(part, "/settings");
            const bool is_count = settings != nullptr && settings->is_number_unsigned();
            count += is_count ? settings->get<std::size_t>() : 0U;
        }
    }
    return count;
}

std::string CommittedResults::suite(const std::string& file) const {
    const auto found = files_.find(file);
    if (found == files_.end()) {
        return {};
    }
    for (const char* const pointer : {"/suite", "/rows/0/suite"}) { // the second of older files
        const json* const value = at(found->second, pointer);
        if (value != nullptr && value->is_string()) {
            return value->get<std::string>();
        }
    }
    return {};
}

std::optional<Machine> CommittedResults::machine(const std::string& file) const {
    const auto found = files_.find(file);
    if (found == files_.end()) {
        return {};
    }
    const auto text = [&](const char* pointer) {
        const json* const value = at(found->second, pointer);
        return value != nullptr && value->is_string() ? cli::printable(value->get<std::string>())
                                                      : "unknown";
    };
    if (const json* const environment = at(found->second, "/environment");
        environment == nullptr || !environment->is_object()) {
        return {};
    }
    const json* const threads = at(found->second, "/environment/threads");
    const bool has_threads = threads != nullptr && threads->is_number_unsigned();
    const Environment where{.renderer = text("/environment/renderer"),
                            .context = text("/environment/context")};
    return Machine{text("/environment/cpu"), where.renderer,
                   has_threads ? threads->get<unsigned>() : 1U, text("/environment/commit"),
                   where.has_gpu()};
}

} // namespace reljef::bench

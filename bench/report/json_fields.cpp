#include "bench/report/json_fields.h"

#include <algorithm>
#include <cmath>

#include "app/cli/parsed_option.h"

namespace reljef::bench {
namespace {

using nlohmann::json;

std::string found_text(const json& value) {
    if (value.is_object()) {
        return "an object";
    }
    constexpr std::size_t short_array = 4;
    const bool is_plain = std::all_of(value.begin(), value.end(),
                                      [](const json& element) { return element.is_primitive(); });
    if (value.is_array() && (value.size() > short_array || !is_plain)) {
        return "an array";
    }
    constexpr std::size_t longest = 60;
    std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    if (text.size() > longest) {
        text.resize(longest);
        text += "…";
    }
    return text;
}

std::string range_text(const JsonRange& range) {
    return range.high == std::numeric_limits<double>::max()
               ? fmt::format("a number of at least {}", range.low)
               : fmt::format("a number from {} to {}", range.low, range.high);
}

bool is_within(double value, const JsonRange& range) {
    return std::isfinite(value) && value >= range.low && value <= range.high;
}

// Parses "1024x768"; absent unless both are at least 1.
std::optional<glm::ivec2> size_from(std::string_view text) {
    const std::size_t middle = std::min(text.find('x'), text.size());
    const auto width = cli::number_from<int>(text.substr(0, middle));
    const auto height = cli::number_from<int>(text.substr(std::min(middle + 1, text.size())));
    return width && height && std::min(*width, *height) >= 1
               ? std::optional(glm::ivec2(*width, *height))
               : std::nullopt;
}

} // namespace

nlohmann::ordered_json JsonWriter::json_from(const std::optional<ConfidenceInterval>& interval) {
    return interval ? nlohmann::ordered_json{interval->low, interval->high}
                    : nlohmann::ordered_json();
}

nlohmann::ordered_json JsonWriter::json_from(const std::vector<Setting::Parameter>& parameters) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (const auto& [name, value] : parameters) {
        const bool is_whole = value == std::trunc(value) && std::abs(value) < max_exact_whole;
        object[name] = is_whole ? nlohmann::ordered_json(static_cast<long long>(value))
                                : nlohmann::ordered_json(value);
    }
    return object;
}

nlohmann::ordered_json JsonWriter::json_from(glm::ivec2 size) {
    return fmt::format("{}x{}", size.x, size.y);
}

nlohmann::ordered_json JsonWriter::json_from(scene::Pose pose) {
    return scene::to_string(pose);
}

JsonReader::JsonReader(const json& json, std::string place, std::optional<Error>& error)
    : json_(&json), place_(std::move(place)), error_(&error) {
    if (json.is_object()) {
        return;
    }
    static const nlohmann::json empty = nlohmann::json::object();
    json_ = &empty;
    if (!error) {
        error = Error{fmt::format("{}: {} found, an object was expected",
                                  place_.empty() ? "the document" : place_,
                                  json.is_null() ? "nothing" : found_text(json))};
    }
}

const json& JsonReader::at(const char* key) const {
    static const json null;
    const auto found = json_->find(key);
    return found == json_->end() ? null : *found;
}

std::string JsonReader::place_of(const char* key) const {
    return place_.empty() ? key : fmt::format("{}.{}", place_, key);
}

void JsonReader::fail(const char* key, const std::string& expected) {
    set_error(place_of(key), json_->contains(key) ? found_text(at(key)) : "nothing", expected);
}

void JsonReader::fail_at(const std::string& place, const json& found, const std::string& expected) {
    set_error(place, found_text(found), expected);
}

void JsonReader::set_error(const std::string& place, const std::string& found,
                           const std::string& expected) {
    if (!*error_) {
        *error_ = Error{fmt::format("{}: {} found, {} was expected", place, found, expected)};
    }
}

void JsonReader::field(const char* key, std::string& value) {
    if (!at(key).is_string()) {
        fail(key, "a text");
    } else {
        value = at(key).get<std::string>();
    }
}

void JsonReader::field(const char* key, bool& value) {
    if (!at(key).is_boolean()) {
        fail(key, "true or false");
    } else {
        value = at(key).get<bool>();
    }
}

double JsonReader::number(const char* key, const JsonRange& range) {
    const json& value = at(key);
    if (!value.is_number() || !is_within(value.get<double>(), range)) {
        fail(key, range_text(range));
        return range.low;
    }
    return value.get<double>();
}

double JsonReader::whole(const char* key, double min, double max) {
    const double value = number(key, {min, max});
    if (value != std::trunc(value)) {
        fail(key, "a whole number");
    }
    return value;
}

void JsonReader::field(const char* key, double& value, const JsonRange& range) {
    value = number(key, range);
}

void JsonReader::field(const char* key, std::optional<double>& value, const JsonRange& range) {
    if (!json_->contains(key) || has(key)) {
        value = number(key, range);
    }
}

void JsonReader::field(const char* key, std::optional<ConfidenceInterval>& value,
                       const JsonRange& range) {
    if (json_->contains(key) && !has(key)) {
        return;
    }
    const json& ends = at(key);
    const bool are_numbers =
        ends.is_array() && ends.size() == 2 && ends[0].is_number() && ends[1].is_number();
    if (!are_numbers || !is_within(ends[0].get<double>(), range) ||
        !is_within(ends[1].get<double>(), range) || ends[0] > ends[1]) {
        fail(key,
             fmt::format("two numbers from {} to {}, the lower one first", range.low, range.high));
        return;
    }
    value = ConfidenceInterval{ends[0].get<double>(), ends[1].get<double>()};
}

const json& JsonReader::array_at(const char* key) {
    static const json empty = json::array();
    if (!at(key).is_array()) {
        fail(key, "an array");
        return empty;
    }
    return at(key);
}

void JsonReader::field(const char* key, std::vector<std::string>& value) {
    for (const json& element : array_at(key)) {
        if (!element.is_string()) {
            fail(key, "an array of texts");
            return;
        }
        value.push_back(element.get<std::string>());
    }
}

void JsonReader::field(const char* key, std::vector<Setting::Parameter>& value) {
    object(key, [&](JsonReader& parameters) {
        for (const auto& item : parameters.json_->items()) {
            const JsonRange any{.low = std::numeric_limits<double>::lowest()};
            value.push_back({item.key(), 0.0});
            parameters.field(item.key().c_str(), value.back().value, any);
        }
    });
}

void JsonReader::field(const char* key, glm::ivec2& size) {
    const auto found = at(key).is_string() ? size_from(at(key).get<std::string>()) : std::nullopt;
    if (!found) {
        fail(key, "WIDTHxHEIGHT");
    }
    size = found.value_or(glm::ivec2(1));
}

void JsonReader::field(const char* key, scene::Pose& pose) {
    std::string text;
    field(key, text);
    const auto found = scene::pose_from_string(text);
    if (!found) {
        fail(key, "a standard pose");
    }
    pose = found.value_or(scene::Pose::overview);
}

} // namespace reljef::bench

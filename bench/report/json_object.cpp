#include "bench/report/json_object.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace reljef::bench {
namespace {

using nlohmann::json;

constexpr double max_count = 9e15;

const json& no_object() {
    static const json empty = json::object();
    return empty;
}

bool holds_plain_values(const json& array) {
    return std::all_of(array.begin(), array.end(),
                       [](const json& value) { return value.is_primitive(); });
}

std::string found_text(const json& value) {
    if (value.is_object()) {
        return "an object";
    }
    constexpr std::size_t short_array = 4;
    if (value.is_array() && (value.size() > short_array || !holds_plain_values(value))) {
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
    const std::string low = fmt::format(
        "{} {}", range.above_low ? "a number above" : "a number of at least", range.low);
    const bool is_open = range.high == std::numeric_limits<double>::max();
    return is_open ? low : fmt::format("a number from {} to {}", range.low, range.high);
}

bool is_within(double value, const JsonRange& range) {
    return std::isfinite(value) && value <= range.high &&
           (range.above_low ? value > range.low : value >= range.low);
}

} // namespace

void JsonFault::set(const std::string& place, const std::string& found,
                    const std::string& expected) {
    if (!error_) {
        error_ =
            Error{fmt::format("{}: {}: {} found, {} was expected", file_, place, found, expected)};
    }
}

JsonObject::JsonObject(const json& json, std::string place, JsonFault& fault)
    : json_(&json), place_(std::move(place)), error_(&fault) {
    if (!json.is_object()) {
        fault.set(place_.empty() ? "the document" : place_, found_text(json), "an object");
        json_ = &no_object();
    }
}

std::string JsonObject::place_of(std::string_view key) const {
    return place_.empty() ? std::string(key) : fmt::format("{}.{}", place_, key);
}

bool JsonObject::has(std::string_view key) const {
    return json_->contains(key);
}

bool JsonObject::is_null(std::string_view key) const {
    const json* value = find(key);
    return value != nullptr && value->is_null();
}

const json* JsonObject::find(std::string_view key) const {
    const auto found = json_->find(key);
    return found == json_->end() ? nullptr : &*found;
}

void JsonObject::fail(std::string_view key, const std::string& expected) const {
    const json* value = find(key);
    error_->set(place_of(key), value == nullptr ? "nothing" : found_text(*value), expected);
}

std::string JsonObject::text(std::string_view key) const {
    const json* value = find(key);
    if (value == nullptr || !value->is_string()) {
        fail(key, "a text");
        return {};
    }
    return value->get<std::string>();
}

bool JsonObject::flag(std::string_view key) const {
    const json* value = find(key);
    if (value == nullptr || !value->is_boolean()) {
        fail(key, "true or false");
        return false;
    }
    return value->get<bool>();
}

double JsonObject::number(std::string_view key, const JsonRange& range) const {
    const json* value = find(key);
    if (value == nullptr || !value->is_number() || !is_within(value->get<double>(), range)) {
        fail(key, range_text(range));
        return range.above_low ? 1.0 : range.low;
    }
    return value->get<double>();
}

std::optional<double> JsonObject::number_or_null(std::string_view key,
                                                 const JsonRange& range) const {
    return is_null(key) ? std::nullopt : std::optional(number(key, range));
}

std::size_t JsonObject::count(std::string_view key, std::size_t least) const {
    const double value = number(key, {static_cast<double>(least), max_count});
    if (value != std::trunc(value)) {
        fail(key, "a whole number");
    }
    return static_cast<std::size_t>(value);
}

int JsonObject::whole(std::string_view key) const {
    const double value = number(key, {0.0, std::numeric_limits<int>::max()});
    if (value != std::trunc(value)) {
        fail(key, "a whole number");
    }
    return static_cast<int>(value);
}

JsonObject JsonObject::object(std::string_view key) const {
    const json* value = find(key);
    if (value == nullptr) {
        fail(key, "an object");
    }
    return {value == nullptr ? no_object() : *value, place_of(key), *error_};
}

const json* JsonObject::find_array(std::string_view key) const {
    const json* value = find(key);
    if (value == nullptr || !value->is_array()) {
        fail(key, "an array");
        return nullptr;
    }
    return value;
}

void JsonObject::each(std::string_view key,
                      const std::function<void(const JsonObject&)>& read) const {
    const json* array = find_array(key);
    for (std::size_t i = 0; array != nullptr && i < array->size() && !error_->error(); ++i) {
        read({(*array)[i], fmt::format("{}[{}]", place_of(key), i), *error_});
    }
}

std::vector<std::string> JsonObject::texts(std::string_view key) const {
    std::vector<std::string> texts;
    if (const json* array = find_array(key)) {
        for (const json& value : *array) {
            if (!value.is_string()) {
                error_->set(place_of(key), found_text(value), "texts");
                return {};
            }
            texts.push_back(value.get<std::string>());
        }
    }
    return texts;
}

std::vector<double> JsonObject::numbers(std::string_view key, std::size_t count) const {
    std::vector<double> numbers;
    const json* array = find_array(key);
    for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
        const json& value = (*array)[i];
        numbers.push_back(value.is_number() ? value.get<double>()
                                            : std::numeric_limits<double>::quiet_NaN());
        if (!std::isfinite(numbers.back())) {
            error_->set(place_of(key), found_text(value), "numbers");
        }
    }
    if (numbers.size() != count) {
        fail(key, fmt::format("an array of {} numbers", count));
        numbers.resize(count);
    }
    return numbers;
}

std::vector<std::string> JsonObject::keys() const {
    std::vector<std::string> keys;
    for (const auto& item : json_->items()) {
        keys.push_back(item.key());
    }
    return keys;
}

} // namespace reljef::bench

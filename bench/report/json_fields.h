#pragma once

#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/vec2.hpp>
#include <nlohmann/json.hpp>

#include "bench/report/results.h"

namespace reljef::bench {

/// Smaller whole numbers are exact doubles.
inline constexpr double max_exact_whole = 9e15;

struct JsonRange {
    double low = 0.0;
    double high = std::numeric_limits<double>::max();
};

/// Writes the fields of one object. JsonReader has the same functions: one describe(fields, value)
/// for each struct serves both.
class JsonWriter {
public:
    template <class Value> using Of = const Value;

    template <class Value, class... Limits>
    void field(const char* key, const Value& value, const Limits&... /*limits*/) {
        json[key] = json_from(value);
    }
    /// A field that older files lack.
    template <class Value> void later_field(const char* key, const Value& value) {
        field(key, value);
    }
    /// A figure computed from others; not read.
    void derived(const char* key, double value) { json[key] = value; }
    template <class Inner> void object(const char* key, const Inner& describe_inner) {
        JsonWriter inner;
        describe_inner(inner);
        json[key] = std::move(inner.json);
    }
    template <class Value> void object(const char* key, const std::optional<Value>& value) {
        json[key] = nullptr;
        if (value) {
            object(key, [&](JsonWriter& inner) { describe(inner, *value); });
        }
    }
    template <class Value> void array(const char* key, const std::vector<Value>& values) {
        json[key] = nlohmann::ordered_json::array();
        for (const Value& value : values) {
            JsonWriter inner;
            describe(inner, value);
            json[key].push_back(std::move(inner.json));
        }
    }

    nlohmann::ordered_json json = nlohmann::ordered_json::object();

private:
    template <class Value> static nlohmann::ordered_json json_from(const Value& value) {
        return value;
    }
    static nlohmann::ordered_json json_from(const std::optional<double>& value) {
        return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
    }
    static nlohmann::ordered_json json_from(const std::optional<ConfidenceInterval>& interval);
    static nlohmann::ordered_json json_from(const std::vector<Setting::Parameter>& parameters);
    static nlohmann::ordered_json json_from(glm::ivec2 size);
    static nlohmann::ordered_json json_from(scene::Pose pose);
};

/// Reads the fields of one object. The first field that is absent or has a wrong type or range sets
/// the document's error; reading continues with defaults.
class JsonReader {
public:
    template <class Value> using Of = Value;

    /// `place` names the object in messages: "rows[3]"; empty: the document.
    JsonReader(const nlohmann::json& json, std::string place, std::optional<Error>& error);

    void field(const char* key, std::string& value);
    void field(const char* key, bool& value);
    template <std::integral Whole> void field(const char* key, Whole& value, Whole min = 0) {
        const double max =
            sizeof(Whole) > sizeof(int) ? max_exact_whole : std::numeric_limits<int>::max();
        value = static_cast<Whole>(whole(key, static_cast<double>(min), max));
    }
    void field(const char* key, double& value, const JsonRange& range = {});
    void field(const char* key, std::optional<double>& value, const JsonRange& range = {});
    void field(const char* key, std::optional<ConfidenceInterval>& value, const JsonRange& range);
    void field(const char* key, std::vector<std::string>& value);
    void field(const char* key, std::vector<Setting::Parameter>& value);
    void field(const char* key, glm::ivec2& size);
    void field(const char* key, scene::Pose& pose);
    template <class Value> void later_field(const char* key, Value& value) {
        if (has(key)) {
            field(key, value);
        }
    }
    void derived(const char* /*key*/, double /*value*/) {}
    template <class Inner> void object(const char* key, const Inner& describe_inner) {
        JsonReader inner(at(key), place_of(key), *error_);
        describe_inner(inner);
    }
    template <class Value> void object(const char* key, std::optional<Value>& value) {
        if (has(key)) {
            value = Value();
            object(key, [&](JsonReader& inner) { describe(inner, *value); });
        }
    }
    template <class Value> void array(const char* key, std::vector<Value>& values) {
        const nlohmann::json& elements = array_at(key);
        for (std::size_t i = 0; i < elements.size() && !*error_; ++i) {
            JsonReader inner(elements[i], fmt::format("{}[{}]", place_of(key), i), *error_);
            describe(inner, values.emplace_back());
        }
    }

    /// Whether the key exists and is not null.
    [[nodiscard]] bool has(const char* key) const { return !at(key).is_null(); }
    /// The value of a key; null if it is absent.
    [[nodiscard]] const nlohmann::json& value(const char* key) const { return at(key); }
    /// Sets the error, if there is none yet: the value of `key` is not `expected`.
    void fail(const char* key, const std::string& expected);
    /// The same for a value anywhere in the document: "rows[3]/ms/median".
    void fail_at(const std::string& place, const nlohmann::json& found,
                 const std::string& expected);

private:
    [[nodiscard]] const nlohmann::json& at(const char* key) const; // null if absent
    [[nodiscard]] const nlohmann::json& array_at(const char* key); // empty after an error
    [[nodiscard]] std::string place_of(const char* key) const;
    void set_error(const std::string& place, const std::string& found, const std::string& expected);
    double number(const char* key, const JsonRange& range);
    double whole(const char* key, double min, double max);

    const nlohmann::json* json_; // an object
    std::string place_;
    std::optional<Error>* error_;
};

} // namespace reljef::bench

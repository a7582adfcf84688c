#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/core/result.h"

namespace reljef::bench {

/// Numbers that a key may have.
struct JsonRange {
    double low = 0.0;
    double high = std::numeric_limits<double>::max();
    bool above_low = false; ///< `low` itself is out of range
};

/// The first thing that was found wrong with a document.
class JsonFault {
public:
    explicit JsonFault(std::string file) : file_(std::move(file)) {}

    /// Does nothing where there is a fault already.
    void set(const std::string& place, const std::string& found, const std::string& expected);
    [[nodiscard]] const std::optional<Error>& error() const { return error_; }

private:
    std::string file_;
    std::optional<Error> error_;
};

/// Reads the keys of one object. What is absent or of a wrong kind sets the document's fault and
/// gives a default, so that all can be read before the fault is asked for. Valid as long as the
/// document and its fault.
class JsonObject {
public:
    /// `place` names it in messages, "rows[3]"; empty: the document itself.
    JsonObject(const nlohmann::json& json, std::string place, JsonFault& fault);

    [[nodiscard]] std::string text(std::string_view key) const;
    [[nodiscard]] bool flag(std::string_view key) const;
    [[nodiscard]] double number(std::string_view key, const JsonRange& range = {}) const;
    [[nodiscard]] std::size_t count(std::string_view key, std::size_t least = 0) const;
    [[nodiscard]] int whole(std::string_view key) const; ///< 0 or more
    /// Absent where it is null.
    [[nodiscard]] std::optional<double> number_or_null(std::string_view key,
                                                       const JsonRange& range = {}) const;

    /// Whether there is such a key, null or not.
    [[nodiscard]] bool has(std::string_view key) const;
    [[nodiscard]] bool is_null(std::string_view key) const;
    [[nodiscard]] JsonObject object(std::string_view key) const;
    /// Gives the objects of an array to `read`, one after the other, until there is a fault.
    void each(std::string_view key, const std::function<void(const JsonObject&)>& read) const;
    [[nodiscard]] std::vector<std::string> texts(std::string_view key) const;
    [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count) const;
    [[nodiscard]] std::vector<std::string> keys() const;

    /// Makes it the fault that `key` holds something else than `expected`.
    void fail(std::string_view key, const std::string& expected) const;

private:
    [[nodiscard]] const nlohmann::json* find(std::string_view key) const;
    [[nodiscard]] const nlohmann::json* find_array(std::string_view key) const;
    [[nodiscard]] std::string place_of(std::string_view key) const;

    const nlohmann::json* json_; // an object
    std::string place_;
    JsonFault* error_;
};

} // namespace reljef::bench

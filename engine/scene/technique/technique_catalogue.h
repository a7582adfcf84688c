#pragma once

#include <limits>
#include <span>
#include <string_view>
#include <type_traits>

#include "engine/core/result.h"
#include "engine/scene/technique/technique_parameters.h"

namespace reljef::scene {

struct Technique;

/// A number of a technique or an option: one row of the table.
struct NumberInfo {
    std::string_view name; ///< the key that a user types
    double low = 0.0;      ///< smallest allowed value
    double high = 0.0;     ///< largest allowed value
    std::string_view meaning = {};
    bool is_tacit = false; ///< part of a technique's text only if it differs from its default
    /// If it exceeds `low`: the smallest allowed value except `low` itself.
    double min_above_low = std::numeric_limits<double>::lowest();
    double default_value = 0.0; ///< see number_of()
    bool whole = false;         ///< whole numbers only; see number_of()

    [[nodiscard]] constexpr bool allows(double value) const {
        const bool is_in_range =
            value >= low && value <= high && (value == low || value >= min_above_low);
        return is_in_range &&
               (!whole || value == static_cast<double>(static_cast<long long>(value)));
    }
};

/// Completes the row of a member with its default. Integers and bools are whole.
template <class Owner, class Value>
constexpr NumberInfo number_of(Value Owner::*member, NumberInfo row) {
    row.default_value = static_cast<double>(Owner{}.*member);
    row.whole = !std::is_floating_point_v<Value>;
    return row;
}

/// The allowed value next to a value; its default for NaN.
double nearest_allowed(const NumberInfo& number, double value);

/// The allowed value some steps up (over 0) or down: whole numbers by 1, wide ranges by tenths of
/// the value, others by fortieths of the range. At least one allowed value away, if there is one.
double stepped(const NumberInfo& number, double value, int steps);

/// Parses a number that its row allows. Errors name `subject`, the number, what was found and what
/// was expected.
Result<double> parse_number(std::string_view subject, const NumberInfo& number,
                            std::string_view text);

/// Allowed error bounds of polygons, pixels. The rasterizer's own error takes most of a smaller
/// one.
inline constexpr double min_polygons_error = 0.02;
inline constexpr double max_polygons_error = 16.0;

/// A parameter of a technique: its row, and access to the member that holds it.
struct ParameterInfo : NumberInfo {
    /// The parameter of the same technique that replaces this one unless it has its default; both
    /// cannot be set together. Empty: none.
    std::string_view replaced_by;
    double (*getter)(const Technique&) = nullptr;
    void (*setter)(Technique&, double) = nullptr;

    /// Precondition: it is a parameter of this technique.
    [[nodiscard]] double get(const Technique& technique) const { return getter(technique); }
    /// Preconditions: the same, and allows(value).
    void set(Technique& technique, double value) const;
};

struct TechniqueInfo {
    TechniqueId id;
    std::string_view name; ///< as on the command line
    std::string_view meaning;
    std::string_view source; ///< the paper or book
    TechniqueParameters defaults;
    std::span<const ParameterInfo> parameters;
};

/// All techniques, in the order of the sources.
std::span<const TechniqueInfo> technique_catalogue();
const TechniqueInfo& technique_info(TechniqueId id);

} // namespace reljef::scene

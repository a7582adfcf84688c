#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "engine/material/relief_material.h"
#include "engine/scene/technique/number_info.h"
#include "engine/scene/technique/technique_parameters.h"

namespace reljef::scene {

/// Equal steps by the angle of view: n = low + (high − low)(1 − cos α), α between the view ray and
/// the surface's normal.
struct StepRange {
    int low = 8;
    int high = 32;
    friend bool operator==(const StepRange&, const StepRange&) = default;
};

/// Heights by the angle of view: what is s otherwise is s · (low + (high − low)(1 − (1 − cos
/// α)^power)). Power 1 is low + (high − low) cos α.
struct Fade {
    double low = 0.0;
    double high = 1.0;
    double power = 1.0;
    friend bool operator==(const Fade&, const Fade&) = default;
};

/// A second ray, from the hit to the sun. Soft: of its deepest penetration p, in [0,1] of the range
/// of heights, clamp(1 − p/depth) of the sun's light is left. Hard: what is left as depth → 0.
struct Shadow {
    double depth = 0.2; ///< 0: hard
    friend bool operator==(const Shadow&, const Shadow&) = default;
};

/// A ray that passes the surface by less than the distance shows that place blended into the one it
/// hits.
struct SmoothEdges {
    double distance = 0.005; ///< in [0,1] of the range of heights
    friend bool operator==(const SmoothEdges&, const SmoothEdges&) = default;
};

/// What lies beyond the border of a detail tile.
using BorderRule = material::WrapMode;

/// What a technique does in addition to its search for the surface. By default it does nothing
/// more.
struct TechniqueOptions {
    std::optional<StepRange> steps;
    std::optional<Fade> fade;
    std::optional<Shadow> shadow;
    std::optional<SmoothEdges> smooth_edges;
    bool two_sided = false;           ///< seen from behind, too
    std::optional<BorderRule> border; ///< absent: as the surface has it
    bool writes_depth = false;        ///< of the hit, so that meshes cut the relief
    bool true_silhouettes = false;    ///< a mesh is drawn by a hull around its relief
    friend bool operator==(const TechniqueOptions&, const TechniqueOptions&) = default;
};

/// A number of an option: its row, and the member that holds it.
struct OptionNumberInfo : NumberInfo {
    std::optional<double> (*getter)(const TechniqueOptions&) = nullptr;
    void (*setter)(TechniqueOptions&, double) = nullptr;

    /// Absent where the option is.
    [[nodiscard]] std::optional<double> get(const TechniqueOptions& options) const;
    /// Preconditions: the option is there, and allows(value).
    void set(TechniqueOptions& options, double value) const;
};

/// An option that the user may set: one row of the table. Its value is one of its words; the last
/// word may be followed by its numbers. The value of an option without words is a range, made of
/// its first two numbers; the other numbers may follow.
struct OptionInfo {
    std::string_view name;
    std::string_view default_value; ///< as in its text
    std::string_view meaning;
    std::string_view source; ///< where it is described
    std::span<const std::string_view> words;
    std::span<const OptionNumberInfo> numbers;
    /// The index of its word, or 0 for its range; absent where the option has its default.
    std::optional<std::size_t> (*chosen)(const TechniqueOptions&) = nullptr;
    /// Sets the word of that index, or a range for 0, with the numbers' defaults; absent: sets the
    /// option's default.
    void (*choose)(TechniqueOptions&, std::optional<std::size_t>) = nullptr;
    /// Why a technique cannot take it; empty where it can.
    std::string_view (*reason_against)(TechniqueId) = nullptr;
};

/// Every option there is, in the order of the sources.
std::span<const OptionInfo> option_catalogue();

/// The form of an option's value: "min..max[,k]".
std::string form_of(const OptionInfo& info);

/// Those that make sense with a technique.
std::vector<OptionInfo> options_of(TechniqueId id);

/// Whether the key of "key=value" is an option's.
bool is_option(std::string_view assignment);

/// Sets the option of "key=value" or "key=value,more". Fails where the technique cannot take it,
/// and on a value that is none of it. Precondition: is_option.
Result<void> set_option(TechniqueOptions& options, TechniqueId id, std::string_view assignment);

/// ",key=value" of each option that differs from its default; set_option restores the options.
std::string to_string(const TechniqueOptions& options);

/// The options that differ from their defaults, as numbers: a word is its index in the option's
/// form, a hard shadow has depth 0.
struct OptionNumber {
    std::string name; ///< "fade.min"
    double value = 0.0;
};
std::vector<OptionNumber> option_numbers(const TechniqueOptions& options);

} // namespace reljef::scene

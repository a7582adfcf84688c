#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "engine/material/texture_set.h"

namespace reljef::scene {

enum class TechniqueId;

/// One number a technique or an option can be told.
struct ParameterInfo {
    std::string_view name;
    double default_value = 0.0;
    double low = 0.0;   ///< least value allowed
    double high = 0.0;  ///< greatest value allowed
    bool whole = false; ///< whole numbers only
    std::string_view meaning;
    bool is_tacit = false; ///< named in a technique's text only where it is not the default
    /// Of the values above `low` the least allowed, where it is above `low`.
    double least = std::numeric_limits<double>::lowest();
};

/// Equal steps by the angle of view: n = low + (high − low)(1 − cos α), α between the view ray and
/// the surface's normal.
struct StepRange {
    double low = 8.0;
    double high = 32.0;
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
    double depth = 0.0; ///< 0: hard
    friend bool operator==(const Shadow&, const Shadow&) = default;
};

/// What lies beyond the border of a detail tile.
using BorderRule = material::TileBorder;

/// What a technique does beside looking for its surface. As made: nothing of it.
struct TechniqueOptions {
    std::optional<StepRange> steps;
    std::optional<Fade> fade;
    std::optional<Shadow> shadow;
    /// A ray that passes the surface by less than this, in [0,1] of the range of heights, shows
    /// that place blended into the one it hits.
    std::optional<double> smooth_edges;
    bool two_sided = false;           ///< seen from behind, too
    std::optional<BorderRule> border; ///< absent: as the surface has it
    bool writes_depth = false;        ///< of the hit, so that meshes cut the relief
    bool true_silhouettes = false;    ///< a mesh is drawn by a hull around its relief
    friend bool operator==(const TechniqueOptions&, const TechniqueOptions&) = default;
};

struct OptionInfo {
    std::string_view name;
    std::string_view form;          ///< of its value: "min..max[,k]"
    std::string_view default_value; ///< as in its text
    std::string_view meaning;
    std::string_view source; ///< where it is described
    std::span<const ParameterInfo> numbers;
};

/// Every option there is, in the order of the sources.
std::span<const OptionInfo> option_catalogue();

/// Those that make sense with a technique.
std::vector<OptionInfo> options_of(TechniqueId id);

/// Whether the key of "key=value" is an option's.
bool is_option(std::string_view assignment);

/// Sets the option of "key=value" or "key=value,more". Fails where the technique cannot take it,
/// and on a value that is none of it. Precondition: is_option.
Result<void> set_option(TechniqueOptions& options, TechniqueId id, std::string_view assignment);

/// ",key=value" of each option that is not as made: set_option gives the same options back.
std::string to_string(const TechniqueOptions& options);

/// The options that are not as made, by number: a word is its place among those of the option's
/// form, a hard shadow has depth 0.
struct OptionNumber {
    std::string name; ///< "fade.min"
    double value = 0.0;
};
std::vector<OptionNumber> option_numbers(const TechniqueOptions& options);

/// A number in the range of a parameter; fails with `subject`, the parameter, what was found and
/// what was expected.
Result<double> parse_number(std::string_view subject, const ParameterInfo& parameter,
                            std::string_view text);

} // namespace reljef::scene

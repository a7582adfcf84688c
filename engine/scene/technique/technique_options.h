#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "engine/material/wrap_mode.h"
#include "engine/scene/technique/technique_catalogue.h"
#include "engine/scene/technique/technique_parameters.h"

namespace reljef::scene {

/// Linear steps by view angle: n = low + (high − low)(1 − cos α), α between the view ray and the
/// surface normal.
struct StepRange {
    int low = 8;
    int high = 32;
    friend bool operator==(const StepRange&, const StepRange&) = default;
};

/// Heights by view angle: scaled by low + (high − low)(1 − (1 − cos α)^power).
struct Fade {
    double low = 0.0;
    double high = 1.0;
    double power = 1.0;
    friend bool operator==(const Fade&, const Fade&) = default;
};

/// A shadow ray from the hit to the sun. A soft shadow leaves clamp(1 − p/depth) of the sun's
/// light, where p is the deepest penetration, in [0,1] of the height range.
struct Shadow {
    double depth = 0.2; ///< 0: hard
    friend bool operator==(const Shadow&, const Shadow&) = default;
};

/// If a ray misses the surface by less than the distance, that place is blended into the hit.
struct SmoothEdges {
    double distance = 0.005; ///< in [0,1] of the height range
    friend bool operator==(const SmoothEdges&, const SmoothEdges&) = default;
};

/// When a search writes the depth of its hits. Otherwise the depth of a terrain is that of the box
/// around it, so objects behind the ground are drawn over it.
enum class HitDepth {
    objects, ///< on a terrain, if objects are in the view
    none,
    write
};

/// What a technique does in addition to its search for the surface; by default nothing.
struct TechniqueOptions {
    std::optional<StepRange> steps;
    std::optional<Fade> fade;
    std::optional<Shadow> shadow;
    std::optional<SmoothEdges> smooth_edges;
    bool two_sided = false;                   ///< seen from behind, too
    std::optional<material::WrapMode> border; ///< of a detail tile; absent: its material's
    HitDepth depth = HitDepth::objects;
    bool true_silhouettes = false; ///< draws a mesh by a hull around its relief
    friend bool operator==(const TechniqueOptions&, const TechniqueOptions&) = default;
};

/// Whether rays to the sun decide what is in shadow, without penumbra.
inline bool casts_hard_shadows(const TechniqueOptions& options) {
    return options.shadow && options.shadow->depth <= 0.0;
}

/// A number of an option: its row, and access to the member that holds it.
struct OptionNumberInfo : NumberInfo {
    std::optional<double> (*getter)(const TechniqueOptions&) = nullptr;
    void (*setter)(TechniqueOptions&, double) = nullptr;

    /// Absent if the option is off.
    [[nodiscard]] std::optional<double> get(const TechniqueOptions& options) const {
        return getter(options);
    }
    /// Preconditions: the option is on, and allows(value).
    void set(TechniqueOptions& options, double value) const;
};

/// An option of techniques: one row of the table. Its value is one of its words, and numbers may
/// follow the last word. Without words the value is a range of its first two numbers, and the other
/// numbers may follow.
struct OptionInfo {
    std::string_view name;
    std::string_view default_value; ///< as text
    std::string_view meaning;
    std::string_view source = {}; ///< the paper or book
    std::span<const std::string_view> words = {};
    std::span<const OptionNumberInfo> numbers = {};
    /// The index of its word, 0 for a range; absent if the option has its default.
    std::optional<std::size_t> (*chosen)(const TechniqueOptions&) = nullptr;
    /// Sets a word by its index, or a range (0), with the default numbers. Absent: the default.
    void (*choose)(TechniqueOptions&, std::optional<std::size_t>) = nullptr;
    /// Why a technique cannot take the option; empty if it can.
    std::string_view (*reason_against)(TechniqueId) = nullptr;
};

/// All options, in the order of the sources.
std::span<const OptionInfo> option_catalogue();

/// The form of an option's value: "min..max[,k]".
std::string form_of(const OptionInfo& info);

/// The options that a technique can take.
std::vector<OptionInfo> options_of(TechniqueId id);

/// Whether the key of "key=value" is an option.
bool is_option(std::string_view assignment);

/// Sets the option of "key=value" or "key=value,more". Fails if the technique cannot take it, and
/// on a bad value. Precondition: is_option.
Result<void> set_option(TechniqueOptions& options, TechniqueId id, std::string_view assignment);

/// ",key=value" of each option that differs from its default; set_option() reads it back.
std::string to_string(const TechniqueOptions& options);

struct OptionNumber {
    std::string name; ///< "fade.min"
    double value = 0.0;
};
/// The options that differ from their defaults, as numbers. A word is its index in the option's
/// form; a hard shadow has depth 0.
std::vector<OptionNumber> option_numbers(const TechniqueOptions& options);

} // namespace reljef::scene

#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "engine/scene/technique/number_info.h"
#include "engine/scene/technique/technique_parameters.h"

namespace reljef::scene {

struct Technique;

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
    [[nodiscard]] double get(const Technique& technique) const;
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
/// The techniques that draw terrains.
std::vector<TechniqueInfo> terrain_techniques();

} // namespace reljef::scene

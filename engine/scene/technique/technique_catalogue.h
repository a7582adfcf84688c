#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "engine/scene/technique/number_info.h"
#include "engine/scene/technique/technique_parameters.h"

namespace reljef::scene {

struct Technique;

/// The range of an error that polygons can promise, pixels: a rasterizer's own takes most of less.
inline constexpr double min_polygons_error = 0.02;
inline constexpr double max_polygons_error = 16.0;

/// A parameter of a technique: its row, and the member that holds it.
struct ParameterInfo : NumberInfo {
    /// Of the same technique the parameter that replaces this one where it is not its default:
    /// both are not set together. Empty: none.
    std::string_view replaced_by;
    double (*getter)(const Technique&) = nullptr;
    void (*setter)(Technique&, double) = nullptr;

    /// Precondition: it is a parameter of this technique.
    [[nodiscard]] double get(const Technique& technique) const;
    /// Preconditions: likewise, and allows(value).
    void set(Technique& technique, double value) const;
};

struct TechniqueInfo {
    TechniqueId id;
    std::string_view name; ///< as on the command line
    std::string_view meaning;
    std::string_view source; ///< where it is described
    TechniqueParameters defaults;
    std::span<const ParameterInfo> parameters;
};

/// Every technique there is, in the order of the sources.
std::span<const TechniqueInfo> technique_catalogue();
const TechniqueInfo& technique_info(TechniqueId id);
/// Those that draw terrains.
std::vector<TechniqueInfo> terrain_techniques();

} // namespace reljef::scene

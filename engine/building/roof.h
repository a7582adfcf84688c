#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/building/footprint.h"

namespace reljef::building {

enum class RoofKind { flat, hipped };

/// Roof faces that rise from edges of a convex outline. Over each place the lowest of them counts,
/// as in a roof by the straight skeleton (Aichholzer et al. 1995).
struct SlopedRoof {
    double slope = 0.7; ///< rise over run, > 0
    /// Metres above the eaves from which the roof is flat, >= 0.
    double max_rise = std::numeric_limits<double>::infinity();
    std::vector<bool> sloped; ///< of the edges; empty: all. Others end in gables. At least one is
};

/// A flat, convex part of a roof, counter-clockwise from outside.
struct RoofPart {
    std::vector<glm::dvec3> corners; ///< metres; z above the eaves
    /// The edge of the outline below the part's own edge from each corner to the next.
    std::vector<std::optional<std::size_t>> outline_edges;
    bool is_upright = false; ///< the inner side of a parapet
};

/// z above the eaves, metres. Precondition: is_convex(outline).
double rise_at(const Ring& outline, const SlopedRoof& roof, glm::dvec2 place);

/// The largest distance that a place in the outline has from its nearest sloped edge, metres.
double largest_run(const Ring& outline, const SlopedRoof& roof);

/// Covers the outline without overlaps. Parts share the bits of common corners.
/// Precondition: is_convex(outline).
std::vector<RoofPart> sloped_roof(const Ring& outline, const SlopedRoof& roof);

/// A flat roof behind a wall of `width` and `height` metres on its border: the deck, the top of the
/// wall, and its inner side, which has no outline edges. Precondition: is_convex(outline).
std::vector<RoofPart> roof_with_parapet(const Ring& outline, double width, double height);

/// Level parts without the inside of a convex, counter-clockwise ring; upright parts stay.
std::vector<RoofPart> without(const std::vector<RoofPart>& parts, const Ring& hole);

/// The same with corners on outline edges, at most `max_length` metres apart.
std::vector<RoofPart> divided(const std::vector<RoofPart>& parts, double max_length);

} // namespace reljef::building

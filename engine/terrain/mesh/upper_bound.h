#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include "engine/core/check.h"

namespace reljef::terrain {

/// A non-negative number in 16 bits, rounded up: of a normal float by at most one part in 256. It
/// is the upper half of a float without its sign. Larger numbers have larger or the same bits.
class UpperBound {
public:
    UpperBound() = default;
    /// Precondition: not negative; infinity is allowed.
    explicit UpperBound(double value) {
        check(value >= 0.0, "an upper bound is not negative");
        auto nearest = static_cast<float>(value);
        const bool is_below = static_cast<double>(nearest) < value;
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(nearest) + (is_below ? 1U : 0U);
        bits_ = static_cast<std::uint16_t>((bits + (1U << dropped_bits) - 1U) >> dropped_bits);
    }
    static UpperBound from_bits(std::uint16_t bits) {
        UpperBound bound;
        bound.bits_ = bits;
        return bound;
    }

    [[nodiscard]] float value() const {
        return std::bit_cast<float>(std::uint32_t{bits_} << dropped_bits);
    }
    [[nodiscard]] std::uint16_t bits() const { return bits_; }

    friend bool operator==(UpperBound, UpperBound) = default;
    friend auto operator<=>(UpperBound a, UpperBound b) { return a.bits_ <=> b.bits_; }

private:
    static constexpr unsigned dropped_bits = 15;
    std::uint16_t bits_ = 0;
};
static_assert(std::numeric_limits<float>::is_iec559 && sizeof(UpperBound) == 2);

} // namespace reljef::terrain

#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace reljef {
namespace detail {

// Radix sort by the upper two of a float's three 11-bit digits. Bit patterns of non-negative floats
// are ordered like their values. The ignored digit is below 2^-13 of the value.
constexpr unsigned digit_bits = 11;
constexpr unsigned first_digit = 10;
constexpr std::size_t digits = std::size_t{1} << digit_bits;

inline std::size_t digit_of(double distance, unsigned shift) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(distance));
    return (bits >> shift) & (digits - 1);
}

template <class Item> std::vector<Item> sorted_by_digit(std::vector<Item>&& items, unsigned shift) {
    std::array<std::size_t, digits> places{};
    for (const Item& item : items) {
        ++places[digit_of(item.distance, shift)];
    }
    std::exclusive_scan(places.begin(), places.end(), places.begin(), std::size_t{0});
    std::vector<Item> sorted(items.size());
    for (Item& item : items) {
        sorted[places[digit_of(item.distance, shift)]++] = std::move(item);
    }
    return sorted;
}

} // namespace detail

/// Stable sort by ascending `distance`: a radix sort, then an insertion sort. Linear time for
/// spread distances. Precondition: distances are not negative and not NaN.
template <class Item> std::vector<Item> nearest_first(std::vector<Item> items) {
    for (unsigned shift = detail::first_digit; shift < 32; shift += detail::digit_bits) {
        items = detail::sorted_by_digit(std::move(items), shift);
    }
    for (std::size_t i = 1; i < items.size(); ++i) { // few have equal digits
        for (std::size_t j = i; j > 0 && items[j].distance < items[j - 1].distance; --j) {
            std::swap(items[j], items[j - 1]);
        }
    }
    return items;
}

} // namespace reljef

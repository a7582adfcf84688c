#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/core/result.h"

namespace reljef::io {

/// What a file of the cache keeps numbers of.
struct KeptKind {
    std::array<char, 8> magic{};
    std::uint32_t version = 1;
    std::string_view name; ///< "the cones of these heights", for errors
};
struct KeptKey {
    KeptKind kind;
    glm::ivec2 size{0};       ///< of the grid they are of
    std::uint64_t source = 0; ///< checksum of all that they are made from
};

/// FNV-1a (Fowler, Noll and Vo 1991) over words of four bytes, or of eight.
inline constexpr std::uint64_t checksum_start = 14695981039346656037ULL;
std::uint64_t checksum(std::span<const float> values, std::uint64_t sum = checksum_start);
std::uint64_t checksum(std::span<const double> values, std::uint64_t sum = checksum_start);
/// Of heights and their size.
std::uint64_t checksum_of(GridView<const float> heights);

/// The `count` numbers of a file, which is checked: its version, whose it is, its length, a
/// checksum. Nothing where there is no such file; fails where it is not to be used.
std::optional<Result<std::vector<float>>> read_numbers(const std::filesystem::path& path,
                                                       const KeptKey& key, std::size_t count);

/// Keeps the parts, one after the other; makes the folder. Whole or not at all.
Result<void> write_numbers(const std::filesystem::path& path, const KeptKey& key,
                           std::span<const std::span<const float>> parts);

} // namespace reljef::io

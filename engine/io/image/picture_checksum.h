#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace reljef::io {

/// The description of a picture that gets a checksum of its file (FNV-1a, 64 bits) instead of the
/// zeros at its end.
inline constexpr std::string_view checksum_text =
    "reljef: FNV-1a of this file, with zeros for these digits: 0000000000000000";

/// An encoded picture with its checksum wherever it has checksum_text; others stay as they are.
std::vector<std::byte> with_checksum(std::vector<std::byte> picture);

/// Whether a picture has a checksum, and no byte has changed since it was entered.
bool has_right_checksum(std::span<const std::byte> picture);

} // namespace reljef::io

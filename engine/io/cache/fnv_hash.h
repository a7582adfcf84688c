#pragma once

#include <cstdint>
#include <string_view>

namespace reljef::io {

inline constexpr std::uint64_t fnv_start = 14695981039346656037ULL;

/// FNV-1a, 64 bits (Fowler, Noll, Vo); of several texts one after the other where each goes on from
/// the hash of those before.
inline std::uint64_t fnv_hash(std::string_view bytes, std::uint64_t hash = fnv_start) {
    for (const char byte : bytes) {
        hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211ULL;
    }
    return hash;
}

} // namespace reljef::io

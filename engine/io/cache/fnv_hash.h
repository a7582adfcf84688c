#pragma once

#include <cstdint>
#include <string_view>

namespace reljef::io {

// FNV-1a, 64 bits (Fowler, Noll and Vo 1991).
inline constexpr std::uint64_t fnv_start = 14695981039346656037ULL;
inline constexpr std::uint64_t fnv_prime = 1099511628211ULL;

/// Hash of bytes that continues `hash`.
inline std::uint64_t fnv_hash(std::string_view bytes, std::uint64_t hash = fnv_start) {
    for (const char byte : bytes) {
        hash = (hash ^ static_cast<unsigned char>(byte)) * fnv_prime;
    }
    return hash;
}

} // namespace reljef::io

#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace reljef::io {

/// The unsigned number in `count` bytes from `first` on, at most 8. Precondition: they exist.
inline std::uint64_t little_endian(std::string_view bytes, std::size_t first, std::size_t count) {
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < count; ++i) {
        number |= std::uint64_t{static_cast<unsigned char>(bytes[first + i])} << 8U * i;
    }
    return number;
}

} // namespace reljef::io

#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/io/cache/fnv_hash.h"

namespace reljef::test {

/// A file of the disk cache with other numbers and the checksum of these.
inline std::string resealed(std::string bytes,
                            const std::function<void(std::span<float> numbers)>& change) {
    constexpr std::size_t head = 40;
    std::vector<float> numbers((bytes.size() - head) / sizeof(float));
    std::memcpy(numbers.data(), bytes.data() + head, numbers.size() * sizeof(float));
    change(numbers);
    std::uint64_t hash = io::fnv_start;
    for (const float number : numbers) {
        std::uint32_t word = 0;
        std::memcpy(&word, &number, sizeof(word));
        hash = (hash ^ word) * io::fnv_prime;
    }
    std::memcpy(bytes.data() + head, numbers.data(), numbers.size() * sizeof(float));
    std::memcpy(bytes.data() + head - sizeof(hash), &hash, sizeof(hash));
    return bytes;
}

} // namespace reljef::test

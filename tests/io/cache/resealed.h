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

/// A file of the disk cache with other numbers, of four bytes each, and the checksum of these.
template <class Number>
std::string resealed(std::string bytes,
                     const std::function<void(std::span<Number> numbers)>& change) {
    static_assert(sizeof(Number) == sizeof(std::uint32_t));
    constexpr std::size_t head = 40;
    std::vector<Number> numbers((bytes.size() - head) / sizeof(Number));
    std::memcpy(static_cast<void*>(numbers.data()), bytes.data() + head,
                numbers.size() * sizeof(Number));
    change(numbers);
    std::uint64_t hash = io::fnv_start;
    for (const Number& number : numbers) {
        std::uint32_t word = 0;
        std::memcpy(&word, &number, sizeof(word));
        hash = (hash ^ word) * io::fnv_prime;
    }
    std::memcpy(bytes.data() + head, numbers.data(), numbers.size() * sizeof(Number));
    std::memcpy(bytes.data() + head - sizeof(hash), &hash, sizeof(hash));
    return bytes;
}

} // namespace reljef::test

#include "engine/io/cache/array_cache.h"

#include <bit>
#include <cstring>
#include <type_traits>

#include <fmt/format.h>

#include "engine/core/atomic_file.h"

namespace reljef::io {
namespace fs = std::filesystem;
namespace {

// What begins a file; then the numbers, floats.
struct KeptHeader {
    std::array<char, 8> magic{};
    std::uint32_t version = 0;
    std::uint32_t endian = 0x01020304;
    std::int32_t cols = 0;
    std::int32_t rows = 0;
    std::uint64_t source = 0; // checksums
    std::uint64_t numbers = 0;
};
static_assert(sizeof(KeptHeader) == 40 && std::is_trivially_copyable_v<KeptHeader>);

constexpr std::uint64_t fnv_prime = 1099511628211ULL;

KeptHeader header_of(const KeptKey& key, std::uint64_t numbers) {
    KeptHeader header;
    header.magic = key.kind.magic;
    header.version = key.kind.version;
    header.cols = key.size.x;
    header.rows = key.size.y;
    header.source = key.source;
    header.numbers = numbers;
    return header;
}

Error unusable(const fs::path& path, const KeptKind& kind, std::string_view found) {
    return Error{fmt::format("{}: {} found, {} (version {}) were expected; they are made anew",
                             path.string(), found, kind.name, kind.version)};
}

Result<std::vector<float>> parse_numbers(const std::string& bytes, const fs::path& path,
                                         const KeptKey& key, std::size_t count) {
    std::vector<float> numbers(count);
    const auto into = std::as_writable_bytes(std::span(numbers));
    if (bytes.size() != sizeof(KeptHeader) + into.size()) {
        return unusable(path, key.kind, fmt::format("a length of {} bytes", bytes.size()));
    }
    KeptHeader header;
    std::memcpy(&header, bytes.data(), sizeof(header));
    if (header.version != key.kind.version) {
        return unusable(path, key.kind, fmt::format("version {}", header.version));
    }
    std::memcpy(into.data(), bytes.data() + sizeof(header), into.size());
    const KeptHeader expected = header_of(key, checksum(numbers));
    if (std::memcmp(&header, &expected, sizeof(header)) != 0) {
        return unusable(path, key.kind, "a wrong checksum");
    }
    return numbers;
}

} // namespace

std::uint64_t checksum(std::span<const float> values, std::uint64_t sum) {
    for (const float value : values) {
        sum = (sum ^ std::bit_cast<std::uint32_t>(value)) * fnv_prime;
    }
    return sum;
}

std::uint64_t checksum(std::span<const double> values, std::uint64_t sum) {
    for (const double value : values) {
        sum = (sum ^ std::bit_cast<std::uint64_t>(value)) * fnv_prime;
    }
    return sum;
}

std::uint64_t checksum_of(GridView<const float> heights) {
    std::uint64_t sum = checksum_start ^ static_cast<std::uint64_t>(heights.cols());
    for (int row = 0; row < heights.rows(); ++row) {
        sum = checksum(heights.row(row), sum);
    }
    return sum;
}

std::optional<Result<std::vector<float>>> read_numbers(const fs::path& path, const KeptKey& key,
                                                       std::size_t count) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) {
        return std::nullopt;
    }
    constexpr std::size_t longest = std::size_t{1} << 32U;
    const auto bytes = read_text_file(path, longest);
    return bytes ? parse_numbers(*bytes, path, key, count)
                 : Result<std::vector<float>>(bytes.error());
}

Result<void> write_numbers(const fs::path& path, const KeptKey& key,
                           std::span<const std::span<const float>> parts) {
    std::uint64_t sum = checksum_start;
    for (const std::span<const float> part : parts) {
        sum = checksum(part, sum);
    }
    const KeptHeader header = header_of(key, sum);
    const auto start = std::as_bytes(std::span(&header, 1));
    std::vector<std::byte> bytes(start.begin(), start.end());
    for (const std::span<const float> part : parts) {
        const auto more = std::as_bytes(part);
        bytes.insert(bytes.end(), more.begin(), more.end());
    }
    std::error_code code;
    fs::create_directories(path.parent_path(), code); // what is wrong with it, writing will tell
    return write_file(path, bytes);
}

} // namespace reljef::io
